//! A rule of the project as it is written: what it is about, and what it asks of which path.

use super::house::{GROUPS, HOUSE_RULE, HouseRule, SETTINGS};
use super::path::{At, Shape, kinds};
use super::predicate::{Check, Test};
use super::settings::{Reader, meant};
use crate::diagnostic::{Diagnostic, FaultCode, nearest};
use crate::load::grammar::TEXT;
use crate::load::scalar;
use crate::model::Text;
use crate::syntax::{Node, NodeKind, Style};
use crate::text;
use regex_lite::Regex;
use serde_json::Value;

/// Most levels of `all`, `any` and `not` in one another.
const DEPTH: u8 = 16;

impl Reader<'_> {
    pub(super) fn rule(&mut self, node: Node<'_>) -> Option<HouseRule> {
        const KEYS: [&str; 7] = ["id", "zh", "en", "level", "for", "where", "require"];
        for entry in node.entries() {
            if !KEYS.contains(&entry.name()) {
                self.unknown(
                    entry.key,
                    &text!("规则的键", "key of a rule"),
                    KEYS.into_iter(),
                );
            }
        }
        let mut text = |key: &str| {
            let found = node.get(key).and_then(Node::as_str).map(str::to_owned);
            if found.is_none() {
                let message = missing(key);
                let advice = text!(
                    "规则要有 `id`、`zh`、`en`、`for` 和 `require`",
                    "a rule has `id`, `zh`, `en`, `for` and `require`"
                );
                self.fault(
                    node.entries()
                        .next()
                        .map_or(node.span(), |it| it.key.span()),
                    message,
                    advice,
                );
            }
            found
        };
        let (id, zh, en) = (text("id"), text(TEXT.zh.name), text(TEXT.en.name));
        let on = self.kinds(node)?;
        let level = match node.get("level") {
            Some(level) => self.level(level)?,
            None => HOUSE_RULE.level,
        };
        let shapes: Vec<Shape> = on.iter().map(|kind| Shape::of(kind)).collect();
        // Things of kinds that share a dump have the same paths.
        let shape = shapes.first()?;
        let (only, require) = (node.get("where"), node.get("require"));
        let only = only.map_or(Some(Test::All(Vec::new())), |it| {
            self.test(it, shape, DEPTH)
        });
        let Some(require) = require else {
            let advice = text!(
                "请写明要求，例如 `require: {{ since: present }}`",
                "say what has to hold, such as `require: {{ since: present }}`"
            );
            self.fault(
                node.span(),
                text!("这条规则没有要求", "this rule requires nothing"),
                advice,
            );
            return None;
        };
        let require = self.test(require, shape, DEPTH);
        Some(HouseRule {
            id: id?,
            text: Text { zh: zh?, en: en? },
            level,
            on,
            only: only?,
            require: require?,
        })
    }

    /// What a rule is about.
    fn kinds(&mut self, node: Node<'_>) -> Option<Vec<&'static str>> {
        let Some(on) = node.get("for") else {
            let advice = text!(
                "请写明针对什么，例如 `for: command`",
                "say what it is about, such as `for: command`"
            );
            self.fault(node.span(), missing("for"), advice);
            return None;
        };
        let word = on.as_str().unwrap_or_default();
        if let Some((_, kinds)) = GROUPS.iter().find(|(name, _)| *name == word) {
            return Some(kinds.to_vec());
        }
        let found = kinds().find(|kind| *kind == word);
        if found.is_none() {
            let words: Vec<_> = kinds().chain(GROUPS.map(|(name, _)| name)).collect();
            self.unknown(on, &text!("这一类对象", "kind of thing"), words.into_iter());
        }
        Some(vec![found?])
    }

    /// What holds where each entry does: by path, or `all`, `any`, `not`.
    fn test(&mut self, node: Node<'_>, shape: &Shape, depth: u8) -> Option<Test> {
        let Some(depth) = depth.checked_sub(1) else {
            let message = text!("嵌套太深", "this is nested too deeply");
            self.fault(
                node.span(),
                message,
                text!("请分成两条规则", "make two rules of it"),
            );
            return None;
        };
        if node.as_mapping().is_none() {
            let advice = text!(
                "请写明哪个路径应是什么，例如 `{{ effect: motion }}`",
                "write what is asked of which path: `{{ effect: motion }}`"
            );
            self.fault(
                node.span(),
                text!("判断应为映射", "a test is a mapping"),
                advice,
            );
            return None;
        }
        let mut tests = Vec::new();
        let mut is_sound = true;
        for entry in node.entries() {
            let test = match entry.name() {
                "all" => self.each(entry.value, shape, depth).map(Test::All),
                "any" => self.each(entry.value, shape, depth).map(Test::Any),
                "not" => {
                    let test = self.test(entry.value, shape, depth);
                    test.map(|test| Test::Not(Box::new(test)))
                }
                _ => self.at(entry.key, entry.value, shape),
            };
            is_sound &= test.is_some();
            tests.extend(test);
        }
        is_sound.then_some(Test::All(tests))
    }

    fn each(&mut self, node: Node<'_>, shape: &Shape, depth: u8) -> Option<Vec<Test>> {
        if node.as_sequence().is_none() {
            let advice = text!("每项判断前写短横线", "write each test behind a dash");
            self.fault(
                node.span(),
                text!("`all` 和 `any` 下应为列表", "`all` and `any` take a list"),
                advice,
            );
            return None;
        }
        let tests = node.items().map(|item| self.test(item, shape, depth));
        tests.collect()
    }

    /// What is asked of a path.
    fn at(&mut self, key: Node<'_>, value: Node<'_>, shape: &Shape) -> Option<Test> {
        let path: Vec<String> = key.as_str()?.split('.').map(str::to_owned).collect();
        let mut at = shape.root();
        for (index, part) in path.iter().enumerate() {
            let mut keys = at.keys();
            if let Some(next) = keys.remove(part.as_str()) {
                at = next;
                continue;
            }
            if at.is_list() {
                let list = path.get(..index).unwrap_or_default().join(".");
                let advice = text!(
                    "只能判断它有没有，以及长度：`min_length`、`max_length`",
                    "a rule can ask whether it is there, and for its length: `min_length`, `max_length`"
                );
                self.fault(
                    key.span(),
                    text!("`{list}` 是列表", "`{list}` is a list"),
                    advice,
                );
                return None;
            }
            let message = text!(
                "`fcproto inspect` 的输出在这里没有键 `{part}`",
                "`fcproto inspect` prints no key `{part}` there"
            );
            let fault = Diagnostic::error(FaultCode::Lint(SETTINGS), key.span(), message);
            let near = nearest(part, keys.keys().copied());
            self.faults.push(if let Some(near) = near {
                let mut path = path.clone();
                if let Some(part) = path.get_mut(index) {
                    near.clone_into(part);
                }
                fault.fix(key.span(), path.join("."), meant(near))
            } else {
                let keys: Vec<_> = keys.into_keys().collect();
                let (zh, en) = (keys.join("、"), keys.join(", "));
                fault.note(text!("可用的键有：{zh}", "its keys are {en}"))
            });
            return None;
        }
        let mut checks = self.checks(value, &at)?;
        Some(match (checks.pop(), checks.is_empty()) {
            (Some(check), true) => Test::At(path, check),
            (last, _) => {
                let all = checks.into_iter().chain(last);
                Test::All(all.map(|check| Test::At(path.clone(), check)).collect())
            }
        })
    }

    fn checks(&mut self, node: Node<'_>, at: &At<'_>) -> Option<Vec<Check>> {
        const CHECKS: [&str; 7] = [
            "equals",
            "one_of",
            "matches",
            "min",
            "max",
            "min_length",
            "max_length",
        ];
        match node.kind() {
            NodeKind::Scalar(scalar) => Some(vec![match scalar.text {
                "present" => Check::Present,
                "absent" => Check::Absent,
                _ => Check::OneOf(vec![self.value(node, at)?]),
            }]),
            NodeKind::Mapping(entries) => {
                let mut checks = Vec::new();
                for entry in entries {
                    let value = entry.value;
                    checks.push(match entry.name() {
                        "equals" => Check::OneOf(vec![self.value(value, at)?]),
                        "one_of" => {
                            let values = value.items().map(|it| self.value(it, at));
                            Check::OneOf(values.collect::<Option<_>>()?)
                        }
                        "matches" => Check::Matches(self.pattern(value)?),
                        "min" => Check::Min(self.number(value)?),
                        "max" => Check::Max(self.number(value)?),
                        "min_length" => Check::MinLength(self.length(value)?),
                        "max_length" => Check::MaxLength(self.length(value)?),
                        _ => {
                            self.unknown(entry.key, &text!("判断方式", "test"), CHECKS.into_iter());
                            return None;
                        }
                    });
                }
                Some(checks)
            }
            NodeKind::Sequence(_) | NodeKind::Null => {
                let advice = text!(
                    "请写 `present`、`absent`、一个值，或 `{{ one_of: [ … ] }}` 等",
                    "write `present`, `absent`, a value, or `{{ one_of: [ … ] }}` and the like"
                );
                self.fault(
                    node.span(),
                    text!("这里没有判断", "this asks nothing"),
                    advice,
                );
                None
            }
        }
    }

    /// A value as the dump has it: a word where there are words to choose from.
    fn value(&mut self, node: Node<'_>, at: &At<'_>) -> Option<Value> {
        let Some(scalar) = node.as_scalar() else {
            let advice = text!(
                "请写文本、数或布尔值",
                "write a text, a number or a truth value"
            );
            self.fault(
                node.span(),
                text!("这里应为单个值", "a single value is asked for"),
                advice,
            );
            return None;
        };
        let words = at.words();
        if !words.is_empty() && !words.contains(&scalar.text) {
            self.unknown(node, &text!("值", "value"), words.into_iter());
            return None;
        }
        Some(match scalar.style {
            Style::Plain => match (scalar::bool(node), scalar::number(node)) {
                (Some(truth), _) => Value::Bool(truth),
                // An integer or a fraction always serializes.
                (_, Some(number)) => serde_json::to_value(number).unwrap_or_default(),
                _ => Value::String(scalar.text.to_owned()),
            },
            Style::Quoted | Style::Block => Value::String(scalar.text.to_owned()),
        })
    }

    fn pattern(&mut self, node: Node<'_>) -> Option<Regex> {
        let text = node.as_str().unwrap_or_default();
        match Regex::new(&format!("^(?:{text})$")) {
            Ok(pattern) => Some(pattern),
            Err(error) => {
                let error = error.to_string();
                let message = text!(
                    "不是正则表达式：{error}",
                    "this is not a regular expression: {error}"
                );
                let advice = text!("它要与整个文本匹配", "it is matched against the whole text");
                self.fault(node.span(), message, advice);
                None
            }
        }
    }

    fn number(&mut self, node: Node<'_>) -> Option<f64> {
        let number = scalar::number(node).map(|number| number.to_f64());
        if number.is_none() {
            let advice = text!(
                "例如 `3`、`0.5` 或 `0x0A00`",
                "such as `3`, `0.5` or `0x0A00`"
            );
            self.fault(
                node.span(),
                text!("这里应为数", "a number is wanted here"),
                advice,
            );
        }
        number
    }

    fn length(&mut self, node: Node<'_>) -> Option<usize> {
        let length = scalar::int(node).and_then(|length| usize::try_from(length).ok());
        if length.is_none() {
            let message = text!("这里应为长度", "a length is wanted here");
            self.fault(node.span(), message, text!("例如 `3`", "such as `3`"));
        }
        length
    }
}

fn missing(key: &str) -> Text {
    text!("规则缺少 `{key}`", "`{key}` is missing from this rule")
}
