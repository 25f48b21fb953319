//! Samples that call and answer each operation, for the documentation's pages.
//!
//! A test of the package contains the same text, so no sample can become invalid.

use super::literal::Constants;
use super::source::{PYTHON, Python, method};
use crate::package::context::Context;
use crate::package::expr::Record;
use crate::package::language::PYTHON as LANGUAGE;
use crate::package::samples::{BYTES, PAGE_WIDTH, Sample, SampleRun, SampleStep, SampleTab, Verb};
use crate::package::source::Source;
use crate::package::style::Style;

/// The style of Python on a page.
static ON_PAGES: Style = Style {
    width: PAGE_WIDTH,
    ..PYTHON
};

/// The Python samples on the pages.
pub const TAB: SampleTab = SampleTab {
    fence: "python",
    file: "tests/test_samples.py",
    language: &LANGUAGE,
    style: &ON_PAGES,
    write: |out, _, sample| write(out, &mut Constants::default(), sample),
};

fn write(out: &mut Source, names: &mut Constants, sample: &Sample<'_, '_>) {
    match sample {
        Sample::Call(call, request) => {
            names.record(request).write(out, "request = ", "");
            out.line(format!("answer = await client.{}(request)", call.method));
            out.line("print(answer)");
        }
        Sample::Take(call) => {
            let ty = &call.request.ty.name;
            names.types.insert(ty.to_string());
            out.suite("async for report in client.reports()", |out| {
                out.suite(&format!("if isinstance(report, {ty})"), |out| {
                    out.line("print(report)");
                });
            });
        }
        Sample::Answer(call, answer) => {
            let [request, response] =
                [call.request, call.response].map(|it| it.ty.name.to_string());
            let request_parameter = format!("request: {request}");
            let parameters = ["self", "context: rt.Context", &request_parameter];
            let open = format!("async def {}(", call.method);
            method(out, &open, &parameters, &response, |out| {
                out.line("print(context.address, \"asks:\", request)");
                names.record(answer).write(out, "return ", "");
            });
            names.types.extend([request, response]);
        }
        Sample::Push(call, report) => {
            names.record(report).write(out, "report = ", "");
            let push = format!("await reporter.{}(report)", call.method);
            out.suite(&format!("for acknowledgement in {push}"), |out| {
                out.line("print(acknowledgement)");
            });
        }
        Sample::Subscribe(stream) => {
            let head = format!("async for item in streams.subscribe_{}()", stream.of.name);
            out.suite(&head, |out| out.line("print(item.id, item.content)"));
        }
        Sample::Send(stream, value) => {
            assign_content(out, names, value.as_ref());
            let name = &stream.of.name;
            out.line(format!("await streams.send_{name}(1, content)"));
        }
        Sample::Stream(stream, value) => {
            assign_content(out, names, value.as_ref());
            let name = &stream.of.name;
            out.line(format!("taken = await streamer.send_{name}(1, content)"));
            out.line("print(taken, \"data connections took it\")");
        }
    }
}

/// Writes `content = …`.
fn assign_content(out: &mut Source, names: &mut Constants, value: Option<&Record<'_>>) {
    match value {
        Some(value) => names.record(value).write(out, "content = ", ""),
        None => out.line(format!("content = b{BYTES:?}")),
    }
}

/// Generates the test that type-checks and runs every sample.
pub fn samples_file(context: &Context<'_>, package: &str) -> String {
    let run = &SampleRun::build(context);
    let mut names = Constants::default();
    names
        .types
        .extend(["Client", "Reporter", "Robot"].map(str::to_owned));
    let mut body = context.source();
    body.suite("class RobotOfTheSamples(Robot)", |out| {
        out.line("\"\"\"Responds with the samples.\"\"\"");
        for answer in run.answers() {
            out.blank();
            write(out, &mut names, &answer);
        }
    });
    for (step, sample) in run.samples() {
        let [name, ty] = step.parameter();
        names.types.insert(ty.to_owned());
        body.gap();
        let head = format!("async def {}({name}: {ty}) -> None", step.name());
        body.suite(&head, |out| write(out, &mut names, &sample));
    }
    body.gap();
    test(&mut body, run);

    let mut out = context.source();
    out.line("\"\"\"The samples of the documentation. They call every command, and push and receive every report.\"\"\"");
    out.blank();
    out.line("from __future__ import annotations\n\nimport asyncio\nimport contextlib\nimport io\nimport unittest");
    out.line("import warnings\n\nimport fc_runtime as rt");
    let names: Vec<&str> = names.types.iter().map(String::as_str).collect();
    out.import_each(package, &names);
    out.gap();
    out.append(&body);
    out.line("\n\nif __name__ == \"__main__\":\n    unittest.main()");
    out.finish()
}

fn test(out: &mut Source, run: &SampleRun<'_, '_>) {
    out.line(
        "\
class Samples(unittest.IsolatedAsyncioTestCase):
    async def test_every_sample_runs(self) -> None:
        # A robot still handles deprecated commands.
        warnings.simplefilter(\"ignore\", DeprecationWarning)
        config = rt.ServerConfig(address=\"127.0.0.1\", command_port=0, data_port=0, handler_timeout=60.0)
        server = rt.Server(RobotOfTheSamples(), config)
        await server.bind()
        host, port = server.command_address",
    );
    let config = if run.has_streams() {
        out.line(
            "        data = server.data_address[1]
        settings = rt.ClientConfig(host=host, command_port=port, data_port=data, call_timeout=60.0)",
        );
        "settings"
    } else {
        "rt.ClientConfig(host=host, command_port=port, call_timeout=60.0)"
    };
    out.line(format!(
        "        with contextlib.redirect_stdout(io.StringIO()):
            async with Client.connect({config}) as client:"
    ));
    let line = |out: &mut Source, text: &str| out.line(["                ", text].concat());
    let call = |step: SampleStep<'_>| format!("{}({})", step.name(), step.parameter()[0]);
    let wait = |out: &mut Source, verb: Verb| {
        for step in run.that(verb) {
            line(out, &format!("await {}", call(step)));
        }
    };
    wait(out, Verb::Call);
    if run.has_streams() {
        line(out, "data_connection = client.data()");
        line(out, "await data_connection.connected()");
        line(out, "streams = Streams(data_connection)");
    }
    line(out, "takers = [");
    for step in run.that(Verb::Take).chain(run.that(Verb::Subscribe)) {
        line(out, &format!("    asyncio.ensure_future({}),", call(step)));
    }
    line(out, "]");
    line(out, "await asyncio.sleep(0)");
    line(out, "reporter = Reporter(server)");
    wait(out, Verb::Push);
    if run.has(Verb::Stream) {
        line(out, "streamer = Streamer(server)");
    }
    wait(out, Verb::Stream);
    wait(out, Verb::Send);
    line(out, "for taker in takers:");
    line(out, "    taker.cancel()");
    out.line("        await server.shutdown(0)");
}
