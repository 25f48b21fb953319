//! Samples that call and answer each operation, for the documentation's pages.
//!
//! A test of the package contains the same text, so no sample can become invalid.

use super::assignments::{Assignments, assign};
use super::layout::{CPP, Includes, literal};
use super::types::namespace;
use crate::package::context::Context;
use crate::package::expr::Record;
use crate::package::items::Spelled;
use crate::package::language::CPP as LANGUAGE;
use crate::package::samples::{BYTES, PAGE_WIDTH, Sample, SampleRun, SampleStep, SampleTab, Verb};
use crate::package::source::Source;
use crate::package::style::Style;
use fc_spec::model::Operation;

/// The style of C++ on a page.
static ON_PAGES: Style = Style {
    width: PAGE_WIDTH,
    ..CPP
};

/// The file of the package that contains all samples.
pub const FILE: &str = "tests/samples.cpp";

/// The C++ samples on the pages.
pub const TAB: SampleTab = SampleTab {
    fence: "cpp",
    file: FILE,
    language: &LANGUAGE,
    style: &ON_PAGES,
    write: |out, context, sample| Writer::new(context).write(out, sample, &Meanwhile::default()),
};

/// The time that an app waits for a message that the robot sends unasked.
const PATIENCE: &str = "std::chrono::minutes(1)";

/// Writes the samples of a package.
struct Writer<'p, 'm> {
    context: &'p Context<'m>,
    /// The qualifier before each name of the package.
    space: String,
}

/// Additional statements of the test inside a sample. The pages do not show them.
#[derive(Default)]
struct Meanwhile<'t> {
    /// Runs once the app receives.
    receives: &'t str,
    /// Runs once the app has the expected message.
    received: &'t str,
}

impl<'p, 'm> Writer<'p, 'm> {
    fn new(context: &'p Context<'m>) -> Self {
        let space = format!("{}::", namespace(context));
        Self { context, space }
    }

    fn write(&self, out: &mut Source, sample: &Sample<'_, '_>, meanwhile: &Meanwhile<'_>) {
        let space = &self.space;
        match sample {
            Sample::Call(call, request) => {
                let filled = self.filled("request", &["client", "answer"], request);
                let given = if filled.is_empty() {
                    "{}"
                } else {
                    self.declare(out, "request", request, &filled);
                    "request"
                };
                let call = format!("client.{}({given})", call.method);
                assign(out, "const auto answer", &call);
                either(out, "answer", "*answer << '\\n'", "", "answer.error()");
            }
            Sample::Take(call) => {
                let name = &call.request.ty.name;
                out.line(format!("const {space}Reports reports = client.reports();"));
                out.line(meanwhile.receives);
                let head = format!("while (const auto report = reports.next({PATIENCE}))");
                out.block(head, |out| {
                    let open = "if (const auto* known =";
                    let get = format!("std::get_if<{space}{name}>(&*report)) {{");
                    out.line_or([open, " ", &get], |out| {
                        out.line(format!("{open}\n        {get}"));
                    });
                    out.enclose("", "}", |out| {
                        out.line("std::cout << *known << '\\n';");
                        out.line(meanwhile.received);
                    });
                });
            }
            Sample::Answer(call, answer) => {
                let [request, response] =
                    [call.request, call.response].map(|it| [space, &*it.ty.name].concat());
                let parameters = [
                    "const fc_runtime::Context& context".to_owned(),
                    format!("const {request}& request"),
                ];
                let open = format!("fc_runtime::Replied<{response}> {}(", call.method);
                out.parameters(&open, &parameters, ") override {");
                out.enclose("", "}", |out| {
                    out.line("std::cout << context.connection << \" asks: \" << request << '\\n';");
                    let filled = self.filled("response", &["context", "request"], answer);
                    if filled.is_empty() {
                        out.line(format!("return {response}{{}};"));
                    } else {
                        self.declare(out, "response", answer, &filled);
                        out.line("return response;");
                    }
                });
            }
            Sample::Push(call, report) => {
                let filled = self.filled("report", &["reporter", "pushed"], report);
                self.declare(out, "report", report, &filled);
                let push = format!("reporter.{}(report)", call.method);
                assign(out, "const auto pushed", &push);
                out.template("sample_push", &[]);
            }
            Sample::Subscribe(stream) => self.subscribe(out, stream, meanwhile),
            Sample::Send(stream, value) => {
                let content = self.content(out, value.as_ref());
                let send = format!("streams.send_{}(1, {content})", stream.of.name);
                assign(out, "const auto sent", &send);
                out.line("if (!sent) std::cerr << to_string(sent.error()) << '\\n';");
            }
            Sample::Stream(stream, value) => {
                let content = self.content(out, value.as_ref());
                let send = format!(
                    "streamer.send_{}(std::nullopt, 1, {content})",
                    stream.of.name
                );
                assign(out, "const auto taken", &send);
                let taken = "*taken << \" data connections took it\\n\"";
                either(out, "taken", taken, "", "to_string(taken.error())");
            }
        }
    }

    fn subscribe(
        &self,
        out: &mut Source,
        stream: &Spelled<'_, Operation>,
        meanwhile: &Meanwhile<'_>,
    ) {
        let subscribe = format!("streams.subscribe_{}()", stream.of.name);
        assign(out, "const auto frames", &subscribe);
        out.line(meanwhile.receives);
        let shown = match self.context.content(stream) {
            Some(_) => "frame->content << '\\n'",
            None => "frame->data.size() << \" bytes\\n\"",
        };
        let head = format!("while (const auto frame = frames.next({PATIENCE}))");
        out.block(head, |out| {
            out.line(format!("std::cout << frame->id << \": \" << {shown};"));
            out.line(meanwhile.received);
        });
    }

    /// Assigns the content of a stream, unless it is bytes, and returns the expression for it.
    fn content(&self, out: &mut Source, value: Option<&Record<'_>>) -> String {
        let Some(value) = value else {
            return literal(BYTES);
        };
        let others = ["frames", "sent", "streamer", "streams", "taken"];
        let filled = self.filled("content", &others, value);
        self.declare(out, "content", value, &filled);
        "content".to_owned()
    }

    /// Writes `Type name;`, and the statements that fill it.
    fn declare(
        &self,
        out: &mut Source,
        name: &str,
        record: &Record<'_>,
        filled: &Assignments<'_, '_>,
    ) {
        out.line(format!("{}{} {name};", self.space, record.item.ty.name));
        filled.write(out);
    }

    fn filled(&self, name: &str, others: &[&str], record: &Record<'_>) -> Assignments<'_, 'm> {
        Assignments::new(self.context, &self.space, name, others, record)
    }
}

/// Prints the value of a result and the line `more`, or its error.
fn either(out: &mut Source, result: &str, has: &str, more: &str, error: &str) {
    out.enclose(&format!("if ({result}) {{"), "} else {", |out| {
        out.line(format!("std::cout << {has};"));
        out.line(more);
    });
    out.enclose("", "}", |out| {
        out.line(format!("std::cerr << {error} << '\\n';"));
    });
}

/// Generates the test that compiles and runs every sample.
#[must_use]
pub fn samples_file(context: &Context<'_>) -> String {
    let writer = Writer::new(context);
    let run = &SampleRun::build(context);
    let space = &namespace(context);
    let mut out = context.source();
    out.line("// The samples of the documentation. They call every command and receive every report and stream.");
    let standard = [
        "chrono", "cstdint", "iostream", "memory", "optional", "string", "variant",
    ];
    let mut includes = Includes::new(context, &standard, &["client"], &[]);
    includes.own(format!("{space}/robot.hpp"));
    includes.lines(&mut out);
    out.blank();
    out.line("// Laid out as on the pages.\n// clang-format off");
    if run
        .that(Verb::Call)
        .any(|it| it.operation.deprecated.is_some())
    {
        out.blank();
        out.line("// A robot still handles deprecated commands.");
        out.line("#pragma GCC diagnostic ignored \"-Wdeprecated-declarations\"");
    }
    out.blank();
    out.line("namespace {");
    out.blank();
    out.line(format!("class SampleRobot : public {space}::Robot {{"));
    out.line(" public:");
    out.enclose("", "};", |out| {
        for answer in run.answers() {
            out.blank();
            writer.write(out, &answer, &Meanwhile::default());
        }
    });
    let mut function = |head: String, step: SampleStep<'_>, meanwhile: &Meanwhile<'_>| {
        out.blank();
        out.block(format!("bool {head}"), |out| {
            if let Some(sample) = run.sample(step) {
                writer.write(out, &sample, meanwhile);
            }
            let end = match step.verb {
                Verb::Call => "answer.has_value()",
                Verb::Push => "pushed && pushed->size() == 1",
                Verb::Stream => "taken && *taken == 1",
                Verb::Take | Verb::Subscribe => "false",
                Verb::Send => "sent.has_value()",
            };
            out.line(format!("return {end};"));
        });
    };
    let client = format!("const {space}::Client& client");
    let reporter = format!("const {space}::Reporter& reporter");
    let streamer = format!("const {space}::Streamer& streamer");
    let streams = format!("const {space}::Streams& streams");
    for step in run.that(Verb::Call) {
        function(
            format!("{}({client})", step.name()),
            step,
            &Meanwhile::default(),
        );
    }
    for (take, give, [receives, sends, sender]) in [
        (Verb::Take, Verb::Push, [&*client, &*reporter, "reporter"]),
        (
            Verb::Subscribe,
            Verb::Stream,
            [&*streams, &*streamer, "streamer"],
        ),
    ] {
        for (take, give) in run.that(take).zip(run.that(give)) {
            let name = give.name();
            function(format!("{name}({sends})"), give, &Meanwhile::default());
            let meanwhile = Meanwhile {
                receives: &format!("if (!{name}({sender})) return false;"),
                received: "return true;",
            };
            let head = format!("take_{}({receives}, {sends})", take.operation.name);
            function(head, take, &meanwhile);
        }
    }
    for step in run.that(Verb::Send) {
        function(
            format!("{}({streams})", step.name()),
            step,
            &Meanwhile::default(),
        );
    }
    out.blank();
    out.line("}  // namespace");
    out.blank();
    main(&mut out, space, run);
    out.finish()
}

/// Writes the function that runs all samples.
fn main(out: &mut Source, space: &str, run: &SampleRun<'_, '_>) {
    let check = |out: &mut Source, call: String| {
        let (name, _) = call.split_once('(').unwrap_or((&call, ""));
        let (asks, fails) = (
            format!("if (!{call})"),
            format!("return failed({});", literal(name)),
        );
        out.line_or([&asks, " ", &fails], |out| {
            out.block(&asks, |out| out.line(&fails));
        });
    };
    out.template("sample_failed", &[]);
    out.blank();
    out.block("int main()", |out| {
        out.template("sample_main", &[("space", space), ("patience", PATIENCE)]);
        for step in run.that(Verb::Call) {
            check(out, format!("{}(*client)", step.name()));
        }
        if run.has(Verb::Push) {
            out.line(format!("const {space}::Reporter reporter(*server);"));
        }
        for step in run.that(Verb::Take) {
            check(out, format!("{}(*client, reporter)", step.name()));
        }
        let mut streams = run.that(Verb::Subscribe).chain(run.that(Verb::Send));
        if let Some(first) = streams.next() {
            let code = &first.operation.code.spelling;
            out.line(format!("const {space}::Streams streams(client->data());"));
            check(out, "streams.data().connected()".to_owned());
            out.line("// The robot knows a data connection after its first frame.");
            out.line("static_cast<void>(server->next_stream(std::chrono::milliseconds(0)));");
            check(out, format!("streams.data().send({code}, 0, \"\")"));
            check(out, format!("server->next_stream({PATIENCE})"));
        }
        if run.has(Verb::Stream) {
            out.line(format!("const {space}::Streamer streamer(*server);"));
        }
        for step in run.that(Verb::Subscribe) {
            let name = &step.operation.name;
            check(out, format!("take_{name}(streams, streamer)"));
        }
        for step in run.that(Verb::Send) {
            check(out, format!("{}(streams)", step.name()));
        }
        out.line("return 0;");
    });
}
