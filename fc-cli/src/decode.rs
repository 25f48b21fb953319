//! `fcproto decode`.

use std::io::{self, BufWriter, StdoutLock, Write as _};

use clap::ValueEnum;
use clap_complete::ArgValueCompleter;
use fc_reflect::Reflector;
use fc_spec::model::Model;
use fc_workshop::decode::{self, Record};

use crate::complete;
use crate::lang::{both, lang, said};
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
    let filter = Filter::new(model, options)?;
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

/// Selects records.
struct Filter<'o> {
    options: &'o Options,
    results: Vec<i64>,
}

impl<'o> Filter<'o> {
    fn new(model: &Model, options: &'o Options) -> Result<Self, Failure> {
        for name in &options.names {
            if model.operation(name).is_none() {
                return Err(said!(
                    "没有接口 `{name}`；`fcproto codes` 列出全部接口",
                    "there is no operation `{name}`; `fcproto codes` lists them"
                )
                .into());
            }
        }
        let result = |name: &String| {
            let known = model.results.iter().find(|result| result.name == *name);
            let code = known
                .map(|result| result.code)
                .or_else(|| name.parse().ok());
            code.ok_or_else(|| {
                said!(
                    "没有结果 `{name}`；写结果码，或规范中的名称",
                    "there is no result `{name}`; write a code, or a name of the spec"
                )
                .into()
            })
        };
        let results: Result<_, Failure> = options.results.iter().map(result).collect();
        Ok(Self {
            options,
            results: results?,
        })
    }

    fn wants(&self, record: &Record<'_>) -> bool {
        let Options {
            codes, names, ids, ..
        } = self.options;
        let name = record.operation.map(|operation| &operation.name);
        (self.options.only.is_none() || record.error.is_some())
            && has(codes, record.id.map(|id| id.code).as_ref())
            && has(ids, record.id.map(|id| id.id).as_ref())
            && has(names, name)
            && has(&self.results, record.result().as_ref())
    }
}

/// Returns `true` if a list has a value. An empty list has every value.
fn has<T: PartialEq>(wanted: &[T], value: Option<&T>) -> bool {
    wanted.is_empty() || value.is_some_and(|value| wanted.contains(value))
}

/// Prints the records that a filter selects.
struct Printer<'o, 'm> {
    model: &'m Model,
    options: &'o Options,
    filter: Filter<'o>,
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
