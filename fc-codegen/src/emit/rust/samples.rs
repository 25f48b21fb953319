//! Samples that call and answer each operation, for the documentation's pages.
//!
//! A test of the generated crate contains the same text, so no sample can become invalid.

use super::constants::{ConstantScope, indented, spelled_record};
use super::context::Context;
use super::robot::signature;
use super::source::{RUST, Source};
use crate::package::expr::Record;
use crate::package::language::RUST as LANGUAGE;
use crate::package::name::free;
use crate::package::samples::{BYTES, Sample, SampleRun, SampleStep, SampleTab, Verb};

/// The Rust samples on the pages.
pub const TAB: SampleTab = SampleTab {
    fence: "rust",
    file: "tests/samples.rs",
    language: &LANGUAGE,
    style: &RUST,
    write,
};

fn write(out: &mut Source, context: &Context<'_>, sample: &Sample<'_, '_>) {
    let audience = runtime(context, "Audience");
    match sample {
        Sample::Call(call, request) => {
            assign(out, "request", request);
            out.line(format!(
                "let answer = client.{}(&request).await?;",
                call.method
            ));
            out.line("println!(\"{answer:?}\");");
        }
        Sample::Take(call) => {
            let ty = &call.request.ty.name;
            out.block("while let Some(report) = reports.recv().await", |out| {
                out.block(format!("if let AnyReport::{ty}(report) = report?"), |out| {
                    out.line("println!(\"{report:?}\");");
                });
            });
        }
        Sample::Answer(call, answer) => {
            let (of_runtime, protocol) = (runtime(context, "Context"), &context.package.name);
            let cx = format!("context: {of_runtime}<{protocol}>");
            let request = format!("request: {}", call.request.ty.name);
            let refusal = runtime(context, "Refusal");
            let types = [&*cx, &request, &call.response.ty.name, &refusal];
            signature(out, call.method, types, " {");
            let answer = spelled_record(answer, ConstantScope::Program, 0);
            out.line(indented(&format!(
                "println!(\"{{}} asks: {{request:?}}\", context.peer);\nOk({answer})\n"
            )));
            out.line("}");
        }
        Sample::Push(call, report) => {
            assign(out, "report", report);
            let push = format!("reporter.{}({audience}::All, &report).await?", call.method);
            out.block(format!("for acknowledgement in {push}"), |out| {
                out.line("println!(\"{acknowledgement:?}\");");
            });
        }
        Sample::Subscribe(stream) => {
            let name = &stream.of.name;
            out.line(format!(
                "let mut subscription = streams.subscribe_{name}();"
            ));
            out.block("while let Ok(item) = subscription.recv().await", |out| {
                out.line("println!(\"{}: {:?}\", item.id, item.content);");
            });
        }
        Sample::Send(stream, value) => {
            let (name, carried) = (&stream.of.name, assign_content(out, value.as_ref()));
            out.line(format!("streams.send_{name}(1, {carried}).await?;"));
        }
        Sample::Stream(stream, value) => {
            let (name, carried) = (&stream.of.name, assign_content(out, value.as_ref()));
            out.line(format!(
                "let taken = streamer.send_{name}({audience}::All, 1, {carried}).await?;"
            ));
            out.line("println!(\"{taken} data connections took it\");");
        }
    }
}

/// Returns a name of the runtime. The name has its full path if a type of the spec has the same name.
fn runtime(context: &Context<'_>, name: &str) -> String {
    let path = if context.package.has_type(name) {
        "fc_runtime::"
    } else {
        ""
    };
    [path, name].concat()
}

fn assign(out: &mut Source, name: &str, value: &Record<'_>) {
    let value = spelled_record(value, ConstantScope::Program, name.len() + 8);
    out.line(format!("let {name} = {value};"));
}

/// Assigns the content of a stream, unless it is bytes, and returns the expression for it.
fn assign_content(out: &mut Source, value: Option<&Record<'_>>) -> String {
    let Some(value) = value else {
        return format!("b{BYTES:?}");
    };
    assign(out, "content", value);
    "&content".to_owned()
}

/// Generates the test that compiles and runs every sample.
#[must_use]
pub fn samples_file(context: &Context<'_>, krate: &str) -> String {
    let run = &SampleRun::build(context);
    let taken = |name: &str| context.package.has_type(name);
    let robot = free(&["SampleRobot", "RobotOfTheSamples"], taken);
    let mut out = context.source();
    out.template("samples", &[("krate", krate)]);
    let names = ["Audience", "Bytes64", "Context", "Refusal"];
    let names: Vec<&str> = names.into_iter().filter(|name| !taken(name)).collect();
    out.import("fc_runtime", &names);
    out.blank();
    out.line(format!("struct {robot};"));
    out.blank();
    out.block(format!("impl Robot for {robot}"), |out| {
        for answer in run.answers() {
            out.blank();
            write(out, context, &answer);
        }
    });
    for (step, sample) in run.samples() {
        let parameter = match step.parameter() {
            _ if step.verb == Verb::Take => "mut reports: Reports".to_owned(),
            [name, ty] => format!("{name}: &{ty}"),
        };
        let head = format!("async fn {}({parameter}) -> {RESULT}", step.name());
        out.blank();
        out.block(head, |out| {
            write(out, context, &sample);
            out.line("Ok(())");
        });
    }
    test_of_samples(&mut out, &robot, run);
    out.finish()
}

/// The result type of every function.
const RESULT: &str = "Result<(), Box<dyn std::error::Error>>";

fn call(step: SampleStep<'_>) -> String {
    match step.parameter() {
        _ if step.verb == Verb::Take => format!("{}(client.reports())", step.name()),
        [name, _] => format!("{}(&{name})", step.name()),
    }
}

fn test_of_samples(out: &mut Source, robot: &str, run: &SampleRun<'_, '_>) {
    let has_streams = run.has_streams();
    let [data, data_port] = if has_streams {
        ["let data = server.data_addr().port();", ".data_port(data)"]
    } else {
        [""; 2]
    };
    out.blank();
    out.line("#[tokio::test]");
    out.block(format!("async fn every_sample_runs() -> {RESULT}"), |out| {
        let values = [("sample_robot", robot), ("data", data), ("data_port", data_port)];
        out.template("sample_server", &values);
        wait(out, run, Verb::Call);
        if run.has(Verb::Take) {
            out.line("let reporter = Reporter::new(handle.clone());");
            let about =
                "// An app takes reports without end; a push ends when every app has acknowledged it.";
            select(out, run, [Verb::Take, Verb::Push], ["pushes", "pushed"], about);
        }
        if has_streams {
            out.line("let streams = Streams::new(client.data());\nstreams.data().connected().await?;");
            if run.has(Verb::Subscribe) {
                out.line("let streamer = Streamer::new(handle.clone());");
                select(out, run, [Verb::Subscribe, Verb::Stream], ["sending", "sent"], "");
            }
            wait(out, run, Verb::Send);
            out.line("drop(streams);");
        }
        out.template("sample_end", &[]);
    });
}

fn wait(out: &mut Source, run: &SampleRun<'_, '_>, verb: Verb) {
    for step in run.that(verb) {
        out.line(format!("{}.await?;", call(step)));
    }
}

/// Runs the endless receiving steps concurrently with the sending steps, until the sending steps end.
fn select(
    out: &mut Source,
    run: &SampleRun<'_, '_>,
    [take, give]: [Verb; 2],
    [giving, given]: [&str; 2],
    about: &str,
) {
    let takers: Vec<String> = run.that(take).map(call).collect();
    out.list("let takers = async { tokio::try_join!(", &takers, ") };");
    out.enclose(&format!("let {giving} = async {{"), "};", |out| {
        wait(out, run, give);
        out.line("Ok::<(), Box<dyn std::error::Error>>(())");
    });
    out.line(about);
    out.template("sample_select", &[("giving", giving), ("given", given)]);
}
