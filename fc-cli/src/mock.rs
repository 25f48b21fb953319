//! `fcproto mock`.

use fc_workshop::mock::{Listeners, Settings, serve};
use fc_workshop::run::{Interrupt, block_on};

use crate::help::{Help, Part};
use crate::lang::both;
use crate::outcome::{Failure, Status};
use crate::place::Place;
use crate::print;
use crate::spec::Spec;

/// Options of `fcproto mock`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[arg(
        long,
        value_name = "HOST",
        default_value = "127.0.0.1",
        help = both("监听的地址", "Address to listen on")
    )]
    host: String,
    #[arg(
        long,
        value_name = "PORT",
        help = both("指令端口，0 为任意 [默认：按规范]", "Command port, 0 for any [default: by the spec]")
    )]
    command_port: Option<u16>,
    #[arg(
        long,
        value_name = "PORT",
        help = both("数据端口，0 为任意 [默认：按规范]", "Data port, 0 for any [default: by the spec]")
    )]
    data_port: Option<u16>,
}

pub fn help() -> Help {
    Help {
        summary: both("按规范模拟一台机器人", "Play a robot from the spec"),
        details: vec![
            Part::Text(both(
                "模拟端用规范中的示例响应指令，并以协议的结果码拒绝不合规范的请求。有周期的上报按周期发送；没有应答的上报按规范重发。\
                 标准输出的第一行是两个端口的地址。Ctrl-C 结束。",
                "The mock responds to commands with the examples of the spec. It refuses requests that break the spec with the results of the \
                 protocol. It sends reports at their intervals, and repeats those that nobody acknowledges as the spec demands. The first \
                 line on standard output has the addresses of both ports. Ctrl-C ends it.",
            )),
            Part::Examples(vec![
                (
                    "fcproto mock",
                    both("在规范的端口上", "On the ports of the spec"),
                ),
                (
                    "fcproto mock --command-port 0 --data-port 0",
                    both("在任意空闲端口上", "On any free ports"),
                ),
            ]),
        ],
        fails: both("规范有错误", "Errors in the spec"),
        speaks: "",
    }
}

pub fn run(place: &Place, options: &Options) -> Result<Status, Failure> {
    let spec = Spec::read(place)?;
    let Some(model) = &spec.model else {
        spec.show_faults()?;
        return Ok(spec.status());
    };
    let usual = Settings::of(model);
    let settings = Settings {
        host: options.host.clone(),
        command_port: options.command_port.unwrap_or(usual.command_port),
        data_port: options.data_port.unwrap_or(usual.data_port),
    };
    block_on(async {
        let listeners = Listeners::bind(&settings).await?;
        let (commands, data) = listeners.addresses()?;
        // Before the first line, because its reader may end the mock at once.
        let mut interrupt = Interrupt::new()?;
        print::result(&format!("commands {commands} data {data}\n"))?;
        serve(model, listeners, interrupt.next()).await;
        Ok(Status::Fine)
    })?
}
