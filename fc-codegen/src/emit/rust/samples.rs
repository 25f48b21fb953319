//! How each operation is called and answered, as the pages of the documentation show it. The same
//! text stands in a test of the generated crate, so no sample can rot.

use super::constants::{Place, indented, spelled_record};
use super::robot::signature;
use super::source::{RUST, Source};
use crate::emit::stub::samples as stub;
use crate::sample::Samples;
use crate::surface::expr::Record;
use crate::surface::name::free;
use crate::surface::package::{Call, Package};
use crate::target::Targets;
use fc_spec::model::{Direction, Kind, Operation, Side};
use stub::Snippets as _;

/// How the pages show the package.
pub const SHOWN: stub::Shown = stub::Shown {
    fence: "rust",
    file: "tests/samples.rs",
    language: Targets::rust,
    style: &RUST,
    snippets: |context, samples| Box::new(Snippets::new(&context.package, samples)),
};

/// What makes the samples of a package.
pub struct Snippets<'p, 'm> {
    package: &'p Package<'m>,
    samples: &'p Samples<'m>,
}

impl stub::Snippets for Snippets<'_, '_> {
    fn app(&self, operation: &Operation) -> Option<String> {
        if operation.kind() == Kind::Stream {
            return self.app_stream(operation);
        }
        let Call {
            method, request, ..
        } = self.package.call(operation)?;
        if operation.kind() == Kind::Command {
            let request = self.example(operation, Direction::Request)?;
            return Some(format!(
                "{}let answer = client.{method}(&request).await?;\nprintln!(\"{{answer:?}}\");\n",
                assign("request", &request)
            ));
        }
        Some(format!(
            "while let Some(report) = reports.recv().await {{\n    \
                 if let AnyReport::{ty}(report) = report? {{\n        \
                     println!(\"{{report:?}}\");\n    \
                 }}\n\
             }}\n",
            ty = request.ty.name
        ))
    }

    fn robot(&self, operation: &Operation) -> Option<String> {
        if operation.kind() == Kind::Stream {
            return self.robot_stream(operation);
        }
        let call = self.package.call(operation)?;
        let method = call.method;
        match operation.kind() {
            Kind::Command => {
                let answer = self.example(operation, Direction::Response)?;
                let context = self.runtime("Context");
                let context = format!("context: {context}<{}>", self.package.name);
                let request = format!("request: {}", call.request.ty.name);
                let refusal = self.runtime("Refusal");
                let response = &call.response.ty.name;
                let (open, params, close) =
                    signature(method, &context, &request, response, &refusal);
                let mut out = Source::rust();
                out.list(&open, &params, &format!("{close} {{"));
                let lines = format!(
                    "println!(\"{{}} asks: {{request:?}}\", context.peer);\nOk({})\n",
                    spelled_record(&answer, Place::Outside, 0)
                );
                out.line(indented(&lines));
                out.line("}");
                Some(out.finish())
            }
            Kind::Report => {
                let report = self.example(operation, Direction::Request)?;
                let audience = self.runtime("Audience");
                Some(format!(
                    "{}for acknowledgement in reporter.{method}({audience}::All, &report).await? {{\n    \
                         println!(\"{{acknowledgement:?}}\");\n\
                     }}\n",
                    assign("report", &report)
                ))
            }
            Kind::Stream => None,
        }
    }
}

impl<'p, 'm> Snippets<'p, 'm> {
    /// Of the Rust package, with values from `samples`.
    #[must_use]
    pub fn new(package: &'p Package<'m>, samples: &'p Samples<'m>) -> Self {
        Self { package, samples }
    }

    /// A name of the runtime beside types of the spec; by its full path where one of them has it.
    fn runtime(&self, name: &str) -> String {
        if self.package.has_type(name) {
            format!("fc_runtime::{name}")
        } else {
            name.to_owned()
        }
    }

    fn app_stream(&self, stream: &Operation) -> Option<String> {
        stub::is_there(self.package, stream).then(|| {
            let name = &stream.name;
            if stream.sender == Side::Robot {
                return format!(
                    "let mut subscription = streams.subscribe_{name}();\n\
                     while let Ok(item) = subscription.recv().await {{\n    \
                         println!(\"{{}}: {{:?}}\", item.id, item.content);\n\
                     }}\n"
                );
            }
            let (before, content) = self.content(stream);
            format!("{before}streams.send_{name}(1, {content}).await?;\n")
        })
    }

    fn robot_stream(&self, stream: &Operation) -> Option<String> {
        let is_own = stub::is_there(self.package, stream) && stream.sender == Side::Robot;
        is_own.then(|| {
            let (before, content) = self.content(stream);
            let (name, audience) = (&stream.name, self.runtime("Audience"));
            format!(
                "{before}let taken = streamer.send_{name}({audience}::All, 1, {content}).await?;\n\
                 println!(\"{{taken}} data connections took it\");\n"
            )
        })
    }

    /// What is said before a stream is sent, and what is sent.
    fn content(&self, stream: &Operation) -> (String, String) {
        match self.example(stream, Direction::Request) {
            Some(content) => (assign("content", &content), "&content".to_owned()),
            None => (String::new(), format!("b{:?}", stub::BYTES)),
        }
    }

    fn example(&self, operation: &Operation, direction: Direction) -> Option<Record<'p>> {
        stub::example(self.package, self.samples, operation, direction)
    }
}

fn assign(name: &str, value: &Record<'_>) -> String {
    let value = spelled_record(value, Place::Outside, name.len() + 8);
    format!("let {name} = {value};\n")
}

/// The test that compiles and runs every sample.
#[must_use]
pub fn file(package: &Package<'_>, samples: &Samples<'_>, krate: &str) -> String {
    let snippets = Snippets::new(package, samples);
    let commands = package.calls(Kind::Command);
    let reports = package.calls(Kind::Report);
    let taken = |name: &str| package.has_type(name);
    let robot = free(&["SampleRobot", "RobotOfTheSamples"], taken);
    let mut out = Source::rust();
    out.line(
        "\
//! The samples that the documentation shows, compiled and run: every command is called, every
//! report pushed and taken.

#![allow(deprecated, reason = \"a robot still handles deprecated commands\")]
#![allow(
    clippy::approx_constant,
    clippy::print_stdout,
    clippy::similar_names,
    clippy::too_many_lines,
    clippy::unreadable_literal,
    clippy::wildcard_imports,
    missing_docs,
    unused_imports,
    reason = \"samples contain the examples of the spec\"
)]",
    );
    out.blank();
    out.line(format!("use {krate}::*;"));
    let names = ["Audience", "Bytes64", "Context", "Refusal"];
    let names: Vec<&str> = names.into_iter().filter(|name| !taken(name)).collect();
    out.import("fc_runtime", &names);
    out.blank();
    out.line(format!("struct {robot};"));
    robot_of_samples(&mut out, &snippets, &robot, &commands);
    functions(&mut out, &snippets, &commands, &reports);
    stream_functions(&mut out, &snippets);
    test_of_samples(&mut out, package, &robot, &commands, &reports);
    out.finish()
}

fn robot_of_samples(
    out: &mut Source,
    snippets: &Snippets<'_, '_>,
    robot: &str,
    commands: &[Call<'_>],
) {
    out.blank();
    out.block(format!("impl Robot for {robot}"), |out| {
        for command in commands {
            if let Some(sample) = snippets.robot(command.operation) {
                out.blank();
                out.line(sample);
            }
        }
    });
}

/// The functions around the samples of streams: an app subscribes and sends, a robot sends.
fn stream_functions(out: &mut Source, snippets: &Snippets<'_, '_>) {
    let mut function = |head: String, sample: Option<String>| {
        let Some(sample) = sample else { return };
        out.blank();
        let head = format!("async fn {head} -> Result<(), Box<dyn std::error::Error>>");
        out.block(head, |out| {
            out.line(sample);
            out.line("Ok(())");
        });
    };
    for stream in stub::streams(snippets.package, Side::Robot) {
        let name = &stream.name;
        function(
            format!("subscribe_{name}(streams: &Streams)"),
            snippets.app(stream),
        );
        function(
            format!("send_{name}(streamer: &Streamer)"),
            snippets.robot(stream),
        );
    }
    for stream in stub::streams(snippets.package, Side::App) {
        function(
            format!("send_{}(streams: &Streams)", stream.name),
            snippets.app(stream),
        );
    }
}

fn functions(
    out: &mut Source,
    snippets: &Snippets<'_, '_>,
    commands: &[Call<'_>],
    reports: &[Call<'_>],
) {
    for command in commands {
        let Some(sample) = snippets.app(command.operation) else {
            continue;
        };
        out.blank();
        let name = &command.operation.name;
        out.block(
            format!(
                "async fn call_{name}(client: &Client) -> Result<(), Box<dyn std::error::Error>>"
            ),
            |out| {
                out.line(sample);
                out.line("Ok(())");
            },
        );
    }
    for report in reports {
        let (Some(app), Some(robot)) = (
            snippets.app(report.operation),
            snippets.robot(report.operation),
        ) else {
            continue;
        };
        let name = &report.operation.name;
        out.blank();
        out.block(
            format!("async fn take_{name}(mut reports: Reports) -> Result<(), Box<dyn std::error::Error>>"),
            |out| {
                out.line(app);
                out.line("Ok(())");
            },
        );
        out.blank();
        out.block(
            format!("async fn push_{name}(reporter: &Reporter) -> Result<(), Box<dyn std::error::Error>>"),
            |out| {
                out.line(robot);
                out.line("Ok(())");
            },
        );
    }
}

fn test_of_samples(
    out: &mut Source,
    package: &Package<'_>,
    robot: &str,
    commands: &[Call<'_>],
    reports: &[Call<'_>],
) {
    let sides = [Side::Robot, Side::App];
    let [from_robot, from_app] = sides.map(|side| stub::streams(package, side));
    let has_streams = !from_robot.is_empty() || !from_app.is_empty();
    let data = if has_streams { ".data_port(data)" } else { "" };
    out.blank();
    out.line("#[tokio::test]");
    out.block("async fn every_sample_runs() -> Result<(), Box<dyn std::error::Error>>", |out| {
        out.line(format!(
            "\
let host = std::net::Ipv4Addr::LOCALHOST;
let config = fc_runtime::ServerConfig::new().address(host).command_port(0).data_port(0);
let server = fc_runtime::Server::bind(config, RobotService::new({robot})).await?;
let port = server.command_addr().port();"
        ));
        if has_streams {
            out.line("let data = server.data_addr().port();");
        }
        out.line(format!(
            "\
let handle = server.handle();
let serving = tokio::spawn(server.run());
let config = fc_runtime::ClientConfig::new().host(host.to_string()).command_port(port){data};
let client = Client::connect(config).await?;"
        ));
        for command in commands {
            out.line(format!("call_{}(&client).await?;", command.operation.name));
        }
        if !reports.is_empty() {
            out.line("let reporter = Reporter::new(handle.clone());");
            let takers: Vec<String> =
                reports.iter().map(|report| format!("take_{}(client.reports())", report.operation.name)).collect();
            let pushes: Vec<String> =
                reports.iter().map(|report| format!("push_{}(&reporter).await?;\n", report.operation.name)).collect();
            out.list("let takers = async { tokio::try_join!(", &takers, ") };");
            out.enclose("let pushes = async {", "};", |out| {
                out.line(pushes.concat());
                out.line("Ok::<(), Box<dyn std::error::Error>>(())");
            });
            out.line("// An app takes reports without end; a push ends when every app has acknowledged it.");
            out.enclose("tokio::select! {", "}", |out| {
                out.line("taken = takers => drop(taken?),");
                out.line("pushed = pushes => pushed?,");
            });
        }
        if has_streams {
            run_streams(out, &from_robot, &from_app);
        }
        out.line("drop(client);");
        out.line("handle.shutdown(std::time::Duration::from_secs(1)).await;");
        out.line("serving.await?;");
        out.line("Ok(())");
    });
}

/// Runs the samples of streams.
fn run_streams(out: &mut Source, from_robot: &[&Operation], from_app: &[&Operation]) {
    out.line("let streams = Streams::new(client.data());\nstreams.data().connected().await?;");
    if !from_robot.is_empty() {
        out.line("let streamer = Streamer::new(handle.clone());");
        let takers = from_robot
            .iter()
            .map(|stream| format!("subscribe_{}(&streams)", stream.name));
        let takers: Vec<String> = takers.collect();
        out.list("let takers = async { tokio::try_join!(", &takers, ") };");
        out.enclose("let sending = async {", "};", |out| {
            for stream in from_robot {
                out.line(format!("send_{}(&streamer).await?;", stream.name));
            }
            out.line("Ok::<(), Box<dyn std::error::Error>>(())");
        });
        out.enclose("tokio::select! {", "}", |out| {
            out.line("taken = takers => drop(taken?),");
            out.line("sent = sending => sent?,");
        });
    }
    for stream in from_app {
        out.line(format!("send_{}(&streams).await?;", stream.name));
    }
    out.line("drop(streams);");
}
