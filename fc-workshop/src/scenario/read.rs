//! Reads a scenario from YAML. Errors have the place in the file.

use super::{Action, Expected, Rule, Scenario, ScriptedReport, merge, omit};
use fc_reflect::sample::Profile;
use fc_reflect::{Direction, Reflector};
use fc_spec::diagnostic::{Diagnostic, FaultCode, Faults, nearest};
use fc_spec::model::{Kind, Number, Operation, Text, Value};
use fc_spec::source::Sources;
use fc_spec::syntax::{Entry, Node, NodeKind, Style, parse};
use fc_spec::text;
use std::time::Duration;

/// The longest time in a scenario, in milliseconds.
const LONGEST_MS: u64 = 86_400_000;

impl Scenario {
    /// Reads the first file of `sources` as a scenario, and checks it by the spec. Without errors in `faults`, there is
    /// a scenario.
    #[must_use]
    pub fn read(reflector: &Reflector<'_>, sources: &Sources, faults: &mut Faults) -> Option<Self> {
        let (file, source) = sources.iter().next()?;
        let tree = parse(file, &source.text, faults)?;
        let mut reader = Reader { reflector, faults };
        let scenario = reader.scenario(tree.root());
        (!faults.has_errors()).then_some(scenario)
    }
}

struct Reader<'r, 'm> {
    reflector: &'r Reflector<'m>,
    faults: &'r mut Faults,
}

impl<'m> Reader<'_, 'm> {
    fn error(&mut self, code: FaultCode, node: Node<'_>, message: Text) {
        self.faults
            .push(Diagnostic::error(code, node.span(), message));
    }

    /// Visits the entries of a mapping, whose keys must be known.
    fn entries<'t>(
        &mut self,
        node: Node<'t>,
        known: &[&'static str],
        mut each: impl FnMut(&mut Self, &str, Node<'t>),
    ) {
        let Some(entries) = node.as_mapping() else {
            return self.wrong_kind(node, &text!("映射", "a mapping"));
        };
        for entry in entries {
            let name = entry.name();
            if known.contains(&name) {
                each(self, name, entry.value);
            } else {
                self.unknown_key(entry, known);
            }
        }
    }

    fn wrong_kind(&mut self, node: Node<'_>, expected: &Text) {
        let found = node.describe();
        let message = text!(
            "应为{expected}，实际为{found}",
            "expected {expected}, found {found}",
            expected = expected,
            found = found
        );
        self.error(FaultCode::WrongKind, node, message);
    }

    fn unknown_key(&mut self, entry: Entry<'_>, known: &[&'static str]) {
        let name = entry.name();
        let message = match nearest(name, known.iter().copied()) {
            Some(near) => text!(
                "没有键 `{name}`，是否想写 `{near}`？",
                "there is no key `{name}`; did you mean `{near}`?"
            ),
            None => text!(
                "没有键 `{name}`；可用的键：{known}",
                "there is no key `{name}`; the keys are {known}",
                known = Text::listed(known)
            ),
        };
        self.error(FaultCode::UnknownKey, entry.key, message);
    }

    fn scenario(&mut self, root: Node<'_>) -> Scenario {
        let mut scenario = Scenario::of_commands([]);
        let keys = ["zh", "en", "on", "expect", "never", "within_ms"];
        self.entries(root, &keys, |reader, key, node| match key {
            "on" => scenario.rules = reader.list(node, Self::rule),
            "expect" => scenario.expect = reader.list(node, Self::expected),
            "never" => {
                scenario.never = reader.list(node, |reader, node| {
                    let command = reader.operation(node, Kind::Command);
                    command.map(|command| command.name.clone())
                });
            }
            "within_ms" => scenario.within = reader.milliseconds(node),
            _ => {}
        });
        scenario
    }

    fn list<T>(
        &mut self,
        node: Node<'_>,
        mut item: impl FnMut(&mut Self, Node<'_>) -> Option<T>,
    ) -> Vec<T> {
        let Some(items) = node.as_sequence() else {
            self.wrong_kind(node, &text!("列表", "a list"));
            return Vec::new();
        };
        items.filter_map(|node| item(self, node)).collect()
    }

    fn rule(&mut self, node: Node<'_>) -> Option<Rule> {
        let request = node.get("request");
        let Some(command) = request.and_then(|node| self.operation(node, Kind::Command)) else {
            if request.is_none() {
                let message = text!("规则缺少 `request`", "a rule needs `request`");
                self.error(FaultCode::MissingKey, node, message);
            }
            return None;
        };
        let mut rule = Rule {
            request: command.name.clone(),
            with: Value::Null,
            times: None,
            action: Action::default(),
        };
        let keys = [
            "request",
            "with",
            "times",
            "answer",
            "omit",
            "refuse",
            "delay_ms",
            "silent",
            "bad_digest",
            "disconnect",
            "reports",
        ];
        self.entries(node, &keys, |reader, key, node| {
            let action = &mut rule.action;
            match key {
                "with" => rule.with = value(node),
                "times" => rule.times = reader.integer(node).and_then(|it| it.try_into().ok()),
                "answer" => action.answer = Some(reader.body(command, Direction::Response, node)),
                "omit" => {
                    action.omit = reader.list(node, |reader, node| reader.omitted(command, node));
                }
                "refuse" => action.refuse = reader.result(node),
                "delay_ms" => action.delay = reader.milliseconds(node),
                "silent" => action.silent = reader.truth(node),
                "bad_digest" => action.bad_digest = reader.truth(node),
                "disconnect" => action.disconnect = reader.truth(node),
                "reports" => action.reports = Some(reader.list(node, Self::report)),
                _ => {}
            }
        });
        Some(rule)
    }

    fn report(&mut self, node: Node<'_>) -> Option<ScriptedReport> {
        let report = self.operation(node.get("report").unwrap_or(node), Kind::Report)?;
        let mut scripted = ScriptedReport {
            report: report.name.clone(),
            body: Value::Object(Vec::new()),
            after: Duration::ZERO,
        };
        if node.as_str().is_none() {
            let keys = ["report", "body", "after_ms"];
            self.entries(node, &keys, |reader, key, node| match key {
                "body" => scripted.body = reader.body(report, Direction::Request, node),
                "after_ms" => scripted.after = reader.milliseconds(node),
                _ => {}
            });
        }
        Some(scripted)
    }

    fn expected(&mut self, node: Node<'_>) -> Option<Expected> {
        if let Some(report) = node.get("acknowledged") {
            let report = self.operation(report, Kind::Report)?;
            self.entries(node, &["acknowledged"], |_, _, _| {});
            return Some(Expected::Acknowledgement(report.name.clone()));
        }
        let command = self.operation(node.get("request").unwrap_or(node), Kind::Command)?;
        let mut with = Value::Null;
        if node.as_str().is_none() {
            self.entries(node, &["request", "with"], |_, key, node| {
                if key == "with" {
                    with = value(node);
                }
            });
        }
        Some(Expected::Request(command.name.clone(), with))
    }

    /// Returns the operation with the name in a node.
    fn operation(&mut self, node: Node<'_>, kind: Kind) -> Option<&'m Operation> {
        let model = self.reflector.model();
        let name = node.as_str().unwrap_or_default();
        let found = model.operation(name);
        if let Some(operation) = found.filter(|operation| operation.kind() == kind) {
            if operation.code.value.is_none() {
                let message = text!(
                    "`{name}` 还没有功能码，不会出现在通信中",
                    "`{name}` has no code yet, so it is never sent"
                );
                self.error(FaultCode::UnknownOperation, node, message);
            }
            return Some(operation);
        }
        let code = match (found, kind) {
            (Some(_), Kind::Report) => FaultCode::NotAReport,
            (Some(_), _) => FaultCode::NotACommand,
            (None, _) => FaultCode::UnknownOperation,
        };
        let operations = model.operations.iter().filter(|it| it.kind() == kind);
        let near = nearest(name, operations.map(|it| it.name.as_str()));
        let wanted = match kind {
            Kind::Report => text!("上报", "a report"),
            Kind::Command | Kind::Stream => text!("指令", "a command"),
        };
        let message = match near {
            Some(near) => text!(
                "`{name}` 不是{wanted}，是否想写 `{near}`？",
                "`{name}` is not {wanted}; did you mean `{near}`?",
                wanted = wanted
            ),
            None => text!(
                "`{name}` 不是{wanted}",
                "`{name}` is not {wanted}",
                wanted = wanted
            ),
        };
        self.error(code, node, message);
        None
    }

    /// Reads values for a message. With them, the example must satisfy the spec.
    fn body(&mut self, operation: &Operation, direction: Direction, node: Node<'_>) -> Value {
        let values = value(node);
        let samples = self.reflector.samples();
        let mut message = samples.message(operation, direction, Profile::Example);
        merge(&mut message, &values);
        let text = message.to_string();
        let read = (self.reflector).message(Some(operation), direction, text.as_bytes());
        if let Err(error) = read.and_then(|message| message.canonical()) {
            let message = text!(
                "消息会不合规范：{error}",
                "the message would break the spec: {error}"
            );
            self.error(FaultCode::ExampleType, node, message);
        }
        values
    }

    /// Returns the path of a key that the example of a response has.
    fn omitted(&mut self, command: &Operation, node: Node<'_>) -> Option<Vec<String>> {
        let word = node.as_str().unwrap_or_default();
        let path: Vec<_> = word.split('.').map(str::to_owned).collect();
        let samples = self.reflector.samples();
        let mut message = samples.message(command, Direction::Response, Profile::Example);
        if omit(&mut message, &path) {
            return Some(path);
        }
        let message = text!(
            "响应的示例没有键 `{word}`",
            "the example of the response has no key `{word}`"
        );
        self.error(FaultCode::UnknownKey, node, message);
        None
    }

    /// Returns the code of a result, which has its name or its number.
    fn result(&mut self, node: Node<'_>) -> Option<i64> {
        let results = &self.reflector.model().results;
        let word = node.as_str().unwrap_or_default();
        let found = results.iter().find(|result| {
            result.name == word || node.as_plain() == Some(result.code.to_string().as_str())
        });
        if found.is_none() {
            let known = Text::listed(results.iter().map(|result| &result.name));
            let message = text!(
                "没有结果 `{word}`；可用的结果：{known}",
                "there is no result `{word}`; the results are {known}",
                known = known
            );
            self.error(FaultCode::UnknownResult, node, message);
        }
        found.map(|result| result.code)
    }

    fn integer(&mut self, node: Node<'_>) -> Option<u64> {
        let number = node.as_plain().and_then(|text| text.parse().ok());
        let number = number.filter(|number| *number <= LONGEST_MS);
        if number.is_none() {
            let message = text!(
                "应为 0 到 {LONGEST_MS} 的整数",
                "expected an integer from 0 to {LONGEST_MS}"
            );
            self.error(FaultCode::BadInteger, node, message);
        }
        number
    }

    fn milliseconds(&mut self, node: Node<'_>) -> Duration {
        Duration::from_millis(self.integer(node).unwrap_or(0))
    }

    fn truth(&mut self, node: Node<'_>) -> bool {
        match node.as_plain() {
            Some("true") => true,
            Some("false") => false,
            _ => {
                let message = text!("应为 true 或 false", "expected true or false");
                self.error(FaultCode::BadBool, node, message);
                false
            }
        }
    }
}

/// Returns a node as JSON. A plain scalar is a number, a bool or a string.
///
/// The recursion is as deep as the file, which is limited.
fn value(node: Node<'_>) -> Value {
    match node.kind() {
        NodeKind::Null => Value::Null,
        NodeKind::Sequence(items) => Value::Array(items.map(value).collect()),
        NodeKind::Mapping(entries) => {
            let entries = entries.map(|entry| (entry.name().to_owned(), value(entry.value)));
            Value::Object(entries.collect())
        }
        NodeKind::Scalar(scalar) => {
            let text = scalar.text;
            let plain = (scalar.style == Style::Plain).then(|| match text {
                "true" => Some(Value::Bool(true)),
                "false" => Some(Value::Bool(false)),
                _ => {
                    let int = text.parse().ok().map(Number::Int);
                    let float = || text.parse().ok().filter(|it: &f64| it.is_finite());
                    let number = int.or_else(|| float().map(Number::Float));
                    number.map(Value::Number)
                }
            });
            let plain = plain.flatten();
            plain.unwrap_or_else(|| Value::String(text.to_owned()))
        }
    }
}
