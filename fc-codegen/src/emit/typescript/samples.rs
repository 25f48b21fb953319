//! Samples that call and answer each operation, for the documentation's pages.
//!
//! `samples.ts` contains the same text. It is compiled with the package, and a test runs it.

use super::constants::Constants;
use super::context::{Context, imported, own, spelled};
use super::source::{self, Source, TYPESCRIPT, named};
use crate::package::docs::Docs;
use crate::package::expr::Record;
use crate::package::language::{Role, TYPESCRIPT as LANGUAGE};
use crate::package::name::free;
use crate::package::samples::{BYTES, PAGE_WIDTH, Sample, SampleRun, SampleStep, SampleTab, Verb};
use crate::package::style::Style;
use std::collections::BTreeSet;

/// The style of TypeScript on a page.
static ON_PAGES: Style = Style {
    width: PAGE_WIDTH,
    ..TYPESCRIPT
};

/// The TypeScript samples on the pages.
pub const TAB: SampleTab = SampleTab {
    fence: "ts",
    file: "samples.ts",
    language: &LANGUAGE,
    style: &ON_PAGES,
    write: |out, context, sample| write(out, context, &mut Names::new(context), sample),
};

/// The message types that samples name, and the constants in them.
struct Names<'p, 'm> {
    types: BTreeSet<String>,
    constants: Constants<'p, 'm>,
}

fn write(
    out: &mut Source,
    context: &Context<'_>,
    names: &mut Names<'_, '_>,
    sample: &Sample<'_, '_>,
) {
    match sample {
        Sample::Call(call, request) => {
            names.assign(out, "request", request);
            let method = call.method;
            out.line(format!("const answer = await client.{method}(request)"));
            out.line("console.log(answer)");
        }
        Sample::Take(call) => {
            let name = &call.request.ty.name;
            out.block("for await (const report of client.reports())", |out| {
                out.line(format!(
                    "if (report.case === '{name}') console.log(report.value)"
                ));
            });
        }
        Sample::Answer(call, answer) => {
            let [request, response] =
                [call.request, call.response].map(|it| it.ty.name.to_string());
            let [ty, soon] = ["Context", "Answer"].map(|it| own(context, it));
            let parameters = [format!("request: {request}"), format!("context: {ty}")];
            let close = format!("): {soon}<{response}> {{");
            out.list(&format!("{}(", call.method), &parameters, &close);
            out.enclose("", "}", |out| {
                out.line("console.log(context.peer, 'asks:', request)");
                names.constants.record(answer).write(out, "return ", "");
            });
            names.types.extend([request, response]);
        }
        Sample::Push(call, report) => {
            names.assign(out, "report", report);
            let push = format!("await reporter.{}(report)", call.method);
            out.block(format!("for (const acknowledgement of {push})"), |out| {
                out.line("console.log(acknowledgement)");
            });
        }
        Sample::Subscribe(stream) => {
            let name = &stream.name;
            let head = format!("for await (const item of streams.subscribe{name}())");
            out.block(head, |out| out.line("console.log(item.id, item.content)"));
        }
        Sample::Send(stream, value) => {
            names.assign_content(out, value.as_ref());
            out.line(format!("await streams.send{}(1, content)", stream.name));
        }
        Sample::Stream(stream, value) => {
            names.assign_content(out, value.as_ref());
            let name = &stream.name;
            out.line(format!(
                "const taken = await streamer.send{name}(1, content)"
            ));
            out.line("console.log(`${taken} data connections took it`)");
        }
    }
}

impl<'p, 'm> Names<'p, 'm> {
    fn new(context: &'p Context<'m>) -> Self {
        Self {
            types: BTreeSet::new(),
            constants: Constants::new(context, ""),
        }
    }

    /// Writes `const content = …`.
    fn assign_content(&mut self, out: &mut Source, value: Option<&Record<'_>>) {
        match value {
            Some(value) => self.assign(out, "content", value),
            None => out.line(format!(
                "const content = new TextEncoder().encode('{BYTES}')"
            )),
        }
    }

    /// Writes `const name: Type = { … }`.
    fn assign(&mut self, out: &mut Source, name: &str, record: &Record<'_>) {
        let ty = &record.item.ty.name;
        let value = self.constants.record(record);
        value.write(out, &format!("const {name}: {ty} = "), "");
        self.types.insert(ty.to_string());
    }
}

/// Generates `samples.ts`: all samples, and a function that runs them.
pub fn file(context: &Context<'_>) -> String {
    let run = &SampleRun::build(context);
    let taken = |name: &str| context.package.has_type(name);
    let robot = free(&["SampleRobot", "RobotOfTheSamples"], taken);
    let mut names = Names::new(context);
    let mut body = context.source();
    let head = format!("class {robot} implements Robot");
    if run.has(Verb::Call) {
        body.block(head, |out| {
            for answer in run.answers() {
                out.blank();
                write(out, context, &mut names, &answer);
            }
        });
    } else {
        body.line([&head, " {}"].concat());
    }
    for (step, sample) in run.samples() {
        let (function, [name, ty]) = (function_name(step), step.parameter());
        let head = format!("async function {function}({name}: {ty}): Promise<void>");
        body.blank();
        body.block(head, |out| write(out, context, &mut names, &sample));
    }
    body.blank();
    run_all(&mut body, context, &robot, run);

    let mut out = source::head(
        context,
        [
            "文档中的示例代码：随软件包编译，由测试运行。",
            "The samples of the documentation: compiled with the package, and run by a test of it.",
        ],
    );
    let mut runtime = vec!["Platform", "ServerPlatform"];
    if run.has(Verb::Call) {
        runtime.extend(["Answer", "Context"]);
    }
    let runtime = runtime.iter().map(|it| imported(context, it));
    named(&mut out, "import type", runtime, "../src/runtime.ts");
    let mut client = vec!["Client"];
    client.extend(run.has_streams().then_some("Streams"));
    named(&mut out, "import", client, "./client.ts");
    let Names { types, constants } = names;
    let types = types.difference(&constants.names);
    named(&mut out, "import type", types, "./messages.ts");
    named(&mut out, "import", &constants.names, "./messages.ts");
    named(&mut out, "import type", ["Robot"], "./robot.ts");
    let mut stub = vec!["serve"];
    stub.extend(run.has(Verb::Push).then_some("Reporter"));
    stub.extend(run.has(Verb::Stream).then_some("Streamer"));
    named(&mut out, "import", stub, "./robot.ts");
    out.blank();
    out.append(&body);
    out.finish()
}

fn function_name(step: SampleStep<'_>) -> String {
    spelled(Role::Function, &step.name())
}

fn call(step: SampleStep<'_>) -> String {
    format!("{}({})", function_name(step), step.parameter()[0])
}

/// Writes the function that runs all samples.
fn run_all(out: &mut Source, context: &Context<'_>, robot: &str, run: &SampleRun<'_, '_>) {
    let data = if run.has_streams() {
        ", dataPort: server.dataPort"
    } else {
        ""
    };
    let wait = |out: &mut Source, verb: Verb| {
        for step in run.that(verb) {
            out.line(format!("await {}", call(step)));
        }
    };
    let all = |out: &mut Source, name: &str, verb: Verb| {
        let calls: Vec<String> = run.that(verb).map(call).collect();
        out.list(&format!("const {name} = Promise.all(["), &calls, "])");
    };
    let [app, server] = ["Platform", "ServerPlatform"].map(|it| own(context, it));
    out.docs(&Docs::said([
        "一个 app 和一个机器人在本机上运行全部示例。",
        "Runs all samples, with an app and a robot on this machine.",
    ]));
    let head = format!("export async function run(app: {app}, robot: {server}): Promise<void>");
    out.block(head, |out| {
        out.line(format!(
            "\
const host = '127.0.0.1'
const server = await serve(robot, new {robot}(), {{ address: host, commandPort: 0, dataPort: 0 }})
const client = await Client.connect(app, {{ host, commandPort: server.commandPort{data} }})"
        ));
        wait(out, Verb::Call);
        if run.has(Verb::Take) {
            out.line("const reporter = new Reporter(server)");
            all(out, "taken", Verb::Take);
            wait(out, Verb::Push);
        }
        if run.has_streams() {
            out.line("const data = client.data()\nawait data.connected()\nconst streams = new Streams(data)");
        }
        if run.has(Verb::Subscribe) {
            out.line("const streamer = new Streamer(server)");
            all(out, "subscribed", Verb::Subscribe);
        }
        wait(out, Verb::Stream);
        wait(out, Verb::Send);
        out.line("client.close()");
        if run.has(Verb::Subscribe) {
            out.line("await subscribed");
        }
        if run.has(Verb::Take) {
            out.line("await taken");
        }
        out.line("await server.shutdown(1000)");
    });
}
