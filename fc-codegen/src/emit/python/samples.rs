//! How each operation is called and answered, as the pages of the documentation show it. The same text stands in a test
//! of the package, so no sample can rot.

use super::literal::Constants;
use super::source::{Code, PYTHON, Python, method};
use crate::emit::stub::context::Context;
use crate::emit::stub::samples as stub;
use crate::emit::stub::source::Source;
use crate::emit::stub::style::Style;
use crate::sample::Samples;
use crate::surface::expr::Record;
use crate::surface::package::{Call, Package};
use crate::target::Targets;
use fc_spec::model::{Direction, Kind, Operation, Side};

/// Python as it stands on a page.
static ON_PAGES: Style = Style {
    width: stub::PAGE_WIDTH,
    ..PYTHON
};

/// How the pages show the package.
pub const SHOWN: stub::Shown = stub::Shown {
    fence: "python",
    file: "tests/test_samples.py",
    language: Targets::python,
    style: &ON_PAGES,
    snippets: |context, samples| Box::new(Snippets::new(&context.package, samples)),
};

/// What makes the samples of a package.
pub struct Snippets<'p, 'm> {
    package: &'p Package<'m>,
    samples: &'p Samples<'m>,
}

impl stub::Snippets for Snippets<'_, '_> {
    fn app(&self, operation: &Operation) -> Option<String> {
        let mut out = Source::new(&ON_PAGES);
        self.write_app(&mut out, &mut Constants::default(), operation)?;
        Some(out.finish())
    }

    fn robot(&self, operation: &Operation) -> Option<String> {
        let mut out = Source::new(&ON_PAGES);
        self.write_robot(&mut out, &mut Constants::default(), operation)?;
        Some(out.finish())
    }
}

impl<'p, 'm> Snippets<'p, 'm> {
    /// Of the Python package, with values from `samples`.
    #[must_use]
    pub fn new(package: &'p Package<'m>, samples: &'p Samples<'m>) -> Self {
        Self { package, samples }
    }

    fn write_app(
        &self,
        out: &mut Source,
        names: &mut Constants,
        operation: &Operation,
    ) -> Option<()> {
        if operation.kind() == Kind::Stream {
            return self.write_app_stream(out, names, operation);
        }
        let Call {
            method, request, ..
        } = self.package.call(operation)?;
        if operation.kind() == Kind::Command {
            let request = self.example(operation, Direction::Request)?;
            names.record(&request).write(out, "request = ", "");
            out.line(format!("answer = await client.{method}(request)"));
            out.line("print(answer)");
        } else {
            names.types.insert(request.ty.name.to_string());
            out.suite("async for report in client.reports()", |out| {
                out.suite(
                    &format!("if isinstance(report, {})", request.ty.name),
                    |out| {
                        out.line("print(report)");
                    },
                );
            });
        }
        Some(())
    }

    fn write_robot(
        &self,
        out: &mut Source,
        names: &mut Constants,
        operation: &Operation,
    ) -> Option<()> {
        if operation.kind() == Kind::Stream {
            return self.write_robot_stream(out, names, operation);
        }
        let call = self.package.call(operation)?;
        let name = call.method;
        if operation.kind() == Kind::Command {
            let answer = self.example(operation, Direction::Response)?;
            let [request, response] =
                [call.request, call.response].map(|it| it.ty.name.to_string());
            let request_parameter = format!("request: {request}");
            let parameters = ["self", "context: rt.Context", &request_parameter].map(Code::from);
            let open = format!("async def {name}(");
            method(out, &open, parameters.to_vec(), &response, |out| {
                out.line("print(context.address, \"asks:\", request)");
                names.record(&answer).write(out, "return ", "");
            });
            names.types.extend([request, response]);
        } else {
            let report = self.example(operation, Direction::Request)?;
            names.record(&report).write(out, "report = ", "");
            let head = format!("for acknowledgement in await reporter.{name}(report)");
            out.suite(&head, |out| out.line("print(acknowledgement)"));
        }
        Some(())
    }

    fn write_app_stream(
        &self,
        out: &mut Source,
        names: &mut Constants,
        stream: &Operation,
    ) -> Option<()> {
        let name = &stream.name;
        stub::is_there(self.package, stream).then(|| {
            if stream.sender == Side::Robot {
                let head = format!("async for item in streams.subscribe_{name}()");
                out.suite(&head, |out| out.line("print(item.id, item.content)"));
            } else {
                self.content(out, names, stream);
                out.line(format!("await streams.send_{name}(1, content)"));
            }
        })
    }

    fn write_robot_stream(
        &self,
        out: &mut Source,
        names: &mut Constants,
        stream: &Operation,
    ) -> Option<()> {
        let is_own = stub::is_there(self.package, stream) && stream.sender == Side::Robot;
        is_own.then(|| {
            self.content(out, names, stream);
            out.line(format!(
                "taken = await streamer.send_{}(1, content)",
                stream.name
            ));
            out.line("print(taken, \"data connections took it\")");
        })
    }

    /// `content = …`.
    fn content(&self, out: &mut Source, names: &mut Constants, stream: &Operation) {
        match self.example(stream, Direction::Request) {
            Some(content) => names.record(&content).write(out, "content = ", ""),
            None => out.line(format!("content = b{:?}", stub::BYTES)),
        }
    }

    fn example(&self, operation: &Operation, direction: Direction) -> Option<Record<'p>> {
        stub::example(self.package, self.samples, operation, direction)
    }
}

/// The test that type-checks and runs every sample.
pub fn file(context: &Context<'_>, values: &Samples<'_>, package: &str) -> String {
    let snippets = Snippets::new(&context.package, values);
    let (commands, reports) = (context.commands(), context.reports());
    let mut names = Constants::default();
    names
        .types
        .extend(["Client", "Reporter", "Robot"].map(str::to_owned));
    let mut body = Source::new(&PYTHON);
    body.suite("class RobotOfTheSamples(Robot)", |out| {
        out.line("\"\"\"Responds with the samples.\"\"\"");
        for command in &commands {
            out.blank();
            let _ = snippets.write_robot(out, &mut names, command.operation);
        }
    });
    let streams = [Side::Robot, Side::App].map(|side| stub::streams(&context.package, side));
    let [from_robot, from_app] = &streams;
    let has_streams = !from_robot.is_empty() || !from_app.is_empty();
    let of_streams = [
        ("Streams", has_streams),
        ("Streamer", !from_robot.is_empty()),
    ];
    let of_streams = of_streams.into_iter().filter(|(_, is_there)| *is_there);
    names
        .types
        .extend(of_streams.map(|(name, _)| name.to_owned()));
    let mut function = |word: &str, operation: &Operation, parameter: &str, is_robot: bool| {
        body.gap();
        let head = format!("async def {word}_{}({parameter}) -> None", operation.name);
        body.suite(&head, |out| {
            let _ = if is_robot {
                snippets.write_robot(out, &mut names, operation)
            } else {
                snippets.write_app(out, &mut names, operation)
            };
        });
    };
    for command in &commands {
        function("call", command.operation, "client: Client", false);
    }
    for report in &reports {
        function("take", report.operation, "client: Client", false);
        function("push", report.operation, "reporter: Reporter", true);
    }
    for stream in from_robot {
        function("subscribe", stream, "streams: Streams", false);
        function("send", stream, "streamer: Streamer", true);
    }
    for stream in from_app {
        function("send", stream, "streams: Streams", false);
    }
    body.gap();
    test(&mut body, &commands, &reports, &streams);

    let mut out = Source::new(&PYTHON);
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

fn test(
    out: &mut Source,
    commands: &[Call<'_>],
    reports: &[Call<'_>],
    streams: &[Vec<&Operation>; 2],
) {
    let has_streams = streams.iter().any(|streams| !streams.is_empty());
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
    let config = if has_streams {
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
    let line = |out: &mut Source, text: String| out.line(["                ", &text].concat());
    for command in commands {
        line(
            out,
            format!("await call_{}(client)", command.operation.name),
        );
    }
    if has_streams {
        line(out, "data_connection = client.data()".to_owned());
        line(out, "await data_connection.connected()".to_owned());
        line(out, "streams = Streams(data_connection)".to_owned());
    }
    line(out, "takers = [".to_owned());
    for report in reports {
        line(
            out,
            format!(
                "    asyncio.ensure_future(take_{}(client)),",
                report.operation.name
            ),
        );
    }
    let [from_robot, from_app] = streams;
    for stream in from_robot {
        line(
            out,
            format!(
                "    asyncio.ensure_future(subscribe_{}(streams)),",
                stream.name
            ),
        );
    }
    line(out, "]".to_owned());
    line(out, "await asyncio.sleep(0)".to_owned());
    line(out, "reporter = Reporter(server)".to_owned());
    for report in reports {
        line(
            out,
            format!("await push_{}(reporter)", report.operation.name),
        );
    }
    if !from_robot.is_empty() {
        line(out, "streamer = Streamer(server)".to_owned());
    }
    for stream in from_robot {
        line(out, format!("await send_{}(streamer)", stream.name));
    }
    for stream in from_app {
        line(out, format!("await send_{}(streams)", stream.name));
    }
    line(
        out,
        "for taker in takers:\n                    taker.cancel()".to_owned(),
    );
    out.line("        await server.shutdown(0)");
}
