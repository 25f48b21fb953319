//! `fcproto decode`.

use std::io::{self, BufWriter, StdoutLock, Write as _};

use clap::ValueEnum;
use clap_complete::ArgValueCompleter;
use fc_reflect::Reflector;
use fc_spec::model::Model;
use fc_workshop::decode::{self, Filter, Record};

use crate::complete;
use crate::lang::{both, lang};
use crate::new::code;
use crate::outcome::{Failure, Status};
use crate::output::Output;
use crate::recording::{OutputFormat, Recording};

/// Options of `fcproto decode`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[command(flatten)]
    recording: Recording,
    #[arg(
        long = "code",
        value_name = "CODE",
        value_parser = code,
        help = both("只显示这些功能码的帧", "Show frames with these codes only")
    )]
    codes: Vec<u16>,
    #[arg(
        long = "name",
        value_name = "NAME",
        add = ArgValueCompleter::new(complete::operations),
        help = both("只显示这些接口的帧", "Show frames of these operations only")
    )]
    names: Vec<String>,
    #[arg(
        long = "id",
        value_name = "ID",
        help = both("只显示这些消息号的帧", "Show frames with these message ids only")
    )]
    ids: Vec<u32>,
    #[arg(
        long = "result",
        value_name = "RESULT",
        help = both("只显示这些结果的响应，写结果码或名称", "Show responses with these results only, by code or name")
    )]
    results: Vec<String>,
    #[arg(
        long,
        value_name = "PART",
        help = both("只显示一部分", "Show a part only")
    )]
    only: Option<Only>,
    #[command(flatten)]
    output: Output<OutputFormat>,
}

/// The part to show.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Only {
    #[value(help = both("有错误的帧", "Frames with errors"))]
    Errors,
}

pub fn run(model: &Model, options: &Options) -> Result<Status, Failure> {
    let filter = Filter {
        codes: options.codes.clone(),
        ids: options.ids.clone(),
        only_errors: options.only.is_some(),
        ..Filter::new(model, &options.names, &options.results)?
    };
    let reflector = Reflector::new(model);
    let mut printer = Printer {
        model,
        options,
        filter,
        out: BufWriter::new(io::stdout().lock()),
        has_shown: false,
        status: Status::Fine,
    };
    options
        .recording
        .read(&reflector, &mut |record| printer.print(record))?;
    printer.out.flush()?;
    Ok(printer.status)
}

/// Prints the records that a filter selects.
struct Printer<'o, 'm> {
    model: &'m Model,
    options: &'o Options,
    filter: Filter,
    out: BufWriter<StdoutLock<'static>>,
    has_shown: bool,
    status: Status,
}

impl Printer<'_, '_> {
    fn print(&mut self, record: &Record<'_>) -> io::Result<()> {
        if !self.filter.wants(record) {
            return Ok(());
        }
        if record.error.is_some() {
            self.status = Status::Faulty;
        }
        let mut text = if self.options.output.format == OutputFormat::Json {
            decode::json(record)
        } else {
            decode::text(record, self.model, lang())
        };
        text.truncate(text.trim_end().len());
        text.push('\n');
        // A blank line separates the trees.
        if self.options.output.format == OutputFormat::Text
            && std::mem::replace(&mut self.has_shown, true)
        {
            self.out.write_all(b"\n")?;
        }
        self.out.write_all(text.as_bytes())?;
        // A person may wait for each frame.
        let is_live = self.options.recording.is_live();
        if is_live { self.out.flush() } else { Ok(()) }
    }
}
