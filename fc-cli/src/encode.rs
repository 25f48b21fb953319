//! `fcproto encode`.

use std::io::Write as _;

use clap::ValueEnum;
use clap_complete::ArgValueCompleter;
use fc_reflect::{Direction, Packing, Reflector};
use fc_spec::model::Model;
use fc_workshop::decode::hex;
use fc_workshop::request::frame;

use crate::call::values;
use crate::complete;
use crate::lang::both;
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
    let packing = if options.gzip {
        Packing::Gzip { level: LEVEL }
    } else {
        Packing::Plain
    };
    let values = values(options.json.as_deref(), &options.arguments)?;
    let side = (options.side.into(), options.id);
    let frame = frame(&Reflector::new(model), &options.name, side, values, packing)?;
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
