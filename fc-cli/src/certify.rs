//! `fcproto certify`.

use std::fs;
use std::path::PathBuf;
use std::time::{Duration, SystemTime};

use fc_codegen::inspect::fingerprint;
use fc_reflect::Reflector;
use fc_spec::model::Model;
use fc_workshop::address::with_port;
use fc_workshop::certify::{self, Certificate, Settings, Trial};
use fc_workshop::client::Client;
use fc_workshop::facts;
use fc_workshop::run::{Interrupt, block_on};

use crate::allow::{Allowed, permission};
use crate::endpoint::{self, Ports};
use crate::lang::{both, lang, said};
use crate::outcome::{Failure, Status, unanswered, unwritable};
use crate::output::Output;
use crate::print;
use crate::recording::OutputFormat;

/// Options of `fcproto certify`.
#[derive(Debug, clap::Args)]
#[command(group(clap::ArgGroup::new("device").required(true)))]
pub struct Options {
    #[arg(
        long,
        value_name = "HOST[:PORT]",
        group = "device",
        conflicts_with_all = ["host", "command_port", "data_port"],
        help = both("检验这个机器人；端口默认按规范", "Test this robot; the port is that of the spec by default")
    )]
    robot: Option<String>,
    #[arg(
        long,
        group = "device",
        conflicts_with_all = ["allow", "only"],
        help = both("检验下一个连接的 app", "Test the app that connects next")
    )]
    app: bool,
    #[command(flatten)]
    ports: Ports,
    #[arg(
        long,
        value_name = "SECONDS",
        default_value = "60",
        value_parser = clap::value_parser!(u64).range(1..=86_400),
        help = both("等待 app 连接的秒数", "Seconds to wait for the app")
    )]
    wait: u64,
    #[arg(
        long,
        value_name = "DIR",
        help = both("写入 certificate.html 和 certificate.json 的目录", "Directory for certificate.html and certificate.json")
    )]
    out: Option<PathBuf>,
    #[arg(
        long,
        value_name = "EFFECT",
        help = both("允许改变机器人的指令", "Allow commands that change the robot")
    )]
    allow: Option<Allowed>,
    #[arg(
        long = "only",
        value_name = "TRIAL",
        help = both("只做这些试验，例如 `frame` 或 `call.get_robot_sn`", "Run these trials only, such as `frame` or `call.get_robot_sn`")
    )]
    only: Vec<String>,
    #[command(flatten)]
    output: Output<OutputFormat>,
}

pub fn run(model: &Model, options: &Options) -> Result<Status, Failure> {
    let reflector = &Reflector::new(model);
    let start = SystemTime::now();
    let tested = match &options.robot {
        Some(robot) => test_robot(reflector, options, robot),
        None => test_app(reflector, options),
    };
    let (address, trials) = match tested {
        Ok(Some(tested)) => tested,
        // Ctrl-C: an incomplete certificate is none.
        Ok(None) => return Ok(Status::Faulty),
        Err(failure) => return unanswered(failure),
    };
    let certificate = Certificate {
        address,
        protocol: model.protocol.id.clone(),
        version: model.protocol.version.clone(),
        fingerprint: fingerprint(model),
        program: env!("CARGO_PKG_VERSION").to_owned(),
        start,
        only: options.only.clone(),
        duration: start.elapsed().unwrap_or_default(),
        trials,
    };
    if let Some(folder) = &options.out {
        let page = certify::html(&certificate)?;
        let files = [("html", page), ("json", certify::json(&certificate))];
        fs::create_dir_all(folder).map_err(unwritable(folder))?;
        for (extension, text) in files {
            let path = folder.join("certificate").with_extension(extension);
            fs::write(&path, text).map_err(unwritable(&path))?;
        }
    }
    let [passed, failed, skipped] = certificate.counts();
    if options.output.format == OutputFormat::Text {
        print::done(&said!(
            "{passed} 项通过，{failed} 项失败，{skipped} 项跳过\n",
            "{passed} passed, {failed} failed, {skipped} skipped\n"
        ))?;
    }
    Ok(Status::fine_if(certificate.is_passed()))
}

/// The address of a device, and its trials.
type Tested = (String, Vec<Trial>);

fn test_robot(
    reflector: &Reflector<'_>,
    options: &Options,
    robot: &str,
) -> Result<Option<Tested>, Failure> {
    let model = reflector.model();
    let settings = Settings {
        address: with_port(robot, model.transport.ports.command.number),
        permission: permission(options.allow),
        only: options.only.clone(),
    };
    let trials: Result<_, Failure> = block_on(async {
        let mut interrupt = Interrupt::new()?;
        let wait = facts::call_timeout(model);
        drop(Client::connect(reflector, &settings.address, wait).await?);
        let mut told = |trial: &Trial| show(options.output.format, trial);
        Ok(certify::robot(reflector, &settings, &mut told, interrupt.next()).await)
    })?;
    Ok(trials?.map(|trials| (settings.address, trials)))
}

fn test_app(reflector: &Reflector<'_>, options: &Options) -> Result<Option<Tested>, Failure> {
    let model = reflector.model();
    block_on(async {
        let listeners = options.ports.listen(model).await?;
        let addresses = listeners.addresses()?;
        // Before the first line, because its reader may end the program at once.
        let mut interrupt = Interrupt::new()?;
        print::result(&endpoint::line(addresses))?;
        let wait = Duration::from_secs(options.wait);
        let mut told = |trial: &Trial| show(options.output.format, trial);
        let end = interrupt.next();
        let trials = certify::app(reflector, listeners, wait, &mut told, end).await;
        if trials.is_none() {
            let _ = print::error(both("没有 app 连接", "no app has connected"));
        }
        Ok(trials.map(|trials| (addresses.0.to_string(), trials)))
    })?
}

fn show(format: OutputFormat, trial: &Trial) {
    let line = match format {
        OutputFormat::Text => trial.line(lang()),
        OutputFormat::Json => certify::json_line(trial),
    };
    // A reader that has gone ends the program at its next output.
    let _ = print::result(&(line + "\n"));
}
