//! How each operation is called and answered, as the pages of the documentation show it. The same text stands in a test
//! of the package, so no sample can rot.

use super::literal::Constants;
use super::source::{Code, PYTHON, Python, method};
use crate::emit::stub::context::Context;
use crate::emit::stub::source::Source;
use crate::sample::{Profile, Samples};
use crate::surface::expr::{Expressions, Record};
use crate::surface::package::{Call, Package};
use fc_spec::model::{Direction, Kind, Operation};

/// What makes the samples of a package.
pub struct Snippets<'p, 'm> {
    package: &'p Package<'m>,
    samples: &'p Samples<'m>,
}

impl<'p, 'm> Snippets<'p, 'm> {
    /// Of the Python package, with values from `samples`.
    #[must_use]
    pub fn new(package: &'p Package<'m>, samples: &'p Samples<'m>) -> Self {
        Self { package, samples }
    }

    /// What an app does: calls a command, or takes a report. `None` without a code.
    #[must_use]
    pub fn app(&self, operation: &Operation) -> Option<String> {
        let mut out = Source::new(&PYTHON);
        self.write_app(&mut out, &mut Constants::default(), operation)?;
        Some(out.finish())
    }

    /// What a robot does: answers a command, or pushes a report. `None` without a code.
    #[must_use]
    pub fn robot(&self, operation: &Operation) -> Option<String> {
        let mut out = Source::new(&PYTHON);
        self.write_robot(&mut out, &mut Constants::default(), operation)?;
        Some(out.finish())
    }

    fn write_app(
        &self,
        out: &mut Source,
        names: &mut Constants,
        operation: &Operation,
    ) -> Option<()> {
        let Call {
            method, request, ..
        } = self.package.call(operation)?;
        if operation.kind() == Kind::Command {
            let request = self.message(operation, Direction::Request)?;
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
        let call = self.package.call(operation)?;
        let name = call.method;
        if operation.kind() == Kind::Command {
            let answer = self.message(operation, Direction::Response)?;
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
            let report = self.message(operation, Direction::Request)?;
            names.record(&report).write(out, "report = ", "");
            let head = format!("for acknowledgement in await reporter.{name}(report)");
            out.suite(&head, |out| out.line("print(acknowledgement)"));
        }
        Some(())
    }

    /// The example body of one side; `None` of a stream.
    fn message(&self, operation: &Operation, direction: Direction) -> Option<Record<'_>> {
        let body = operation.messages()?.body(direction);
        let value = self.samples.body(operation, direction, Profile::Example);
        let expressions = Expressions::new(self.package, self.samples);
        Some(expressions.record(&body.ty, &value))
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
        out.line("\"\"\"Answers with the samples.\"\"\"");
        for command in &commands {
            out.blank();
            let _ = snippets.write_robot(out, &mut names, command.operation);
        }
    });
    let mut function = |word: &str, call: &Call<'_>, parameter: &str, is_robot: bool| {
        body.gap();
        let head = format!(
            "async def {word}_{}({parameter}) -> None",
            call.operation.name
        );
        body.suite(&head, |out| {
            let _ = if is_robot {
                snippets.write_robot(out, &mut names, call.operation)
            } else {
                snippets.write_app(out, &mut names, call.operation)
            };
        });
    };
    for command in &commands {
        function("call", command, "client: Client", false);
    }
    for report in &reports {
        function("take", report, "client: Client", false);
        function("push", report, "reporter: Reporter", true);
    }
    body.gap();
    test(&mut body, &commands, &reports);

    let mut out = Source::new(&PYTHON);
    out.line("\"\"\"The samples of the documentation: every command is called, every report pushed and taken.\"\"\"");
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

fn test(out: &mut Source, commands: &[Call<'_>], reports: &[Call<'_>]) {
    out.line(
        "\
class Samples(unittest.IsolatedAsyncioTestCase):
    async def test_every_sample_runs(self) -> None:
        # A robot still answers what is withdrawn.
        warnings.simplefilter(\"ignore\", DeprecationWarning)
        config = rt.ServerConfig(address=\"127.0.0.1\", command_port=0, data_port=0, handler_timeout=60.0)
        server = rt.Server(RobotOfTheSamples(), config)
        await server.bind()
        host, port = server.command_address
        with contextlib.redirect_stdout(io.StringIO()):
            async with Client.connect(rt.ClientConfig(host=host, command_port=port, call_timeout=60.0)) as client:",
    );
    let line = |out: &mut Source, text: String| out.line(["                ", &text].concat());
    for command in commands {
        line(
            out,
            format!("await call_{}(client)", command.operation.name),
        );
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
    line(out, "]".to_owned());
    line(out, "await asyncio.sleep(0)".to_owned());
    line(out, "reporter = Reporter(server)".to_owned());
    for report in reports {
        line(
            out,
            format!("await push_{}(reporter)", report.operation.name),
        );
    }
    line(
        out,
        "for taker in takers:\n                    taker.cancel()".to_owned(),
    );
    out.line("        await server.shutdown(0)");
}
