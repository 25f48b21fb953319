//! `fcproto mock`.

use std::path::PathBuf;
use std::time::Duration;

use fc_reflect::Reflector;
use fc_spec::diagnostic::Faults;
use fc_spec::model::{Kind, Operation};
use fc_spec::source::Sources;
use fc_workshop::mock::{Settings, serve};
use fc_workshop::run::{Interrupt, block_on};
use fc_workshop::scenario::{Scenario, Verdict};

use crate::endpoint::{self, Ports};
use crate::help::{Help, Part};
use crate::input;
use crate::lang::{both, in_lang, said};
use crate::outcome::{Failure, Status};
use crate::place::Place;
use crate::print;
use crate::spec::{Spec, show_faults};

/// Options of `fcproto mock`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[command(flatten)]
    ports: Ports,
    #[arg(
        long,
        value_name = "MS",
        default_value = "500",
        value_parser = clap::value_parser!(u64).range(1..=3_600_000),
        help = both("过程中两次上报的间隔，规范另有规定时除外", "Time between two reports of a process, unless the spec has one")
    )]
    pace: u64,
    #[arg(
        long,
        value_name = "COMMAND",
        help = both("该指令之后在数据端口发送一帧字节", "Send a frame of bytes on the data port after this command")
    )]
    stream_after: Vec<String>,
    #[arg(
        long,
        help = both("前提不满足的指令也接受", "Accept commands although their preconditions are not met")
    )]
    no_preconditions: bool,
    #[arg(
        long,
        value_name = "FILE",
        help = both("按场景文件响应", "Respond as a scenario says")
    )]
    scenario: Option<PathBuf>,
    #[arg(
        long,
        requires = "scenario",
        help = both("场景的期望满足时以 0 退出，否则以 1 退出", "Exit with 0 once the app has met the scenario, otherwise with 1")
    )]
    expect: bool,
}

pub fn help() -> Help {
    Help {
        summary: both("按规范模拟一台机器人", "Play a robot from the spec"),
        details: vec![
            Part::Text(both(
                "模拟端用规范中的示例响应指令，以协议的结果码拒绝不合规范的请求，以及前提不满足的指令。指令引起的过程从起始状态走到最后，\
                 每步发送上报；设置过的值可以查到。没有应答的上报按规范重发。标准输出的第一行是两个端口的地址。Ctrl-C 结束。",
                "The mock responds to commands with the examples of the spec. It refuses requests that break the spec, and commands whose \
                 preconditions are not met, with the results of the protocol. A process that a command sets off runs from its first state to \
                 its last, with a report for each. Values that were set can be read. Reports without an acknowledgement are repeated as the \
                 spec demands. The first line on standard output has the addresses of both ports. Ctrl-C ends the mock.",
            )),
            Part::Examples(vec![
                (
                    "fcproto mock",
                    both("在规范的端口上", "On the ports of the spec"),
                ),
                (
                    "fcproto mock --command-port 0 --data-port 0",
                    both("在任意空闲端口上", "On any free ports"),
                ),
            ]),
        ],
        fails: both(
            "规范或场景有错误，或 app 不符合场景",
            "Errors in the spec or the scenario, or an app that does not meet it",
        ),
        speaks: "",
    }
}

pub fn run(place: &Place, options: &Options) -> Result<Status, Failure> {
    let spec = Spec::read(place)?;
    let Some(model) = &spec.model else {
        spec.show_faults()?;
        return Ok(spec.status());
    };
    let mut settings = Settings {
        pace: Duration::from_millis(options.pace),
        stream_after: options.stream_after.clone(),
        ignores_preconditions: options.no_preconditions,
        scenario: None,
        expect: options.expect,
    };
    for name in &options.stream_after {
        let is_command = |operation: &Operation| operation.kind() == Kind::Command;
        if !model.operation(name).is_some_and(is_command) {
            return Err(said!("没有指令 `{name}`", "there is no command `{name}`").into());
        }
    }
    if let Some(file) = &options.scenario {
        let text = input::text(file)?;
        let sources = Sources::from_texts([(file.display().to_string(), text)]);
        let mut faults = Faults::new();
        settings.scenario = Scenario::read(&Reflector::new(model), &sources, &mut faults);
        if settings.scenario.is_none() {
            show_faults(&faults, &sources)?;
            return Ok(Status::Faulty);
        }
    }
    block_on(async {
        let listeners = options.ports.listen(model).await?;
        let addresses = listeners.addresses()?;
        // Before the first line, because its reader may end the mock at once.
        let mut interrupt = Interrupt::new()?;
        print::result(&endpoint::line(addresses))?;
        let verdict = serve(model, &settings, listeners, interrupt.next()).await;
        let Some(verdict) = verdict.filter(|_| settings.expect) else {
            return Ok(Status::Fine);
        };
        let text = in_lang(&verdict.text());
        if verdict == Verdict::Met {
            print::done(&format!("{text}\n"))?;
            return Ok(Status::Fine);
        }
        print::failure(Failure::from(text).as_ref());
        Ok(Status::Faulty)
    })?
}
