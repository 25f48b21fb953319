//! `fcproto mock --as app`.

use std::io::stdin;
use std::thread;
use std::time::Duration;

use fc_reflect::Reflector;
use fc_spec::model::{Kind, Model, Side};
use fc_workshop::address::{at_port, with_port};
use fc_workshop::answer::Response;
use fc_workshop::app::{App, Event, Settings};
use fc_workshop::facts;
use fc_workshop::run::{Interrupt, block_on};
use fc_workshop::scenario::{Expected, Scenario};
use fc_workshop::transcript::Transcript;
use tokio::sync::mpsc::{Receiver, channel};

use crate::allow::{Allowed, permission};
use crate::lang::{both, in_lang, lang, said};
use crate::outcome::{Failure, Status, unanswered};
use crate::print;
use crate::recording::OutputFormat;

/// Options of an app.
#[derive(Debug, clap::Args)]
pub struct AppOptions {
    #[arg(
        long,
        value_name = "HOST[:PORT]",
        conflicts_with_all = ["host", "command_port", "data_port", "count", "stream_after", "no_preconditions"],
        help = both("`--as app` 连接的机器人；端口默认按规范", "Robot of `--as app`; the port is that of the spec by default")
    )]
    pub to: Option<String>,
    #[arg(
        long,
        value_name = "PORT",
        requires = "to",
        help = both("该机器人的数据端口 [默认：按规范]", "Data port of that robot [default: by the spec]")
    )]
    to_data_port: Option<u16>,
    #[arg(
        long,
        value_name = "EFFECT",
        requires = "to",
        help = both("允许 app 改变机器人的指令", "Allow commands of the app that change the robot")
    )]
    allow: Option<Allowed>,
    #[arg(
        long,
        value_name = "FORMAT",
        default_value = "text",
        requires = "to",
        help = both("app 的输出格式", "Output format of the app")
    )]
    format: OutputFormat,
    #[arg(
        long,
        requires = "to",
        help = both("app 的每条指令等待一次回车", "Wait for Enter before each command of the app")
    )]
    step: bool,
}

/// Steps that wait.
const STEPS: usize = 16;

/// Plays the app against a robot.
pub fn run(
    reflector: &Reflector<'_>,
    options: &super::Options,
    scenario: Option<Scenario>,
) -> Result<Status, Failure> {
    let model = reflector.model();
    let app = &options.app;
    let scenario = match scenario {
        Some(scenario) => {
            check(model, &scenario, app.allow)?;
            scenario
        }
        None => Scenario::of_commands(allowed(model, app.allow)),
    };
    let ports = &model.transport.ports;
    let to = app.to.as_deref().unwrap_or_default();
    let settings = Settings {
        commands: with_port(to, ports.command.number),
        data: at_port(to, app.to_data_port.unwrap_or(ports.data.number)),
        pace: Duration::from_millis(options.pace),
        timeout: facts::call_timeout(model),
        expect: options.expect,
    };
    block_on(async {
        let app = match App::connect(reflector, &settings).await {
            Ok(app) => app,
            Err(error) => return unanswered(error.into()),
        };
        let steps = options.app.step.then(steps);
        let mut interrupt = Interrupt::new()?;
        let transcript = match options.app.format {
            OutputFormat::Text => Transcript::Text(lang()),
            OutputFormat::Json => Transcript::Json,
        };
        let sink = &mut |event: Event<'_, '_>| show(reflector, transcript, &event);
        let deviations = app.run(&scenario, steps, sink, interrupt.next()).await?;
        if options.expect && deviations == 0 {
            print::done(&said!(
                "机器人符合场景\n",
                "the robot did what the scenario expects\n"
            ))?;
        }
        Ok(Status::fine_if(!options.expect || deviations == 0))
    })?
}

/// Reads lines on another thread, because reading blocks. Each one is a step.
fn steps() -> Receiver<()> {
    let (sender, receiver) = channel(STEPS);
    thread::spawn(move || {
        for line in stdin().lines() {
            if line.is_err() || sender.blocking_send(()).is_err() {
                return;
            }
        }
    });
    receiver
}

/// Returns the names of the commands that an app may send.
fn allowed(model: &Model, allow: Option<Allowed>) -> impl Iterator<Item = String> {
    let commands = model.operations.iter().filter(move |operation| {
        operation.kind() == Kind::Command
            && operation.sender == Side::App
            && operation.code.value.is_some()
            && permission(allow).check(Some(operation)).is_ok()
    });
    commands.map(|command| command.name.clone())
}

/// Refuses a scenario with a command that is not allowed.
fn check(model: &Model, scenario: &Scenario, allow: Option<Allowed>) -> Result<(), Failure> {
    for expected in &scenario.expect {
        if let Expected::Request(name, _) = expected {
            permission(allow).check(model.operation(name))?;
        }
    }
    Ok(())
}

fn show(
    reflector: &Reflector<'_>,
    transcript: Transcript,
    event: &Event<'_, '_>,
) -> std::io::Result<()> {
    match event {
        Event::Waits(name) => print::message(&said!(
            "下一条：`{name}`，按回车发送\n",
            "next: `{name}`, press Enter to send it\n"
        )),
        Event::Response(command, frame, took) => {
            let response = Response::read(reflector, Some(*command), frame, *took);
            // A deviation follows the response that cannot be read.
            response.map_or(Ok(()), |it| print::result(&transcript.result(&it)))
        }
        Event::Pushed(frame) => print::result(&transcript.arrival(frame)),
        Event::Deviation(name, deviation) => {
            let deviation = in_lang(deviation);
            let _ = print::error(&said!("`{name}`：{deviation}", "`{name}`: {deviation}"));
            Ok(())
        }
    }
}
