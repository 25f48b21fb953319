//! How each operation is called and answered, as the pages of the documentation show it. The same text stands in
//! `samples.ts`, which is compiled with the package and run by a test of it.

use super::constants::Constants;
use super::context::{Context, imported, own, spelled};
use super::source::{self, Source, TYPESCRIPT, named};
use crate::emit::stub::samples as stub;
use crate::emit::stub::style::Style;
use crate::sample::Samples;
use crate::surface::expr::Record;
use crate::surface::language::{Role, TYPESCRIPT as LANGUAGE};
use crate::surface::name::free;
use crate::surface::package::Call;
use fc_spec::model::{Direction, Kind, Operation, Side};
use std::collections::BTreeSet;

/// TypeScript as it stands on a page.
static ON_PAGES: Style = Style {
    width: stub::PAGE_WIDTH,
    ..TYPESCRIPT
};

/// How the pages show the package.
pub const SHOWN: stub::Shown = stub::Shown {
    fence: "ts",
    file: "samples.ts",
    language: |_| &LANGUAGE,
    style: &ON_PAGES,
    snippets: |context, samples| Box::new(Snippets::new(context, samples)),
};

/// What makes the samples of a package.
pub struct Snippets<'p, 'm> {
    context: &'p Context<'m>,
    samples: &'p Samples<'m>,
}

/// The types of messages that samples name, and the constants in them.
struct Names<'p, 'm> {
    types: BTreeSet<String>,
    constants: Constants<'p, 'm>,
}

impl stub::Snippets for Snippets<'_, '_> {
    fn app(&self, operation: &Operation) -> Option<String> {
        let mut out = Source::new(self.context.style);
        self.write_app(&mut out, &mut self.names(), operation)?;
        Some(out.finish())
    }

    fn robot(&self, operation: &Operation) -> Option<String> {
        let mut out = Source::new(self.context.style);
        self.write_robot(&mut out, &mut self.names(), operation)?;
        Some(out.finish())
    }
}

impl<'p, 'm> Snippets<'p, 'm> {
    /// Of the TypeScript package, with values from `samples`.
    #[must_use]
    pub fn new(context: &'p Context<'m>, samples: &'p Samples<'m>) -> Self {
        Self { context, samples }
    }

    fn names(&self) -> Names<'p, 'm> {
        Names {
            types: BTreeSet::new(),
            constants: Constants::new(self.context, ""),
        }
    }

    fn write_app(
        &self,
        out: &mut Source,
        names: &mut Names<'_, '_>,
        operation: &Operation,
    ) -> Option<()> {
        if operation.kind() == Kind::Stream {
            return self.write_app_stream(out, names, operation);
        }
        let Call {
            method, request, ..
        } = self.context.package.call(operation)?;
        if operation.kind() == Kind::Command {
            let request = self.example(operation, Direction::Request)?;
            names.assign(out, "request", &request);
            out.line(format!("const answer = await client.{method}(request)"));
            out.line("console.log(answer)");
        } else {
            let name = &request.ty.name;
            out.block("for await (const report of client.reports())", |out| {
                out.line(format!(
                    "if (report.case === '{name}') console.log(report.value)"
                ));
            });
        }
        Some(())
    }

    fn write_robot(
        &self,
        out: &mut Source,
        names: &mut Names<'_, '_>,
        operation: &Operation,
    ) -> Option<()> {
        if operation.kind() == Kind::Stream {
            return self.write_robot_stream(out, names, operation);
        }
        let call = self.context.package.call(operation)?;
        let name = call.method;
        if operation.kind() == Kind::Command {
            let answer = self.example(operation, Direction::Response)?;
            let [request, response] =
                [call.request, call.response].map(|it| it.ty.name.to_string());
            let [context, soon] = ["Context", "Answer"].map(|it| own(self.context, it));
            let parameters = [format!("request: {request}"), format!("context: {context}")];
            let close = format!("): {soon}<{response}> {{");
            out.list(&format!("{name}("), &parameters, &close);
            out.enclose("", "}", |out| {
                out.line("console.log(context.peer, 'asks:', request)");
                names.constants.record(&answer).write(out, "return ", "");
            });
            names.types.extend([request, response]);
        } else {
            let report = self.example(operation, Direction::Request)?;
            names.assign(out, "report", &report);
            let head = format!("for (const acknowledgement of await reporter.{name}(report))");
            out.block(head, |out| out.line("console.log(acknowledgement)"));
        }
        Some(())
    }

    fn write_app_stream(
        &self,
        out: &mut Source,
        names: &mut Names<'_, '_>,
        stream: &Operation,
    ) -> Option<()> {
        let name = self.stream(stream)?;
        if stream.sender == Side::Robot {
            let head = format!("for await (const item of streams.subscribe{name}())");
            out.block(head, |out| out.line("console.log(item.id, item.content)"));
        } else {
            self.content(out, names, stream);
            out.line(format!("await streams.send{name}(1, content)"));
        }
        Some(())
    }

    fn write_robot_stream(
        &self,
        out: &mut Source,
        names: &mut Names<'_, '_>,
        stream: &Operation,
    ) -> Option<()> {
        let name = self
            .stream(stream)
            .filter(|_| stream.sender == Side::Robot)?;
        self.content(out, names, stream);
        out.line(format!(
            "const taken = await streamer.send{name}(1, content)"
        ));
        out.line("console.log(`${taken} data connections took it`)");
        Some(())
    }

    /// What the package calls a stream; `None` without a code.
    fn stream(&self, stream: &Operation) -> Option<&'p str> {
        let mut streams = self.context.package.streams.iter();
        let found = streams.find(|known| known.of.name == stream.name)?;
        Some(&found.name)
    }

    /// `const content = …`.
    fn content(&self, out: &mut Source, names: &mut Names<'_, '_>, stream: &Operation) {
        match self.example(stream, Direction::Request) {
            Some(content) => names.assign(out, "content", &content),
            None => out.line(format!(
                "const content = new TextEncoder().encode('{}')",
                stub::BYTES
            )),
        }
    }

    fn example(&self, operation: &Operation, direction: Direction) -> Option<Record<'p>> {
        stub::example(&self.context.package, self.samples, operation, direction)
    }
}

impl Names<'_, '_> {
    /// `const name: Type = { … }`.
    fn assign(&mut self, out: &mut Source, name: &str, record: &Record<'_>) {
        let ty = &record.item.ty.name;
        let value = self.constants.record(record);
        value.write(out, &format!("const {name}: {ty} = "), "");
        self.types.insert(ty.to_string());
    }
}

/// `samples.ts`: all samples, and a function that runs them.
pub fn file(context: &Context<'_>, samples: &Samples<'_>) -> String {
    let snippets = Snippets::new(context, samples);
    let (commands, reports) = (context.commands(), context.reports());
    let taken = |name: &str| context.package.has_type(name);
    let robot = free(&["SampleRobot", "RobotOfTheSamples"], taken);
    let mut names = snippets.names();
    let mut body = Source::new(&TYPESCRIPT);
    let head = format!("class {robot} implements Robot");
    if commands.is_empty() {
        body.line([&head, " {}"].concat());
    } else {
        body.block(head, |out| {
            for command in &commands {
                out.blank();
                let _ = snippets.write_robot(out, &mut names, command.operation);
            }
        });
    }
    let streams = [Side::Robot, Side::App].map(|side| stub::streams(&context.package, side));
    let mut function = |word: &str, operation: &Operation, parameter: &str, is_robot: bool| {
        body.blank();
        let name = function_name(word, operation);
        let head = format!("async function {name}({parameter}): Promise<void>");
        body.block(head, |out| {
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
    let [from_robot, from_app] = &streams;
    for stream in from_robot {
        function("subscribe", stream, "streams: Streams", false);
        function("send", stream, "streamer: Streamer", true);
    }
    for stream in from_app {
        function("send", stream, "streams: Streams", false);
    }
    body.blank();
    run(&mut body, context, &robot, [&commands, &reports], &streams);

    let mut out = source::head([
        "文档中的示例代码：随软件包编译，由测试运行。",
        "The samples of the documentation: compiled with the package, and run by a test of it.",
    ]);
    let mut runtime = vec!["Platform", "ServerPlatform"];
    if !commands.is_empty() {
        runtime.extend(["Answer", "Context"]);
    }
    let runtime = runtime.iter().map(|it| imported(context, it));
    named(&mut out, "import type", runtime, "../src/runtime.ts");
    let mut client = vec!["Client"];
    client.extend((!context.package.streams.is_empty()).then_some("Streams"));
    named(&mut out, "import", client, "./client.ts");
    let Names { types, constants } = names;
    let enums = constants.enums;
    let types = types.difference(&enums);
    named(&mut out, "import type", types, "./messages.ts");
    named(&mut out, "import", &enums, "./messages.ts");
    named(&mut out, "import type", ["Robot"], "./robot.ts");
    let mut stub = vec!["serve"];
    stub.extend((!reports.is_empty()).then_some("Reporter"));
    stub.extend((!from_robot.is_empty()).then_some("Streamer"));
    named(&mut out, "import", stub, "./robot.ts");
    out.blank();
    out.append(&body);
    out.finish()
}

/// What the function around a sample is called.
fn function_name(word: &str, operation: &Operation) -> String {
    let name = format!("{word}_{}", operation.name);
    spelled(Role::Function, &name)
}

/// The function that runs them.
fn run(
    out: &mut Source,
    context: &Context<'_>,
    robot: &str,
    [commands, reports]: [&[Call<'_>]; 2],
    [from_robot, from_app]: &[Vec<&Operation>; 2],
) {
    let has_streams = !from_robot.is_empty() || !from_app.is_empty();
    let data = if has_streams {
        ", dataPort: server.dataPort"
    } else {
        ""
    };
    let [app, server] = ["Platform", "ServerPlatform"].map(|it| own(context, it));
    out.line(
        "\
/**
 * 一个 app 和一个机器人在本机上运行全部示例。
 * Runs all samples, with an app and a robot on this machine.
 */",
    );
    let head = format!("export async function run(app: {app}, robot: {server}): Promise<void>");
    out.block(head, |out| {
        out.line(format!(
            "\
const host = '127.0.0.1'
const server = await serve(robot, new {robot}(), {{ address: host, commandPort: 0, dataPort: 0 }})
const client = await Client.connect(app, {{ host, commandPort: server.commandPort{data} }})"
        ));
        for command in commands {
            let name = function_name("call", command.operation);
            out.line(format!("await {name}(client)"));
        }
        if !reports.is_empty() {
            out.line("const reporter = new Reporter(server)");
            let takes: Vec<String> = reports
                .iter()
                .map(|report| format!("{}(client)", function_name("take", report.operation)))
                .collect();
            out.list("const taken = Promise.all([", &takes, "])");
            for report in reports {
                let name = function_name("push", report.operation);
                out.line(format!("await {name}(reporter)"));
            }
        }
        if has_streams {
            out.line("const data = client.data()\nawait data.connected()\nconst streams = new Streams(data)");
        }
        if !from_robot.is_empty() {
            out.line("const streamer = new Streamer(server)");
            let subscribes = from_robot.iter();
            let subscribes: Vec<String> = subscribes
                .map(|stream| format!("{}(streams)", function_name("subscribe", stream)))
                .collect();
            out.list("const subscribed = Promise.all([", &subscribes, "])");
        }
        for stream in from_robot {
            out.line(format!("await {}(streamer)", function_name("send", stream)));
        }
        for stream in from_app {
            out.line(format!("await {}(streams)", function_name("send", stream)));
        }
        out.line("client.close()");
        if !from_robot.is_empty() {
            out.line("await subscribed");
        }
        if !reports.is_empty() {
            out.line("await taken");
        }
        out.line("await server.shutdown(1000)");
    });
}
