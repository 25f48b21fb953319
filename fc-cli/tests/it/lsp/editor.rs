//! An editor without a window. It is a client of the Language Server Protocol and runs the command as its server. It
//! keeps the text of open files and applies the edits that it receives.

use std::collections::{BTreeMap, VecDeque};
use std::io::BufReader;
use std::process::{Child, ChildStdin, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

use lsp_server::{Message, Notification, Request, Response};
use serde_json::{Value, json};

use crate::lsp::{LAMP, PROTOCOL, TYPES};
use crate::support::{Project, command};

/// The time without a message after which the server has failed. A working server responds in milliseconds.
const PATIENCE: Duration = Duration::from_secs(120);

/// Starts an editor with the files of the spec open, which have no errors.
pub fn editor(project: &Project) -> Editor<'_> {
    editor_in(project, "en")
}

/// Starts the same editor in another language.
pub fn editor_in<'p>(project: &'p Project, locale: &str) -> Editor<'p> {
    let mut editor = Editor::with(project, json!({ "locale": locale }));
    for path in [TYPES, LAMP, PROTOCOL] {
        editor.open(path);
        assert_eq!(editor.codes(path), [""; 0]);
    }
    editor
}

pub struct Editor<'p> {
    project: &'p Project,
    server: Child,
    stdin: Option<ChildStdin>,
    from_server: Receiver<Message>,
    /// Messages that arrived while the editor waited for another one.
    kept: VecDeque<Message>,
    /// The version and text of each open file, by its path in the project.
    open: BTreeMap<String, (i32, String)>,
    /// `true` if columns count bytes, `false` if they count UTF-16 units.
    counts_bytes: bool,
    ids: i32,
    /// The capabilities that the server announced.
    pub capabilities: Value,
}

impl<'p> Editor<'p> {
    /// Starts an editor with the project's root open. It counts columns in UTF-16.
    pub fn start(project: &'p Project) -> Self {
        Self::with(project, json!({}))
    }

    /// Starts an editor with other parameters of `initialize`.
    pub fn with(project: &'p Project, params: Value) -> Self {
        let mut server = command(&["lsp"])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("the command can be run");
        let stdin = server.stdin.take();
        let stdout = server.stdout.take().expect("a pipe");
        let (sender, from_server) = channel();
        std::thread::spawn(move || {
            let mut stdout = BufReader::new(stdout);
            while let Ok(Some(message)) = Message::read(&mut stdout) {
                if sender.send(message).is_err() {
                    return;
                }
            }
        });
        let mut editor = Self {
            project,
            server,
            stdin,
            from_server,
            kept: VecDeque::new(),
            open: BTreeMap::new(),
            counts_bytes: false,
            ids: 0,
            capabilities: Value::Null,
        };
        let mut all = json!({
            "processId": null,
            "capabilities": {},
            "rootUri": editor.uri(""),
        });
        let given = params.as_object().expect("an object").clone();
        all.as_object_mut().expect("an object").extend(given);
        let result = editor.ask("initialize", all);
        editor.capabilities = result["capabilities"].clone();
        editor.counts_bytes = editor.capabilities["positionEncoding"] == "utf-8";
        editor.tell("initialized", json!({}));
        editor
    }

    pub fn uri(&self, path: &str) -> String {
        format!("file://{}", self.project.path(path).display())
    }

    /// Returns the path of a file in the project.
    pub fn path(&self, uri: &Value) -> String {
        let uri = uri.as_str().expect("a URI");
        let root = self.uri("");
        let path = uri.strip_prefix(root.trim_end_matches('/'));
        let path = path.unwrap_or_else(|| panic!("{uri} is not below {root}"));
        path.trim_start_matches('/').to_owned()
    }

    pub fn send(&mut self, message: impl Into<Message>) {
        let stdin = self.stdin.as_mut().expect("the server listens");
        message.into().write(stdin).expect("the server reads");
    }

    pub fn tell(&mut self, method: &str, params: Value) {
        let method = method.to_owned();
        self.send(Notification { method, params });
    }

    /// Sends a request and returns its ID.
    pub fn request(&mut self, method: &str, params: Value) -> i32 {
        self.ids += 1;
        let id = self.ids;
        self.send(Request::new(id.into(), method.to_owned(), params));
        id
    }

    /// Sends a request and returns its result.
    pub fn ask(&mut self, method: &str, params: Value) -> Value {
        self.try_ask(method, params)
            .unwrap_or_else(|error| panic!("{method}: {error}"))
    }

    /// Sends a request and returns its result or its error.
    pub fn try_ask(&mut self, method: &str, params: Value) -> Result<Value, String> {
        let id = self.request(method, params);
        self.answer(id)
    }

    /// Waits for the response to a request.
    pub fn answer(&mut self, id: i32) -> Result<Value, String> {
        let response = self.wait(|message| match message {
            Message::Response(response) if response.id == id.into() => Some(response.clone()),
            _ => None,
        });
        let Response {
            response_result, ..
        } = response;
        response_result.map_err(|error| format!("{} {}", error.code, error.message))
    }

    /// Waits for the first message for which `wanted` returns a value. Earlier messages stay available.
    pub fn wait<T>(&mut self, wanted: impl Fn(&Message) -> Option<T>) -> T {
        for (at, message) in self.kept.iter().enumerate() {
            if let Some(found) = wanted(message) {
                self.kept.remove(at);
                return found;
            }
        }
        loop {
            let message = self.from_server.recv_timeout(PATIENCE);
            let message = message.expect("the server says what is waited for");
            if let Some(found) = wanted(&message) {
                return found;
            }
            self.kept.push_back(message);
        }
    }

    /// Opens a file with its text on disk.
    pub fn open(&mut self, path: &str) {
        let text = self.project.read(path);
        self.open_as(path, &text);
    }

    /// Opens a file with another text than on disk.
    pub fn open_as(&mut self, path: &str, text: &str) {
        self.open.insert(path.to_owned(), (1, text.to_owned()));
        let uri = self.uri(path);
        let document = json!({ "uri": uri, "languageId": "yaml", "version": 1, "text": text });
        self.tell("textDocument/didOpen", json!({ "textDocument": document }));
    }

    pub fn close(&mut self, path: &str) {
        self.open.remove(path);
        let document = json!({ "uri": self.uri(path) });
        self.tell("textDocument/didClose", json!({ "textDocument": document }));
    }

    /// Returns the text of an open file.
    pub fn text(&self, path: &str) -> &str {
        &self.open[path].1
    }

    /// Replaces the only occurrence of `old` in an open file. The server receives this part only.
    pub fn replace(&mut self, path: &str, old: &str, new: &str) {
        let text = self.text(path);
        assert_eq!(text.matches(old).count(), 1, "{old:?} in {path}");
        let at = text.find(old).expect("it is there");
        let range = json!({
            "start": self.position_of(path, at),
            "end": self.position_of(path, at + old.len()),
        });
        self.change(path, &[json!({ "range": range, "text": new })]);
    }

    /// Replaces the whole text of an open file.
    pub fn write(&mut self, path: &str, text: &str) {
        self.change(path, &[json!({ "text": text })]);
    }

    fn change(&mut self, path: &str, changes: &[Value]) {
        let (version, mut text) = self.open[path].clone();
        for change in changes {
            text = match change.get("range") {
                Some(_) => self.edited(&text, std::slice::from_ref(change), "text"),
                None => change["text"].as_str().expect("a text").to_owned(),
            };
        }
        self.open.insert(path.to_owned(), (version + 1, text));
        let document = json!({ "uri": self.uri(path), "version": version + 1 });
        let params = json!({ "textDocument": document, "contentChanges": changes });
        self.tell("textDocument/didChange", params);
    }

    /// Waits until the server has checked the current text of a file, and returns its diagnostics.
    pub fn faults(&mut self, path: &str) -> Vec<Value> {
        let uri = self.uri(path);
        let version = self.open.get(path).map(|(version, _)| *version);
        self.wait(|message| {
            let Message::Notification(Notification { method, params }) = message else {
                return None;
            };
            let is_it = method == "textDocument/publishDiagnostics"
                && params["uri"] == uri.as_str()
                && version.is_none_or(|version| params["version"] == version);
            is_it.then(|| params["diagnostics"].as_array().expect("a list").clone())
        })
    }

    /// Returns the codes of the diagnostics of a file.
    pub fn codes(&mut self, path: &str) -> Vec<String> {
        let faults = self.faults(path);
        let codes = faults.iter().map(|fault| fault["code"].as_str());
        codes.map(|code| code.expect("a code").to_owned()).collect()
    }

    /// Waits until the current text of a file has no diagnostics. During an edit of several files, the server may first
    /// check it next to files that are not changed yet.
    pub fn becomes_clean(&mut self, path: &str) {
        let (uri, version) = (self.uri(path), self.open[path].0);
        self.wait(|message| match message {
            Message::Notification(it) => {
                let params = &it.params;
                let is_of_this = params["uri"] == uri.as_str() && params["version"] == version;
                (is_of_this && params["diagnostics"] == json!([])).then_some(())
            }
            _ => None,
        });
    }

    /// Returns the position of the `|` in `marked`. The text around it must occur once in the open file.
    pub fn position(&self, path: &str, marked: &str) -> Value {
        let (before, after) = marked.split_once('|').expect("a mark");
        let whole = [before, after].concat();
        let text = self.text(path);
        assert_eq!(text.matches(&whole).count(), 1, "{whole:?} in {path}");
        let at = text.find(&whole).expect("it is there");
        self.position_of(path, at + before.len())
    }

    /// Returns the position of an offset in an open file.
    pub fn position_of(&self, path: &str, offset: usize) -> Value {
        let before = &self.text(path)[..offset];
        let line = before.matches('\n').count();
        let start = before.rfind('\n').map_or(0, |at| at + 1);
        let column: usize = before[start..].chars().map(|c| self.width(c)).sum();
        json!({ "line": line, "character": column })
    }

    fn width(&self, c: char) -> usize {
        if self.counts_bytes {
            c.len_utf8()
        } else {
            c.len_utf16()
        }
    }

    /// Sends a request about a marked position of an open file.
    pub fn ask_at(&mut self, method: &str, path: &str, marked: &str) -> Value {
        let params = self.at(path, marked);
        self.ask(method, params)
    }

    /// Returns the parameters of a request about a marked position.
    pub fn at(&self, path: &str, marked: &str) -> Value {
        json!({
            "textDocument": { "uri": self.uri(path) },
            "position": self.position(path, marked),
        })
    }

    /// Returns the text of a range. A file that is not open is read from disk.
    pub fn slice(&self, path: &str, range: &Value) -> String {
        let on_disk;
        let text = match self.open.get(path) {
            Some((_, text)) => text,
            None => {
                on_disk = self.project.read(path);
                &on_disk
            }
        };
        text[self.offset(text, &range["start"])..self.offset(text, &range["end"])].to_owned()
    }

    /// Returns the text of each location after its path and line.
    pub fn slices(&self, locations: &Value) -> Vec<String> {
        let locations = locations.as_array().expect("locations");
        let texts = locations.iter().map(|location| {
            let path = self.path(&location["uri"]);
            let line = location["range"]["start"]["line"].as_u64().expect("a line") + 1;
            let text = self.slice(&path, &location["range"]);
            format!("{path}:{line} {text}")
        });
        texts.collect()
    }

    fn offset(&self, text: &str, position: &Value) -> usize {
        let line = position["line"].as_u64().expect("a line");
        let column = position["character"].as_u64().expect("a column");
        let line = usize::try_from(line).expect("small");
        let start: usize = text.split_inclusive('\n').take(line).map(str::len).sum();
        let mut left = usize::try_from(column).expect("small");
        let rest = text[start..].char_indices();
        for (at, c) in rest {
            if left == 0 {
                return start + at;
            }
            assert_ne!(c, '\n', "column {column} is beyond line {line}");
            left = left
                .checked_sub(self.width(c))
                .expect("not inside a character");
        }
        assert_eq!(left, 0, "column {column} is beyond line {line}");
        text.len()
    }

    /// Returns a text after edits that do not overlap.
    fn edited(&self, text: &str, edits: &[Value], new: &str) -> String {
        let mut edits: Vec<_> = edits
            .iter()
            .map(|edit| {
                let range = &edit["range"];
                let ends = self.offset(text, &range["start"])..self.offset(text, &range["end"]);
                (ends, edit[new].as_str().expect("a text"))
            })
            .collect();
        edits.sort_by_key(|(range, _)| std::cmp::Reverse(range.start));
        let mut text = text.to_owned();
        for (range, new) in edits {
            text.replace_range(range, new);
        }
        text
    }

    /// Applies a list of edits to an open file.
    pub fn edit(&mut self, path: &str, edits: &Value) {
        let edits = edits.as_array().expect("edits").clone();
        let text = self.edited(self.text(path), &edits, "newText");
        self.write(path, &text);
    }

    /// Applies an edit of the workspace and opens the files that it changes.
    pub fn apply(&mut self, edit: &Value) {
        let changes = edit["documentChanges"].as_array().expect("changes").clone();
        for change in &changes {
            let document = &change["textDocument"];
            let path = self.path(&document["uri"]);
            match self.open.get(&path) {
                Some((version, _)) => assert_eq!(document["version"], *version, "{path}"),
                None => {
                    assert_eq!(document["version"], Value::Null, "{path}");
                    self.open(&path);
                }
            }
            self.edit(&path, &change["edits"]);
        }
    }

    /// Writes all open files to disk.
    pub fn save(&self) {
        for (path, (_, text)) in &self.open {
            self.project.write(path, text);
        }
    }

    /// Shuts the server down as an editor does and returns its exit status.
    pub fn end(mut self) -> i32 {
        self.ask("shutdown", Value::Null);
        self.tell("exit", Value::Null);
        self.stdin = None;
        let status = self.server.wait().expect("it ends");
        status.code().expect("not ended by a signal")
    }
}

/// A failed test must not leave a server running.
impl Drop for Editor<'_> {
    fn drop(&mut self) {
        self.stdin = None;
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}
