//! `fcproto decode`.

use std::fs::File;
use std::io::{self, BufWriter, Read, StdoutLock, Write as _};
use std::path::{Path, PathBuf};

use clap::ValueEnum;
use fc_reflect::Reflector;
use fc_spec::model::Model;
use fc_workshop::capture::Ports;
use fc_workshop::decode::{self, DecodeError, Record, Source};

use crate::help::{Help, Part};
use crate::lang::{both, in_lang, lang, said};
use crate::new::code;
use crate::outcome::{Failure, Status};
use crate::place::Place;
use crate::spec::Spec;

/// Options of `fcproto decode`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[arg(
        value_name = "FILE",
        help = both("输入文件，`-` 表示标准输入 [默认：标准输入]", "Files, with `-` for standard input [default: standard input]")
    )]
    files: Vec<PathBuf>,
    #[arg(
        long,
        value_name = "FORMAT",
        help = both("输入格式 [默认：自动识别]", "Format of the input [default: detected]")
    )]
    input: Option<Input>,
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
        long = "port",
        value_name = "PORT",
        help = both("抓包中也读取这些端口的连接", "Also read connections on these ports of a capture")
    )]
    ports: Vec<u16>,
    #[arg(
        long,
        value_name = "PART",
        help = both("只显示一部分", "Show a part only")
    )]
    only: Option<Only>,
    #[arg(
        long,
        value_name = "FORMAT",
        default_value = "text",
        help = both("输出格式", "Output format")
    )]
    format: Shown,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Shown {
    #[value(help = both("每帧一棵树", "A tree per frame"))]
    Text,
    #[value(help = both("每帧一行 JSON", "One line of JSON per frame"))]
    Json,
}

/// The format of the input.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Input {
    #[value(help = both("十六进制，也可以是 `xxd` 或 `hexdump -C` 的输出", "Hexadecimal, also as `xxd` or `hexdump -C` print it"))]
    Hex,
    #[value(help = both("原始字节", "The bytes themselves"))]
    Binary,
    #[value(help = both("base64", "Base64"))]
    Base64,
    #[value(help = both("pcap 或 pcapng 抓包", "A capture, pcap or pcapng"))]
    Capture,
    #[value(help = both("`tcpdump -x` 或 `tcpdump -X` 的文本", "The text of `tcpdump -x` or `tcpdump -X`"))]
    Tcpdump,
}

impl From<Input> for decode::Format {
    fn from(input: Input) -> Self {
        match input {
            Input::Hex => Self::Hex,
            Input::Binary => Self::Binary,
            Input::Base64 => Self::Base64,
            Input::Capture => Self::Capture,
            Input::Tcpdump => Self::Tcpdump,
        }
    }
}

/// The part to show.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Only {
    #[value(help = both("有错误的帧", "Frames with errors"))]
    Errors,
}

pub fn help() -> Help {
    Help {
        summary: both("解析字节中的帧", "Decode the frames in recorded bytes"),
        details: vec![
            Part::Text(both(
                "按规范解析每一帧：包头各字段、正文各键的位置、值、单位和含义，以及第一个错误的位置。坏帧之后，从下一个完整的帧继续。\
                 响应与请求按功能码和消息号配对。",
                "Each frame is shown by the spec: the header fields, the position, value, unit and meaning of each key, and the place \
                 of the first error. After a bad frame, decoding continues at the next whole frame. Responses are paired with requests \
                 by code and message id.",
            )),
            Part::Examples(vec![
                (
                    "xxd -p dump.bin | fcproto decode",
                    both("解析十六进制文本", "Decode hexadecimal text"),
                ),
                ("fcproto decode --only errors dump.bin", ""),
                ("fcproto decode --format json capture.pcapng | jq .body", ""),
                (
                    "sudo tcpdump -U -w - tcp | fcproto decode",
                    both("边抓边看", "Watch live traffic"),
                ),
            ]),
        ],
        fails: both(
            "规范有错误，或显示的帧有错误",
            "Errors in the spec, or in the shown frames",
        ),
        speaks: both("`text` 格式", "`text`"),
    }
}

pub fn run(place: &Place, options: &Options) -> Result<Status, Failure> {
    let spec = Spec::read(place)?;
    let Some(model) = &spec.model else {
        spec.show_faults()?;
        return Ok(spec.status());
    };
    let filter = Filter::new(model, options)?;
    let reflector = Reflector::new(model);
    let mut printer = Printer {
        model,
        options,
        filter,
        out: BufWriter::new(io::stdout().lock()),
        status: Status::Fine,
    };
    crate::progress::done();
    let input = Path::new("-").to_owned();
    let files = if options.files.is_empty() {
        &[input]
    } else {
        options.files.as_slice()
    };
    for file in files {
        let result = if file.as_os_str() == "-" {
            // A person may wait for each frame.
            printer.print(&reflector, io::stdin(), true)
        } else {
            let input = File::open(file).map_err(|error| cannot(file, &error))?;
            printer.print(&reflector, input, false)
        };
        result.map_err(|error| failure(file, error))?;
    }
    Ok(printer.status)
}

fn failure(file: &Path, error: DecodeError) -> Failure {
    match error {
        DecodeError::Read(error) => cannot(file, &error),
        DecodeError::Input(error) => {
            let (file, error) = (file.display(), in_lang(error.text()));
            said!("`{file}`：{error}", "`{file}`: {error}").into()
        }
        DecodeError::Sink(error) => error.into(),
    }
}

fn cannot(file: &Path, error: &io::Error) -> Failure {
    let file = file.display();
    said!(
        "无法读取 `{file}`：{error}",
        "cannot read `{file}`: {error}"
    )
    .into()
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
        let has = |is_empty: bool, found: bool| is_empty || found;
        let id = record.id;
        let name = record.operation.map(|operation| &operation.name);
        (self.options.only.is_none() || record.error.is_some())
            && has(
                codes.is_empty(),
                id.is_some_and(|id| codes.contains(&id.code)),
            )
            && has(ids.is_empty(), id.is_some_and(|id| ids.contains(&id.id)))
            && has(
                names.is_empty(),
                name.is_some_and(|name| names.contains(name)),
            )
            && has(
                self.results.is_empty(),
                record
                    .result()
                    .is_some_and(|result| self.results.contains(&result)),
            )
    }
}

/// Prints the records that a filter selects.
struct Printer<'o, 'm> {
    model: &'m Model,
    options: &'o Options,
    filter: Filter<'o>,
    out: BufWriter<StdoutLock<'static>>,
    status: Status,
}

impl<'m> Printer<'_, 'm> {
    fn print(
        &mut self,
        reflector: &Reflector<'m>,
        input: impl Read + Send,
        is_live: bool,
    ) -> Result<(), DecodeError> {
        let source = Source {
            input,
            format: self.options.input.map(Into::into),
            ports: Ports::new(self.model, &self.options.ports),
        };
        decode::read(reflector, source, &mut |record| {
            if !self.filter.wants(record) {
                return Ok(());
            }
            if record.error.is_some() {
                self.status = Status::Faulty;
            }
            let mut text = if self.options.format == Shown::Json {
                decode::json(record)
            } else {
                decode::text(record, self.model, lang())
            };
            text.push('\n');
            self.out.write_all(text.as_bytes())?;
            if is_live { self.out.flush() } else { Ok(()) }
        })?;
        self.out.flush().map_err(DecodeError::Sink)
    }
}
