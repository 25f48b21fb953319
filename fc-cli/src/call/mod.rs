//! `fcproto call`.

mod interactive;

use std::io;
use std::path::Path;
use std::time::Duration;

use clap::ValueEnum;
use clap_complete::ArgValueCompleter;
use fc_reflect::Reflector;
use fc_spec::model::{Kind, Model, Operation};
use fc_workshop::call::{Call, CallError, Ending, Event};
use fc_workshop::facts;
use fc_workshop::request::{Request, Values};
use fc_workshop::run::block_on;
use fc_workshop::transcript::Transcript;

use crate::allow::{Allowed, permission};
use crate::complete;
use crate::input;
use crate::lang::{both, lang, said};
use crate::new::code;
use crate::outcome::{Failure, Status, unanswered};
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

pub fn run(model: &Model, options: &Options) -> Result<Status, Failure> {
    let reflector = Reflector::new(model);
    if options.interactive {
        return interactive::run(&reflector, options);
    }
    if options.list {
        print::result(&options.transcript().operations(model))?;
        return Ok(Status::Fine);
    }
    let request = options.request(&reflector, options.allow)?;
    let call = options.call(&reflector);
    let sink = &mut |event: Event<'_, '_>| show(&reflector, options.transcript(), &event);
    status(block_on(call.run(&request, sink))?)
}

impl Options {
    fn transcript(&self) -> Transcript {
        match self.output.format {
            OutputFormat::Text => Transcript::Text(lang()),
            OutputFormat::Json => Transcript::Json,
        }
    }

    fn call<'r, 'm>(&'r self, reflector: &'m Reflector<'m>) -> Call<'r, 'm> {
        let timeout = self.timeout.map(Duration::from_millis);
        Call {
            reflector,
            to: &self.to,
            repeat: self.repeat,
            timeout: timeout.unwrap_or_else(|| facts::call_timeout(reflector.model())),
            follow: self.follow.map(Duration::from_secs),
        }
    }

    /// Returns the request, if it is allowed.
    fn request<'m>(
        &self,
        reflector: &Reflector<'m>,
        allowed: Option<Allowed>,
    ) -> Result<Request<'m>, Failure> {
        let model = reflector.model();
        let request = if let Some([number, hex]) = self.raw.as_deref() {
            Request::raw(model, code(number)?, hex)?
        } else {
            let name = self.name.as_deref().unwrap_or_default();
            self.check_follow(model.operation(name))?;
            let values = values(self.json.as_deref(), &self.arguments)?;
            Request::named(reflector, name, values)?
        };
        permission(allowed).check(request.operation)?;
        Ok(request)
    }

    /// Refuses to follow an operation that sets off no reports.
    fn check_follow(&self, operation: Option<&Operation>) -> Result<(), Failure> {
        let Some(operation) = operation.filter(|it| it.kind() != Kind::Report) else {
            return Ok(());
        };
        if self.follow.is_none() || !operation.sets_off().is_empty() {
            return Ok(());
        }
        let name = &operation.name;
        Err(said!(
            "`{name}` 不引起上报，不能用 --follow",
            "`{name}` sets off no reports; leave out --follow"
        )
        .into())
    }
}

/// Returns the values of a command line. `@FILE` instead of JSON names a file.
pub fn values(json: Option<&str>, arguments: &[String]) -> Result<Values, Failure> {
    let Some(json) = json else {
        return Ok(Values::Arguments(arguments.to_vec()));
    };
    match json.strip_prefix('@') {
        Some(file) => Ok(Values::json(&input::text(Path::new(file))?)?),
        None => Ok(Values::json(json)?),
    }
}

/// Prints an observation.
fn show(
    reflector: &Reflector<'_>,
    transcript: Transcript,
    event: &Event<'_, '_>,
) -> io::Result<()> {
    match event {
        Event::Response(response) => print::result(&transcript.response(response)),
        Event::Pushed(operation, frame) => {
            print::result(&transcript.pushed(reflector, operation, frame))
        }
        Event::Times(times) => print::result(&transcript.times(times.clone())),
        Event::Invalid(error) => {
            // Without standard error, the exit status is the only signal.
            let _ = print::error(&said!(
                "响应不合规范：{error}",
                "the response breaks the spec: {error}"
            ));
            Ok(())
        }
    }
}

/// Returns the status of a call. A robot that does not answer is no failure.
fn status(called: Result<Ending, CallError>) -> Result<Status, Failure> {
    match called {
        Ok(Ending::Success) => Ok(Status::Fine),
        Ok(Ending::Refused) => Ok(Status::Refused),
        Ok(Ending::Invalid) => Ok(Status::Unanswered),
        Err(CallError::Client(error)) => unanswered(error.into()),
        Err(CallError::Frame(error)) => Err(error.into()),
        Err(CallError::Sink(error)) => Err(error.into()),
    }
}
