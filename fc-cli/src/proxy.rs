//! `fcproto proxy`.

#[cfg(feature = "view")]
use std::cell::RefCell;
use std::io;

use fc_reflect::Reflector;
use fc_spec::model::Model;
use fc_workshop::address::{at_port, with_port};
use fc_workshop::fault::Fault;
use fc_workshop::listen::Listeners;
use fc_workshop::proxy::{self, Event, Settings, Sink, serve};
use fc_workshop::run::{Interrupt, block_on};
#[cfg(feature = "view")]
use fc_workshop::view::{self, View};
use serde_json::json;

use crate::endpoint::{self, Ports};
use crate::lang::{both, lang, said};
use crate::outcome::{Failure, Status};
use crate::output::Output;
use crate::print;
use crate::recording::OutputFormat;

/// Options of `fcproto proxy`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[arg(
        long,
        value_name = "HOST[:PORT]",
        help = both("机器人的地址；端口默认按规范", "Address of the robot; the port is that of the spec by default")
    )]
    to: String,
    #[arg(
        long,
        value_name = "PORT",
        help = both("机器人的数据端口 [默认：按规范]", "Data port of the robot [default: by the spec]")
    )]
    to_data_port: Option<u16>,
    #[command(flatten)]
    ports: Ports,
    #[arg(
        long = "fault",
        value_name = "FAULT",
        help = both("注入故障：`种类[=值][:指令][:10%]`", "Inject a fault: `KIND[=VALUE][:NAME][:10%]`")
    )]
    faults: Vec<String>,
    #[arg(
        long,
        value_name = "N",
        requires = "faults",
        help = both("随机故障的种子 [默认：任意]", "Seed of faults by chance [default: any]")
    )]
    seed: Option<u64>,
    #[cfg(feature = "record")]
    #[arg(
        long,
        value_name = "FILE",
        help = both("同时写入 MCAP 文件", "Also write an MCAP file")
    )]
    record: Option<std::path::PathBuf>,
    #[cfg(feature = "view")]
    #[arg(
        long,
        conflicts_with = "format",
        help = both("在终端中查看、过滤、暂停和展开", "Show, filter, pause and open frames on the terminal")
    )]
    view: bool,
    #[command(flatten)]
    output: Output<OutputFormat>,
}

pub fn run(model: &Model, options: &Options) -> Result<Status, Failure> {
    let ports = &model.transport.ports;
    let faults = options.faults.iter().map(|text| Fault::read(model, text));
    let data_port = options.to_data_port.unwrap_or(ports.data.number);
    let settings = Settings {
        commands: with_port(&options.to, ports.command.number),
        data: at_port(&options.to, data_port),
        faults: faults.collect::<Result<_, _>>()?,
        seed: options.seed.unwrap_or_else(fc_workshop::fault::any_seed),
    };
    block_on(forward(model, options, &settings))?
}

async fn forward(model: &Model, options: &Options, settings: &Settings) -> Result<Status, Failure> {
    #[cfg(feature = "view")]
    if options.view {
        crate::view::needs_terminal()?;
    }
    let listeners = options.ports.listen(model).await?;
    let addresses = listeners.addresses()?;
    // Before the first line, because its reader may end the proxy at once.
    let mut interrupt = Interrupt::new()?;
    print::result(&endpoint::line(addresses))?;
    if !settings.faults.is_empty() && options.seed.is_none() {
        print::result(&seed(settings.seed, options.output.format))?;
    }
    #[cfg(feature = "view")]
    if options.view {
        let title = endpoint::line(addresses);
        let view = &RefCell::new(View::new(model, lang(), title.trim_end().to_owned()));
        let sink = &mut view::sink(view);
        let mut left = Ok(());
        let end = async { left = view::show(view, &mut interrupt).await };
        relay(model, options, settings, listeners, sink, end).await?;
        left?;
        return Ok(Status::Fine);
    }
    let sink = &mut |event: Event<'_, '_>| show(model, options.output.format, &event);
    relay(model, options, settings, listeners, sink, interrupt.next()).await?;
    Ok(Status::Fine)
}

/// Forwards connections until `end` is ready, and records them if that is wished.
#[cfg_attr(not(feature = "record"), expect(unused_variables))]
async fn relay<'m>(
    model: &'m Model,
    options: &Options,
    settings: &Settings,
    listeners: Listeners,
    sink: &mut Sink<'_, 'm>,
    end: impl Future<Output = ()>,
) -> Result<(), Failure> {
    let reflector = Reflector::new(model);
    #[cfg(feature = "record")]
    if let Some(path) = &options.record {
        let mut recorder = crate::record::recorder(model, path)?;
        let record = &mut |event: Event<'_, 'm>| {
            if let Event::Record(record) = &event {
                recorder.add(record).map_err(io::Error::other)?;
            }
            sink(event)
        };
        serve(&reflector, settings, listeners, record, end).await?;
        return Ok(recorder.finish()?);
    }
    Ok(serve(&reflector, settings, listeners, sink, end).await?)
}

fn seed(seed: u64, format: OutputFormat) -> String {
    match format {
        OutputFormat::Text => said!("种子 {seed}\n", "seed {seed}\n"),
        OutputFormat::Json => json!({ "seed": seed }).to_string() + "\n",
    }
}

fn show(model: &Model, format: OutputFormat, event: &Event<'_, '_>) -> io::Result<()> {
    let line = match (event, format) {
        (Event::Unreachable(..), _) => {
            let _ = print::error(&proxy::line(event, model, lang()));
            return Ok(());
        }
        (_, OutputFormat::Json) => proxy::json_line(event),
        (_, OutputFormat::Text) => proxy::line(event, model, lang()),
    };
    print::result(&(line + "\n"))
}
