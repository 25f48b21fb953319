//! `fcproto encode`.

use std::io::Write as _;

use clap::ValueEnum;
use clap_complete::ArgValueCompleter;
use fc_reflect::sample::Profile;
use fc_reflect::{Direction, Error, Packing, Reflector};
use fc_spec::model::{Kind, Model};
use fc_workshop::arguments::Arguments;
use fc_workshop::decode::hex;

use crate::call::read_json;
use crate::complete;
use crate::lang::{both, said};
use crate::outcome::{Failure, Status};
use crate::print;

/// The gzip level of a compressed frame.
const LEVEL: u8 = 6;

/// Options of `fcproto encode`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[arg(
        value_name = "NAME",
        add = ArgValueCompleter::new(complete::operations),
        help = both("接口的名称", "Name of an operation")
    )]
    name: String,
    #[arg(
        value_name = "KEY=VALUE",
        help = both("正文的值，写法同 `fcproto call`", "Values of the body, written as for `fcproto call`")
    )]
    arguments: Vec<String>,
    #[arg(
        long,
        value_name = "JSON",
        conflicts_with = "arguments",
        help = both("正文的 JSON；`@FILE` 读文件，`@-` 读标准输入", "Body as JSON; `@FILE` reads a file, `@-` standard input")
    )]
    json: Option<String>,
    #[arg(
        long,
        value_name = "SIDE",
        default_value = "request",
        help = both("请求还是响应", "The request or the response")
    )]
    side: Side,
    #[arg(
        long,
        value_name = "ID",
        default_value = "1",
        help = both("消息号", "Message id")
    )]
    id: u32,
    #[arg(long, help = both("压缩后更短时压缩", "Compress the data if that makes it shorter"))]
    gzip: bool,
    #[arg(long, help = both("输出原始字节，而不是十六进制", "Print the bytes instead of hexadecimal"))]
    binary: bool,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Side {
    #[value(help = both("指令的请求，或上报", "The request of a command, or a report"))]
    Request,
    #[value(help = both("指令的响应，或上报的应答", "The response to a command, or the acknowledgement of a report"))]
    Response,
}

impl From<Side> for Direction {
    fn from(side: Side) -> Self {
        match side {
            Side::Request => Self::Request,
            Side::Response => Self::Response,
        }
    }
}

pub fn run(model: &Model, options: &Options) -> Result<Status, Failure> {
    let reflector = Reflector::new(model);
    let name = &options.name;
    let Some(operation) = model.operation(name) else {
        return Err(said!(
            "没有接口 `{name}`；`fcproto codes` 列出全部接口",
            "there is no operation `{name}`; `fcproto codes` lists them"
        )
        .into());
    };
    let direction = options.side.into();
    let Some(id) = reflector.id(operation, direction, options.id) else {
        return Err(said!(
            "`{name}` 还没有功能码，不能组成一帧",
            "`{name}` has no code yet, so it has no frame"
        )
        .into());
    };
    let packing = if options.gzip {
        Packing::Gzip { level: LEVEL }
    } else {
        Packing::Plain
    };
    let body = match (&options.json, options.arguments.as_slice()) {
        (Some(text), _) => Some(read_json(text)?),
        (None, []) => None,
        (None, arguments) => {
            let Some(body) = operation.body(direction) else {
                return Err(said!(
                    "`{name}` 这一侧没有 JSON 正文，不能带值",
                    "this side of `{name}` has no JSON body; leave out the values"
                )
                .into());
            };
            let arguments = arguments.iter().map(String::as_str);
            Some(Arguments::new(model).object(&body.ty, arguments)?)
        }
    };
    let data = match body {
        None => reflector.samples().data(operation, direction),
        Some(body) if operation.kind() == Kind::Stream => body.to_string().into(),
        Some(body) => {
            let samples = reflector.samples();
            let message = samples.enveloped(direction, body, Profile::Example);
            message.to_string().into()
        }
    };
    let frame = match reflector.encode(id, &data, packing) {
        Ok(frame) => frame,
        Err(Error::Body { error, .. }) => {
            return Err(said!("正文不合规范：{error}", "the body breaks the spec: {error}").into());
        }
        Err(Error::Frame(error)) => return Err(error.to_string().into()),
    };
    if options.binary {
        crate::progress::done();
        let mut stdout = std::io::stdout().lock();
        stdout.write_all(&frame)?;
        stdout.flush()?;
    } else {
        print::result(&(hex(&frame) + "\n"))?;
    }
    Ok(Status::Fine)
}
