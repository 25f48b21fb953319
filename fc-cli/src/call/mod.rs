//! `fcproto call`.

mod interactive;
mod session;
pub mod show;

use std::path::PathBuf;
use std::time::Duration;

use clap::ValueEnum;
use clap_complete::ArgValueCompleter;
use fc_reflect::sample::Profile;
use fc_reflect::{Direction, Reflector};
use fc_spec::model::{Kind, Model, Operation, Side, Value};
use fc_workshop::arguments::{Arguments, json};
use fc_workshop::facts;

use crate::allow::{self, Allowed};
use crate::complete;
use crate::input;
use crate::lang::{both, said};
use crate::new::code;
use crate::outcome::{Failure, Status};
use crate::output::Output;
use crate::print;

/// Longest silence of a process that `--follow` waits for, in seconds.
const FOLLOW: &str = "300";

/// Options of `fcproto call`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[arg(
        value_name = "NAME",
        add = ArgValueCompleter::new(complete::call),
        required_unless_present_any = ["interactive", "list", "raw"],
        help = both("指令或流的名称", "Name of a command or stream")
    )]
    name: Option<String>,
    #[arg(
        value_name = "KEY=VALUE",
        add = ArgValueCompleter::new(complete::call),
        help = both("请求的值，例如 `data.x=1.5`", "Values of the request, such as `data.x=1.5`")
    )]
    arguments: Vec<String>,
    #[arg(
        long,
        value_name = "HOST[:PORT]",
        default_value = "127.0.0.1",
        help = both("机器人的地址；端口默认按规范", "Address of the robot; the port is that of the spec by default")
    )]
    to: String,
    #[arg(
        long,
        value_name = "JSON",
        conflicts_with = "arguments",
        help = both("请求的 JSON；`@FILE` 读文件，`@-` 读标准输入", "Request as JSON; `@FILE` reads a file, `@-` standard input")
    )]
    json: Option<String>,
    #[arg(
        long,
        value_names = ["CODE", "HEX"],
        num_args = 2,
        conflicts_with_all = ["name", "json", "list", "follow"],
        help = both("向功能码发送这些字节，不作检查", "Send these bytes to a code, unchecked")
    )]
    raw: Option<Vec<String>>,
    #[arg(
        long,
        value_name = "EFFECT",
        help = both("允许改变机器人的指令", "Allow commands that change the robot")
    )]
    allow: Option<Allowed>,
    #[arg(
        long,
        value_name = "N",
        default_value = "1",
        value_parser = clap::value_parser!(u32).range(1..),
        help = both("发送的次数，或流的帧数", "Number of calls, or of frames of a stream")
    )]
    repeat: u32,
    #[arg(
        long,
        value_name = "MS",
        value_parser = clap::value_parser!(u64).range(1..=86_400_000),
        help = both("等待响应的毫秒数 [默认：按规范]", "Milliseconds to wait for the response [default: by the spec]")
    )]
    timeout: Option<u64>,
    #[arg(
        long,
        value_name = "SECONDS",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = FOLLOW,
        value_parser = clap::value_parser!(u64).range(1..=86_400),
        help = both("跟随指令引起的过程直到结束；最长静默秒数默认为 300", "Follow the process until it ends; longest silence, 300 by default")
    )]
    follow: Option<u64>,
    #[arg(
        long,
        conflicts_with_all = ["name", "json", "follow"],
        help = both("列出全部指令和流", "List all commands and streams")
    )]
    list: bool,
    #[arg(
        long,
        conflicts_with_all = ["name", "json", "raw", "list", "follow", "repeat"],
        help = both("逐行输入指令，用 Tab 补全", "Read calls line by line, with completion by Tab")
    )]
    interactive: bool,
    #[command(flatten)]
    output: Output<OutputFormat>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum OutputFormat {
    #[value(help = both("对齐的表格", "An aligned table"))]
    Text,
    #[value(help = both("每条消息一行 JSON", "One line of JSON per message"))]
    Json,
}

/// A request that is ready to be sent.
struct Request<'m> {
    operation: Option<&'m Operation>,
    kind: u8,
    code: u16,
    data: Vec<u8>,
}

pub fn run(model: &Model, options: &Options) -> Result<Status, Failure> {
    let reflector = Reflector::new(model);
    if options.interactive {
        return interactive::run(&reflector, options);
    }
    if options.list {
        print::result(&show::list(
            model,
            options.output.format == OutputFormat::Json,
        ))?;
        return Ok(Status::Fine);
    }
    let request = request(&reflector, options, options.allow)?;
    fc_workshop::run::block_on(call(&reflector, options).run(&request))?
}

/// Returns the request of a command line.
fn request<'m>(
    reflector: &Reflector<'m>,
    options: &Options,
    allowed: Option<Allowed>,
) -> Result<Request<'m>, Failure> {
    let request = match &options.raw {
        Some(raw) => raw_request(reflector.model(), raw)?,
        None => named_request(reflector, options)?,
    };
    allow::check(request.operation, allowed)?;
    Ok(request)
}

/// Returns the settings of a command line.
fn call<'r, 'm>(reflector: &'m Reflector<'m>, options: &'r Options) -> session::Call<'r, 'm> {
    let timeout = options.timeout.map(Duration::from_millis);
    session::Call {
        reflector,
        to: &options.to,
        repeat: options.repeat,
        timeout: timeout.unwrap_or_else(|| facts::call_timeout(reflector.model())),
        follow: options.follow.map(Duration::from_secs),
        shown: show::Format {
            json: options.output.format == OutputFormat::Json,
        },
    }
}

/// Composes the request of an operation and checks it.
fn named_request<'m>(reflector: &Reflector<'m>, options: &Options) -> Result<Request<'m>, Failure> {
    let model = reflector.model();
    let name = options.name.as_deref().unwrap_or_default();
    let is_callable = |operation: &&Operation| operation.kind() != Kind::Report;
    let operation = model.operation(name).filter(is_callable).ok_or_else(|| {
        said!(
            "没有指令 `{name}`；`fcproto call --list` 列出全部指令",
            "there is no command `{name}`; `fcproto call --list` shows all"
        )
    })?;
    if options.follow.is_some() && operation.sets_off().is_empty() {
        return Err(said!(
            "`{name}` 不引起上报，不能用 --follow",
            "`{name}` sets off no reports; leave out --follow"
        )
        .into());
    }
    let Some(id) = reflector.id(operation, Direction::Request, 0) else {
        return Err(said!(
            "`{name}` 还没有功能码，不能发送",
            "`{name}` has no code yet, so it cannot be sent"
        )
        .into());
    };
    let request = |data| Request {
        operation: Some(operation),
        kind: id.kind,
        code: id.code,
        data,
    };
    let is_stream = operation.kind() == Kind::Stream;
    if is_stream && operation.sender == Side::Robot {
        if options.json.is_some() || !options.arguments.is_empty() {
            return Err(said!(
                "`{name}` 由机器人发送，不接受参数",
                "the robot sends `{name}`, so it takes no arguments"
            )
            .into());
        }
        return Ok(request(Vec::new()));
    }
    let body = operation.body(Direction::Request);
    if is_stream && body.is_none() {
        return Err(said!(
            "`{name}` 的内容是字节，`call` 只发送 JSON",
            "`{name}` has bytes, and `call` sends only JSON"
        )
        .into());
    }
    let body = match (&options.json, body) {
        (Some(text), _) => read_json(text)?,
        (None, Some(body)) => {
            let arguments = options.arguments.iter().map(String::as_str);
            Arguments::new(model).object(&body.ty, arguments)?
        }
        (None, None) => Value::Object(Vec::new()),
    };
    let data = if is_stream {
        body
    } else {
        let samples = reflector.samples();
        let mut message = samples.enveloped(Direction::Request, body, Profile::Example);
        facts::stamp(model, Direction::Request, &mut message);
        message
    };
    let data = data.to_string();
    let checked = reflector.message(Some(operation), Direction::Request, data.as_bytes());
    let text = checked.and_then(|message| message.canonical());
    let text = text.map_err(|error| show::breaks_the_spec(model, operation, &error))?;
    Ok(request(text.into_bytes()))
}

/// Reads the JSON object of an option, or the file that it names.
pub fn read_json(text: &str) -> Result<Value, Failure> {
    let text = match text.strip_prefix('@') {
        Some(file) => input::text(&PathBuf::from(file))?,
        None => text.to_owned(),
    };
    let value = json(&text).filter(|value| matches!(value, Value::Object(_)));
    value.ok_or_else(|| {
        said!(
            "`--json` 应为一个 JSON 对象",
            "`--json` needs a JSON object"
        )
        .into()
    })
}

fn raw_request<'m>(model: &'m Model, raw: &[String]) -> Result<Request<'m>, Failure> {
    let [number, hex] = raw else {
        return Err(said!("`--raw` 应有功能码和字节", "`--raw` needs a code and bytes").into());
    };
    let number = code(number)?;
    let data = bytes(hex).ok_or_else(|| {
        said!(
            "`{hex}` 不是十六进制字节，例如 `7b7d`",
            "`{hex}` is not bytes in hexadecimal, such as `7b7d`"
        )
    })?;
    let is_it = |operation: &&Operation| {
        operation.kind() == Kind::Command && operation.code.value == Some(number)
    };
    Ok(Request {
        operation: model.operations.iter().find(is_it),
        kind: model.frame.kinds.command.value,
        code: number,
        data,
    })
}

fn bytes(hex: &str) -> Option<Vec<u8>> {
    let digits: Vec<u8> = hex
        .chars()
        .filter(|it| !it.is_whitespace())
        .map(|it| it.to_digit(16).and_then(|digit| u8::try_from(digit).ok()))
        .collect::<Option<_>>()?;
    let pairs = digits.chunks_exact(2);
    if !pairs.remainder().is_empty() {
        return None;
    }
    let byte = |pair: &[u8]| pair.iter().fold(0, |byte, digit| byte << 4 | digit);
    Some(pairs.map(byte).collect())
}
