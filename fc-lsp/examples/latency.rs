//! Measures how long an editor waits for responses on a spec of 600 commands. It prints each time also as a ratio to
//! one full check of the same spec: `cargo run --release -p fc-lsp --example latency -- SPEC`. SPEC is the directory of
//! a spec to which the commands are added, such as `fc-codegen/tests/docs/spec`.
//!
//! The client runs in another thread, so each figure includes the cost of encoding and waking. Each figure is a median.
//! Every question except the last follows a change directly, before the server has checked the new text.

#![allow(
    clippy::expect_used,
    clippy::indexing_slicing,
    clippy::panic,
    clippy::print_stdout,
    reason = "an example"
)]

use fc_codegen::check::check;
use fc_codegen::project::ProjectDirs;
use fc_codegen::target::Targets;
use fc_lsp::serve;
use fc_spec::diagnostic::Faults;
use fc_spec::source::Sources;
use fc_spec::syntax::read_dir;
use lsp_server::{Connection, Message, Notification, Request, RequestId};
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::path::Path;
use std::time::{Duration, Instant};

/// The number of groups, and of commands in each.
const GROUPS: usize = 20;
const COMMANDS: usize = 30;
/// The number of measurements per figure.
const TIMES: usize = 21;

fn main() {
    let from = std::env::args().nth(1).expect("the directory of a spec");
    let root = std::env::temp_dir().join(format!("fc-latency-{}", std::process::id()));
    write_spec(Path::new(&from), &root.join("spec"));

    let mut faults = Faults::new();
    let sources = read_dir(&root, Path::new("spec"), &mut faults);
    let operations = checked(&sources);
    let check = median(|| {
        let start = Instant::now();
        checked(&sources);
        start.elapsed()
    });
    let bytes: usize = sources.iter().map(|(_, file)| file.text.len()).sum();
    println!(
        "{operations} operations in {} files, {} KiB",
        sources.iter().count(),
        bytes >> 10
    );
    println!("{:<34} {:>8} ", "", "ms");
    show("one full check", check, check);

    let mut client = Client::start(&root);
    let path = "spec/commands/group_7.yaml";
    client.open(path, &root);
    let figures = [
        ("change, until faults are told", None, ""),
        (
            "change, then completion of a key",
            Some("completion"),
            "    effect: read\n",
        ),
        (
            "change, then completion of a type",
            Some("completion"),
            "type: Shape7",
        ),
        (
            "change, then hover of a command",
            Some("hover"),
            "get_g7_c3:",
        ),
        (
            "change, then definition of a type",
            Some("definition"),
            "type: Shape7",
        ),
        (
            "change, then references of a type",
            Some("references"),
            "type: Shape7",
        ),
        ("change, then outline", Some("documentSymbol"), ""),
        ("change, then lenses", Some("codeLens"), ""),
        ("change, then formatting", Some("formatting"), ""),
    ];
    for (name, question, at) in figures {
        let found = median(|| client.after_change(path, question, at));
        show(name, found, check);
    }
    let again = median(|| client.asked(path, "hover", "get_g7_c3:"));
    show("hover of a command, nothing changed", again, check);
    std::fs::remove_dir_all(&root).expect("it can be removed");
}

fn show(name: &str, time: Duration, check: Duration) {
    let ratio = time.as_secs_f64() / check.as_secs_f64();
    println!(
        "{name:<36} {:>7.2}  {ratio:>5.2}",
        time.as_secs_f64() * 1000.0
    );
}

fn median(mut once: impl FnMut() -> Duration) -> Duration {
    let mut times: Vec<Duration> = (0..TIMES).map(|_| once()).collect();
    times.sort();
    times[TIMES / 2]
}

/// Checks the spec as `fcproto check` does and returns the number of its operations.
fn checked(sources: &Sources) -> usize {
    let mut faults = Faults::new();
    let checked = check(sources, &Targets::default().requirements(), &mut faults);
    let model = checked.model();
    let model = model.unwrap_or_else(|| panic!("the spec has errors: {:#?}", faults.iter().next()));
    model.operations.len()
}

/// Copies a spec and adds many commands.
fn write_spec(from: &Path, to: &Path) {
    copy(from, to);
    let protocol = to.join("protocol.yaml");
    let text = std::fs::read_to_string(&protocol).expect("a spec has it");
    let range = "    - { from: 0x4000, to: 0x4FFF, use: commands, zh: 许多, en: Many }\n";
    let text = text.replacen("  ranges:\n", &format!("  ranges:\n{range}"), 1);
    std::fs::write(&protocol, text).expect("it can be written");
    for group in 0..GROUPS {
        let mut text = format!(
            "group: {{ id: group_{group}, zh: 第 {group} 组, en: Group {group} }}\n\ncommands:\n"
        );
        for command in 0..COMMANDS {
            let code = 0x4000 + group * COMMANDS + command;
            write!(
                text,
                "  get_g{group}_c{command}:
    code: 0x{code:04X}
    zh: 查询 {command}
    en: Get number {command}
    effect: read
    source: {{ sections: [] }}
    request:
      data:
        id: {{ type: u32, example: {command}, zh: 编号, en: Number }}
        mode: {{ type: \"string?\", length: [1, 20], example: fast, zh: 模式, en: Mode }}
    response:
      data:
        name: {{ type: string, example: 甲, zh: 名称, en: Name }}
        shape: {{ type: Shape{group}, zh: 形状, en: Shape }}
        points: {{ type: [Shape{group}], zh: 各点, en: Points }}
        level: {{ type: i32, min: 0, max: 100, unit: \"%\", example: 40, zh: 亮度, en: Level }}

"
            )
            .expect("a text takes all");
        }
        write!(
            text,
            "types:
  Shape{group}:
    zh: 形状 {group}
    en: Shape {group}
    fields:
      x: {{ type: f64, unit: m, example: 1.5, zh: x 坐标, en: x coordinate }}
      y: {{ type: f64, unit: m, example: 2.5, zh: y 坐标, en: y coordinate }}
"
        )
        .expect("a text takes all");
        let path = to.join(format!("commands/group_{group}.yaml"));
        std::fs::write(path, text).expect("it can be written");
    }
}

fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).expect("a directory");
    for entry in std::fs::read_dir(from).expect("the spec") {
        let path = entry.expect("an entry").path();
        let target = to.join(path.file_name().expect("a name"));
        if path.is_dir() {
            copy(&path, &target);
        } else {
            std::fs::copy(&path, &target).expect("a copy");
        }
    }
}

struct Client {
    connection: Connection,
    root: String,
    text: String,
    version: i32,
    /// The last version whose errors the server has published.
    told: i32,
    ids: i32,
}

impl Client {
    fn start(root: &Path) -> Self {
        let (connection, server) = Connection::memory();
        let dirs = ProjectDirs {
            root: Some(root.to_owned()),
            spec: None,
        };
        std::thread::spawn(move || serve(&server, &dirs, || "2026-01-01".to_owned()));
        let mut client = Self {
            connection,
            root: format!("file://{}", root.display()),
            text: String::new(),
            version: 1,
            told: 0,
            ids: 0,
        };
        let params = json!({ "capabilities": {}, "rootUri": client.root });
        client.ask("initialize", params);
        client.tell("initialized", json!({}));
        client
    }

    fn open(&mut self, path: &str, root: &Path) {
        self.text = std::fs::read_to_string(root.join(path)).expect("a file of the spec");
        let document =
            json!({ "uri": self.uri(path), "languageId": "yaml", "version": 1, "text": self.text });
        self.tell("textDocument/didOpen", json!({ "textDocument": document }));
        self.wait_until_told();
    }

    fn uri(&self, path: &str) -> String {
        format!("{}/{path}", self.root)
    }

    /// Changes a letter, asks, and returns the time until the response. It then waits for the errors, so that the next
    /// change starts from a checked text.
    fn after_change(&mut self, path: &str, question: Option<&str>, at: &str) -> Duration {
        self.version += 1;
        let (line, column) = place(&self.text, "Get number 5\n");
        let (start, end) = (column, column + 3);
        let new = if self.version % 2 == 0 { "Ask" } else { "Get" };
        let range = json!({
            "start": { "line": line, "character": start },
            "end": { "line": line, "character": end },
        });
        let params = json!({
            "textDocument": { "uri": self.uri(path), "version": self.version },
            "contentChanges": [{ "range": range, "text": new }],
        });
        let start = Instant::now();
        self.tell("textDocument/didChange", params);
        let Some(question) = question else {
            self.wait_until_told();
            return start.elapsed();
        };
        self.asked(path, question, at);
        let time = start.elapsed();
        self.wait_until_told();
        time
    }

    fn asked(&mut self, path: &str, question: &str, at: &str) -> Duration {
        let (line, column) = place(&self.text, at);
        let character =
            column + u32::try_from(at.trim_end().len().saturating_sub(1)).expect("short");
        let params = json!({
            "textDocument": { "uri": self.uri(path) },
            "position": { "line": line, "character": character },
            "context": { "includeDeclaration": true, "triggerKind": 1 },
            "options": { "tabSize": 2, "insertSpaces": true },
        });
        let start = Instant::now();
        let answer = self.ask(&format!("textDocument/{question}"), params);
        assert!(!answer.is_null(), "{question} {at}");
        start.elapsed()
    }

    fn tell(&self, method: &str, params: Value) {
        let method = method.to_owned();
        let message = Notification { method, params };
        self.connection
            .sender
            .send(message.into())
            .expect("a server");
    }

    fn ask(&mut self, method: &str, params: Value) -> Value {
        self.ids += 1;
        let id = RequestId::from(self.ids);
        let request = Request::new(id.clone(), method.to_owned(), params);
        self.connection
            .sender
            .send(request.into())
            .expect("a server");
        loop {
            match self.connection.receiver.recv().expect("a server") {
                Message::Response(response) if response.id == id => {
                    return response.response_result.expect("an answer");
                }
                other => self.hear(&other),
            }
        }
    }

    fn hear(&mut self, message: &Message) {
        if let Message::Notification(told) = message
            && told.method == "textDocument/publishDiagnostics"
            && told.params["version"] == self.version
        {
            self.told = self.version;
        }
    }

    /// Waits until the server has published the errors of the current text.
    fn wait_until_told(&mut self) {
        while self.told != self.version {
            let message = self.connection.receiver.recv().expect("a server");
            self.hear(&message);
        }
    }
}

/// Returns line and column of the first occurrence of `part`. The lines must be ASCII up to there.
fn place(text: &str, part: &str) -> (u32, u32) {
    let at = text.find(part).expect("it is there");
    let before = &text[..at];
    let line = before.matches('\n').count();
    let column = at - before.rfind('\n').map_or(0, |newline| newline + 1);
    let narrow = |number| u32::try_from(number).expect("short");
    (narrow(line), narrow(column))
}
