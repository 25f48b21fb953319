//! How each operation is called and answered, as the pages of the documentation show it. The same text stands in a test
//! of the package, so no sample can rot.

use super::assignments::{Assignments, assign};
use super::layout::{CPP, Includes, literal};
use super::types::namespace;
use crate::emit::stub::context::Context;
use crate::emit::stub::samples as stub;
use crate::emit::stub::source::Source;
use crate::emit::stub::style::Style;
use crate::sample::Samples;
use crate::surface::expr::Record;
use crate::surface::language::CPP as LANGUAGE;
use crate::surface::package::Call;
use fc_spec::model::{Direction, Kind, Operation, Side};

/// C++ as it stands on a page.
static ON_PAGES: Style = Style {
    width: stub::PAGE_WIDTH,
    ..CPP
};

/// The file of the package that has all samples.
pub const FILE: &str = "tests/samples.cpp";

/// How the pages show the package.
pub const SHOWN: stub::Shown = stub::Shown {
    fence: "cpp",
    file: FILE,
    language: |_| &LANGUAGE,
    style: &ON_PAGES,
    snippets: |context, samples| Box::new(Snippets::new(context, samples)),
};

/// How long an app waits for what the robot sends of its own accord.
const PATIENCE: &str = "std::chrono::minutes(1)";

/// What makes the samples of a package.
pub struct Snippets<'p, 'm> {
    context: &'p Context<'m>,
    samples: &'p Samples<'m>,
    /// What stands before each name of the package.
    space: String,
}

/// What the test does in the middle of a sample, which the pages do not show.
#[derive(Default)]
struct Meanwhile<'t> {
    /// Once the app receives.
    receives: &'t str,
    /// Once it has what it waits for.
    received: &'t str,
}

impl stub::Snippets for Snippets<'_, '_> {
    fn app(&self, operation: &Operation) -> Option<String> {
        let mut out = Source::new(self.context.style);
        self.write_app(&mut out, operation, &Meanwhile::default())?;
        Some(out.finish())
    }

    fn robot(&self, operation: &Operation) -> Option<String> {
        let mut out = Source::new(self.context.style);
        self.write_robot(&mut out, operation)?;
        Some(out.finish())
    }
}

impl<'p, 'm> Snippets<'p, 'm> {
    /// Of the C++ package, with values from `samples`.
    #[must_use]
    pub fn new(context: &'p Context<'m>, samples: &'p Samples<'m>) -> Self {
        let space = format!("{}::", namespace(context));
        Self {
            context,
            samples,
            space,
        }
    }

    fn write_app(
        &self,
        out: &mut Source,
        operation: &Operation,
        meanwhile: &Meanwhile<'_>,
    ) -> Option<()> {
        if operation.kind() == Kind::Stream {
            return self.write_app_stream(out, operation, meanwhile);
        }
        let Call {
            method, request, ..
        } = self.context.package.call(operation)?;
        let space = &self.space;
        if operation.kind() == Kind::Command {
            let example = self.example(operation, Direction::Request)?;
            let filled = self.filled("request", &["client", "answer"], &example);
            let given = if filled.is_empty() {
                "{}"
            } else {
                self.declare(out, "request", &example, &filled);
                "request"
            };
            let call = format!("client.{method}({given})");
            assign(out, "const auto answer", &call);
            either(out, "answer", "*answer << '\\n'", "", "answer.error()");
        } else {
            let name = &request.ty.name;
            out.line(format!("const {space}Reports reports = client.reports();"));
            out.line(meanwhile.receives);
            let head = format!("while (const auto report = reports.next({PATIENCE}))");
            out.block(head, |out| {
                let open = "if (const auto* known =";
                let get = format!("std::get_if<{space}{name}>(&*report)) {{");
                if out.has_room([open, " ", &get]) {
                    out.line(format!("{open} {get}"));
                } else {
                    out.line(open);
                    out.line(format!("        {get}"));
                }
                out.enclose("", "}", |out| {
                    out.line("std::cout << *known << '\\n';");
                    out.line(meanwhile.received);
                });
            });
        }
        Some(())
    }

    fn write_robot(&self, out: &mut Source, operation: &Operation) -> Option<()> {
        if operation.kind() == Kind::Stream {
            return self.write_robot_stream(out, operation);
        }
        let call = self.context.package.call(operation)?;
        let (name, space) = (call.method, &self.space);
        if operation.kind() == Kind::Command {
            let answer = self.example(operation, Direction::Response)?;
            let [request, response] =
                [call.request, call.response].map(|it| [space, &*it.ty.name].concat());
            let parameters = [
                "const fc_runtime::Context& context".to_owned(),
                format!("const {request}& request"),
            ];
            let open = format!("fc_runtime::Replied<{response}> {name}(");
            out.parameters(&open, &parameters, ") override {");
            out.enclose("", "}", |out| {
                out.line("std::cout << context.connection << \" asks: \" << request << '\\n';");
                let filled = self.filled("response", &["context", "request"], &answer);
                if filled.is_empty() {
                    out.line(format!("return {response}{{}};"));
                } else {
                    self.declare(out, "response", &answer, &filled);
                    out.line("return response;");
                }
            });
        } else {
            let report = self.example(operation, Direction::Request)?;
            let filled = self.filled("report", &["reporter", "pushed"], &report);
            self.declare(out, "report", &report, &filled);
            let push = format!("reporter.{name}(report)");
            assign(out, "const auto pushed", &push);
            out.line(
                "\
if (!pushed) {
  std::cerr << to_string(pushed.error()) << '\\n';
} else {
  for (const auto& outcome : *pushed) {
    std::cout << outcome.connection << \": \" << name(outcome.kind) << '\\n';
  }
}",
            );
        }
        Some(())
    }

    fn write_app_stream(
        &self,
        out: &mut Source,
        stream: &Operation,
        meanwhile: &Meanwhile<'_>,
    ) -> Option<()> {
        let code = self.code(stream)?;
        assign(out, "const auto code", &code);
        if stream.sender == Side::Robot {
            out.line("const auto frames = data.subscribe(code);");
            out.line(meanwhile.receives);
            let head = format!("while (const auto frame = frames.next({PATIENCE}))");
            out.block(head, |out| {
                let Some(body) = stream.body(Direction::Request) else {
                    out.line(
                        "std::cout << frame->id << \": \" << frame->data.size() << \" bytes\\n\";",
                    );
                    out.line(meanwhile.received);
                    return;
                };
                let ty = [&self.space, self.context.name_of(&body.ty)].concat();
                let read = format!("fc_runtime::from_json<{ty}>(frame->data)");
                assign(out, "const auto content", &read);
                let read = "frame->id << \": \" << *content << '\\n'";
                either(out, "content", read, meanwhile.received, "content.error()");
            });
        } else {
            let content = self.content(out, stream);
            out.line(format!("const auto sent = data.send(code, 1, {content});"));
            out.line("if (!sent) std::cerr << to_string(sent.error()) << '\\n';");
        }
        Some(())
    }

    fn write_robot_stream(&self, out: &mut Source, stream: &Operation) -> Option<()> {
        let code = self.code(stream).filter(|_| stream.sender == Side::Robot)?;
        assign(out, "const auto code", &code);
        let content = self.content(out, stream);
        let send = format!("server.send_stream(std::nullopt, code, 1, {content})");
        assign(out, "const auto taken", &send);
        let taken = "*taken << \" data connections took it\\n\"";
        either(out, "taken", taken, "", "to_string(taken.error())");
        Some(())
    }

    /// The code of a stream; `None` where it has none.
    fn code(&self, stream: &Operation) -> Option<String> {
        let mut streams = self.context.package.streams.iter();
        let found = streams.find(|known| known.of.name == stream.name)?;
        let name = &found.name;
        let of = format!("{}StreamCode::{name}", self.space);
        Some(format!("static_cast<std::uint16_t>({of})"))
    }

    /// What makes the content of a stream, if more than a word; and the word for it.
    fn content(&self, out: &mut Source, stream: &Operation) -> String {
        let Some(example) = self.example(stream, Direction::Request) else {
            return literal(stub::BYTES);
        };
        let others = ["code", "data", "frames", "sent", "server", "taken", "text"];
        let filled = self.filled("content", &others, &example);
        self.declare(out, "content", &example, &filled);
        out.line("const std::string text = fc_runtime::to_json(content).value_or(\"\");");
        "text".to_owned()
    }

    /// `Type name;`, and what fills it.
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

    fn example(&self, operation: &Operation, direction: Direction) -> Option<Record<'p>> {
        stub::example(&self.context.package, self.samples, operation, direction)
    }
}

/// Prints what a result has, with another line behind it, or what has gone wrong.
fn either(out: &mut Source, result: &str, has: &str, more: &str, error: &str) {
    out.enclose(&format!("if ({result}) {{"), "} else {", |out| {
        out.line(format!("std::cout << {has};"));
        out.line(more);
    });
    out.enclose("", "}", |out| {
        out.line(format!("std::cerr << {error} << '\\n';"));
    });
}

/// The test that compiles and runs every sample.
#[must_use]
pub fn file(context: &Context<'_>, samples: &Samples<'_>) -> String {
    let snippets = Snippets::new(context, samples);
    let (commands, reports) = (context.commands(), context.reports());
    let streams = [Side::Robot, Side::App].map(|side| stub::streams(&context.package, side));
    let [from_robot, from_app] = &streams;
    let space = &namespace(context);
    let mut out = Source::cpp();
    out.line("// The samples of the documentation. They call every command and receive every report and stream.");
    let mut includes = Includes::default();
    for name in [
        "chrono", "cstdint", "iostream", "memory", "optional", "string", "variant",
    ] {
        includes.standard(name);
    }
    includes.own(format!("{space}/client.hpp"));
    includes.own(format!("{space}/robot.hpp"));
    includes.lines(&mut out);
    out.blank();
    out.line("// Laid out as on the pages.\n// clang-format off");
    if commands.iter().any(|it| it.operation.deprecated.is_some()) {
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
        for command in &commands {
            out.blank();
            let _ = snippets.write_robot(out, command.operation);
        }
    });
    let mut function = |head: String, body: &dyn Fn(&mut Source), end: &str| {
        out.blank();
        out.block(format!("bool {head}"), |out| {
            body(out);
            out.line(format!("return {end};"));
        });
    };
    for command in &commands {
        let operation = command.operation;
        let head = format!("call_{}(const {space}::Client& client)", operation.name);
        let body = |out: &mut Source| {
            let _ = snippets.write_app(out, operation, &Meanwhile::default());
        };
        function(head, &body, "answer.has_value()");
    }
    let reporter = format!("const {space}::Reporter& reporter");
    let server = "const fc_runtime::Server& server".to_owned();
    let data = "const fc_runtime::DataConnection& data".to_owned();
    let client = format!("const {space}::Client& client");
    let reports_of = reports.iter().map(|it| (it.operation, "push", "reporter"));
    let streams_of = from_robot.iter().map(|it| (*it, "send", "server"));
    for (operation, word, sender) in reports_of.chain(streams_of) {
        let name = &operation.name;
        let (sends, receives, sent) = match sender {
            "reporter" => (&reporter, &client, "pushed && pushed->size() == 1"),
            _ => (&server, &data, "taken && *taken == 1"),
        };
        let body = |out: &mut Source| {
            let _ = snippets.write_robot(out, operation);
        };
        function(format!("{word}_{name}({sends})"), &body, sent);
        let meanwhile = Meanwhile {
            receives: &format!("if (!{word}_{name}({sender})) return false;"),
            received: "return true;",
        };
        let body = |out: &mut Source| {
            let _ = snippets.write_app(out, operation, &meanwhile);
        };
        function(format!("take_{name}({receives}, {sends})"), &body, "false");
    }
    for stream in from_app {
        let body = |out: &mut Source| {
            let _ = snippets.write_app(out, stream, &Meanwhile::default());
        };
        function(
            format!("send_{}({data})", stream.name),
            &body,
            "sent.has_value()",
        );
    }
    out.blank();
    out.line("}  // namespace");
    out.blank();
    let calls = [&commands, &reports].map(|calls| calls.iter().map(|it| it.operation).collect());
    main(&mut out, space, &calls, &streams, &snippets);
    out.finish()
}

/// The function that runs them.
fn main(
    out: &mut Source,
    space: &str,
    [commands, reports]: &[Vec<&Operation>; 2],
    [from_robot, from_app]: &[Vec<&Operation>; 2],
    snippets: &Snippets<'_, '_>,
) {
    let check = |out: &mut Source, call: String| {
        let (name, _) = call.split_once('(').unwrap_or((&call, ""));
        let (asks, fails) = (
            format!("if (!{call})"),
            format!("return failed({});", literal(name)),
        );
        if out.has_room([&asks, " ", &fails]) {
            out.line(format!("{asks} {fails}"));
        } else {
            out.block(asks, |out| out.line(fails));
        }
    };
    out.line(
        "\
static int failed(const char* what) {
  std::cerr << what << \" has failed\\n\";
  return 1;
}",
    );
    out.blank();
    out.block("int main()", |out| {
        out.line(format!(
            "\
fc_runtime::ServerConfig served;
served.address = \"127.0.0.1\";
served.command_port = std::uint16_t{{0}};
served.data_port = std::uint16_t{{0}};
served.handler_timeout = {PATIENCE};
const auto robot = {space}::service(std::make_shared<SampleRobot>());
const auto server = fc_runtime::Server::bind({space}::protocol(), robot, served);
if (!server) return failed(\"bind\");
fc_runtime::ClientConfig config;
config.host = \"127.0.0.1\";
config.command_port = server->command_port();
config.data_port = server->data_port();
config.call_timeout = {PATIENCE};
const auto client = {space}::Client::connect(config);
if (!client) return failed(\"connect\");"
        ));
        for command in commands {
            check(out, format!("call_{}(*client)", command.name));
        }
        if !reports.is_empty() {
            out.line(format!("const {space}::Reporter reporter(*server);"));
        }
        for report in reports {
            check(out, format!("take_{}(*client, reporter)", report.name));
        }
        let mut streams = from_robot.iter().chain(from_app);
        if let Some(code) = streams.find_map(|stream| snippets.code(stream)) {
            out.line("const auto data = client->data();");
            check(out, "data.connected()".to_owned());
            out.line("// The robot knows a data connection after its first frame.");
            out.line("static_cast<void>(server->next_stream(std::chrono::milliseconds(0)));");
            check(out, format!("data.send({code}, 0, \"\")"));
            check(out, format!("server->next_stream({PATIENCE})"));
        }
        for stream in from_robot {
            check(out, format!("take_{}(data, *server)", stream.name));
        }
        for stream in from_app {
            check(out, format!("send_{}(data)", stream.name));
        }
        out.line("return 0;");
    });
}
