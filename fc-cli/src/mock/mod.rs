//! `fcproto mock`.

mod app;

use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::ValueEnum;
use fc_reflect::Reflector;
use fc_spec::diagnostic::Faults;
use fc_spec::model::{Kind, Model, Operation};
use fc_spec::source::Sources;
use fc_workshop::listen::Listeners;
use fc_workshop::mock::{Settings, serve};
use fc_workshop::replay::Recorded;
use fc_workshop::run::{Interrupt, block_on};
use fc_workshop::scenario::{Scenario, Verdict};

use crate::endpoint::{self, Ports};
use crate::input;
use crate::lang::{both, in_lang, said};
use crate::outcome::{Failure, Status};
use crate::print;
use crate::recording::read_file;

/// Options of `fcproto mock`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[arg(
        long = "as",
        value_name = "SIDE",
        value_enum,
        default_value_t = Side::Robot,
        requires_if("app", "to"),
        help = both("模拟哪一方", "The side to play")
    )]
    side: Side,
    #[command(flatten)]
    app: app::AppOptions,
    #[command(flatten)]
    ports: Ports,
    #[arg(
        long,
        value_name = "N",
        default_value = "1",
        value_parser = clap::value_parser!(u16).range(1..),
        help = both("机器人的台数，各有自己的端口", "Number of robots, each with its ports")
    )]
    count: u16,
    #[arg(
        long,
        value_name = "MS",
        default_value = "500",
        value_parser = clap::value_parser!(u64).range(1..=3_600_000),
        help = both("过程中两次上报的间隔，规范另有规定时除外；或 app 每条指令之前的时间", "Time between two reports of a process, unless the spec has one; or before each command of an app")
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
        help = both("按场景文件响应或发送", "Respond or send as a scenario says")
    )]
    scenario: Option<PathBuf>,
    #[arg(
        long,
        value_name = "FILE",
        conflicts_with = "scenario",
        help = both("按录下的通信响应或发送", "Respond or send as in recorded traffic")
    )]
    replay: Option<PathBuf>,
    #[arg(
        long,
        help = both("对方符合场景时以 0 退出，否则以 1 退出", "Exit with 0 once the other side has met the scenario, otherwise with 1")
    )]
    expect: bool,
}

/// The side that is played.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Side {
    #[value(help = both("机器人", "The robot"))]
    Robot,
    #[value(help = both("app，连接 `--to` 的机器人", "The app, which connects to the robot of `--to`"))]
    App,
}

pub fn run(model: &Model, options: &Options) -> Result<Status, Failure> {
    let reflector = Reflector::new(model);
    let scenario = match (&options.scenario, &options.replay) {
        (None, Some(file)) => Some(recorded(&reflector, file)?),
        (Some(file), _) => {
            let text = input::text(file)?;
            let sources = Sources::from_texts([(file.display().to_string(), text)]);
            let mut faults = Faults::new();
            let scenario = Scenario::read(&reflector, &sources, &mut faults);
            if scenario.is_none() {
                print::faults(&faults, &sources)?;
                return Ok(Status::Faulty);
            }
            scenario
        }
        (None, None) => None,
    };
    match options.side {
        Side::App => app::run(&reflector, options, scenario),
        Side::Robot => robot(model, options, scenario),
    }
}

/// Returns the scenario of recorded traffic.
fn recorded(reflector: &Reflector<'_>, file: &Path) -> Result<Scenario, Failure> {
    let mut recorded = Recorded::new(reflector.model());
    read_file(reflector, file, None, &[], &mut |record| {
        recorded.add(record);
        Ok(())
    })?;
    recorded.finish().ok_or_else(|| {
        let file = file.display();
        said!(
            "`{file}` 太长；用 editcap 截取一段",
            "`{file}` is too long to replay; cut a part of it with editcap"
        )
        .into()
    })
}

fn robot(model: &Model, options: &Options, scenario: Option<Scenario>) -> Result<Status, Failure> {
    if options.app.to.is_some() {
        return Err(said!("--to 需要 --as app", "--to needs --as app").into());
    }
    if options.expect && scenario.is_none() {
        return Err(said!(
            "--expect 需要 --scenario 或 --replay",
            "--expect needs --scenario or --replay"
        )
        .into());
    }
    for name in &options.stream_after {
        let is_command = |operation: &Operation| operation.kind() == Kind::Command;
        if !model.operation(name).is_some_and(is_command) {
            return Err(said!("没有指令 `{name}`", "there is no command `{name}`").into());
        }
    }
    let settings = Settings {
        pace: Duration::from_millis(options.pace),
        stream_after: options.stream_after.clone(),
        ignores_preconditions: options.no_preconditions,
        scenario,
        expect: options.expect,
    };
    block_on(async {
        let robots = match options.count {
            1 => vec![options.ports.listen(model).await?],
            count => options.ports.listen_often(count).await?,
        };
        let addresses = robots.iter().map(Listeners::addresses);
        let addresses: Vec<_> = addresses.collect::<Result<_, _>>()?;
        // Before the first line, because its reader may end the mock at once.
        let mut interrupt = Interrupt::new()?;
        let lines: String = addresses.into_iter().map(endpoint::line).collect();
        print::result(&lines)?;
        let verdict = serve(model, &settings, robots, interrupt.next()).await;
        let Some(verdict) = verdict.filter(|_| settings.expect) else {
            return Ok(Status::Fine);
        };
        let text = in_lang(&verdict.text());
        if verdict == Verdict::Met {
            print::done(&format!("{text}\n"))?;
            return Ok(Status::Fine);
        }
        let _ = print::error(&text);
        Ok(Status::Faulty)
    })?
}
