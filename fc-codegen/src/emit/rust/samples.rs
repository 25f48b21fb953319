//! How each operation is called and answered, as the pages of the documentation show it. The same
//! text stands in a test of the generated crate, so no sample can rot.

use super::constants::{Place, indented, spelled_record};
use super::robot::signature;
use super::source::Source;
use crate::sample::{Profile, Samples};
use crate::surface::expr::{Expressions, Record};
use crate::surface::name::free;
use crate::surface::package::{Call, Package};
use fc_spec::model::{Direction, Kind, Operation};

/// What makes the samples of a package.
pub struct Snippets<'p, 'm> {
    package: &'p Package<'m>,
    samples: &'p Samples<'m>,
}

impl<'p, 'm> Snippets<'p, 'm> {
    /// Of the Rust package, with values from `samples`.
    #[must_use]
    pub fn new(package: &'p Package<'m>, samples: &'p Samples<'m>) -> Self {
        Self { package, samples }
    }

    /// What an app does: calls a command, or takes a report. `None` without a code.
    #[must_use]
    pub fn app(&self, operation: &Operation) -> Option<String> {
        let Call {
            method, request, ..
        } = self.package.call(operation)?;
        match operation.kind() {
            Kind::Command => {
                let request = self.message(operation, Direction::Request)?;
                Some(format!(
                    "{}let answer = client.{method}(&request).await?;\nprintln!(\"{{answer:?}}\");\n",
                    assign("request", &request)
                ))
            }
            Kind::Report => Some(format!(
                "while let Some(report) = reports.recv().await {{\n    \
                     if let AnyReport::{ty}(report) = report? {{\n        \
                         println!(\"{{report:?}}\");\n    \
                     }}\n\
                 }}\n",
                ty = request.ty.name
            )),
            Kind::Stream => None,
        }
    }

    /// What a robot does: answers a command, or pushes a report. `None` without a code.
    #[must_use]
    pub fn robot(&self, operation: &Operation) -> Option<String> {
        let call = self.package.call(operation)?;
        let method = call.method;
        match operation.kind() {
            Kind::Command => {
                let answer = self.message(operation, Direction::Response)?;
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
                let report = self.message(operation, Direction::Request)?;
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

    /// A name of the runtime beside types of the spec; by its full path where one of them has it.
    fn runtime(&self, name: &str) -> String {
        if self.package.has_type(name) {
            format!("fc_runtime::{name}")
        } else {
            name.to_owned()
        }
    }

    /// The example body of one side; `None` of a stream.
    fn message(&self, operation: &Operation, direction: Direction) -> Option<Record<'_>> {
        let body = operation.messages()?.body(direction);
        let value = self.samples.body(operation, direction, Profile::Example);
        let expressions = Expressions::new(self.package, self.samples);
        Some(expressions.record(&body.ty, &value))
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

#![allow(deprecated, reason = \"a robot still answers what is withdrawn\")]
#![allow(
    clippy::approx_constant,
    clippy::print_stdout,
    clippy::similar_names,
    clippy::too_many_lines,
    clippy::unreadable_literal,
    clippy::wildcard_imports,
    missing_docs,
    unused_imports,
    reason = \"samples are as the spec's examples are\"
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
    test_of_samples(&mut out, &robot, &commands, &reports);
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

fn test_of_samples(out: &mut Source, robot: &str, commands: &[Call<'_>], reports: &[Call<'_>]) {
    out.blank();
    out.line("#[tokio::test]");
    out.block("async fn every_sample_runs() -> Result<(), Box<dyn std::error::Error>>", |out| {
        out.line(format!(
            "\
let host = std::net::Ipv4Addr::LOCALHOST;
let config = fc_runtime::ServerConfig::new().address(host).command_port(0).data_port(0);
let server = fc_runtime::Server::bind(config, RobotService::new({robot})).await?;
let port = server.command_addr().port();
let handle = server.handle();
let serving = tokio::spawn(server.run());
let config = fc_runtime::ClientConfig::new().host(host.to_string()).command_port(port);
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
            out.line("// An app takes reports for ever; a push is done when every app has acknowledged it.");
            out.enclose("tokio::select! {", "}", |out| {
                out.line("taken = takers => drop(taken?),");
                out.line("pushed = pushes => pushed?,");
            });
        }
        out.line("drop(client);");
        out.line("handle.shutdown(std::time::Duration::from_secs(1)).await;");
        out.line("serving.await?;");
        out.line("Ok(())");
    });
}
