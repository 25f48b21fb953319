//! The key `lint` of `fc.yaml`.
//!
//! ```yaml
//! lint:
//!   levels: { STANDARD: warning, FC0812: "off" }
//!   house:
//!     - rules/naming.yaml
//!     - id: motion-needs-precondition
//!       zh: 动作指令要写前置条件
//!       en: A motion says when it is accepted
//!       for: command
//!       where: { effect: motion }
//!       require: { accepted: present }
//! ```

use super::house::{GROUPS, HOUSE_RULE, HouseRule, SETTINGS};
use super::path::{At, Shape, kinds};
use super::predicate::{Check, Test};
use super::rule::{Category, Level, Rule};
use crate::diagnostic::{Diagnostic, FaultCode, Faults, nearest};
use crate::load::grammar::TEXT;
use crate::load::scalar;
use crate::model::Text;
use crate::syntax::{Node, NodeKind, Sources, Span, Style, parse, read_files};
use crate::text;
use regex_lite::Regex;
use serde_json::Value;
use std::collections::HashMap;
use std::path::Path;

/// The key of `fc.yaml`.
const LINT: &str = "lint";
const LEVELS: &str = "levels";
const HOUSE: &str = "house";

/// Most levels of `all`, `any` and `not` in one another.
const DEPTH: u8 = 16;

/// Levels, and the rules of the project.
#[derive(Debug, Default)]
pub struct Settings {
    /// By the code of a rule, the name of a category, or the id of a rule of the project.
    levels: HashMap<String, Level>,
    house: Vec<HouseRule>,
}

impl Settings {
    /// The rules of the project.
    pub(super) fn house(&self) -> &[HouseRule] {
        &self.house
    }

    /// What becomes of what a rule finds: by its code, or else its category, or else that which contains it.
    #[must_use]
    pub fn level(&self, rule: &Rule, house: Option<&str>) -> Level {
        let own = house.and_then(|id| self.levels.get(id));
        let mut category = Some(rule.category);
        let categories = std::iter::from_fn(|| {
            let this = category?;
            category = this.within();
            Some(this)
        });
        let said = own.or_else(|| self.levels.get(rule.code)).or_else(|| {
            categories
                .filter_map(|it| self.levels.get(it.name()))
                .next()
        });
        let usual = || {
            let house = house.and_then(|id| self.house.iter().find(|rule| rule.id == id));
            house.map_or(rule.level, |house| house.level)
        };
        said.copied().unwrap_or_else(usual)
    }
}

/// What `fc.yaml`, at `file` below `root`, and the files of rules that it names say; nothing where it says nothing of the lint. What
/// cannot be used is a fault, whose place is in the sources.
pub fn settings(root: &Path, file: &str, faults: &mut Faults) -> (Settings, Sources) {
    let mut sources = Sources::new();
    if !root.join(file).is_file() {
        return (Settings::default(), sources);
    }
    let mut reader = Reader {
        settings: Settings::default(),
        ids: HashMap::new(),
        faults,
    };
    let mut named = read(root, file, &mut sources, &mut reader, true);
    // A file names no others, so that this comes to an end.
    for file in named.drain(..) {
        read(root, &file, &mut sources, &mut reader, false);
    }
    reader.check_levels(&sources);
    let settings = reader.settings;
    (settings, sources)
}

/// Reads a file, and tells which others it names.
fn read(
    root: &Path,
    name: &str,
    sources: &mut Sources,
    reader: &mut Reader<'_>,
    is_first: bool,
) -> Vec<String> {
    let path = root.join(name);
    let mut unread = Faults::new();
    let files = read_files([(name.to_owned(), path.as_path())], &mut unread);
    let whole = unread.is_empty();
    let Some((_, source)) = files.iter().next() else {
        return Vec::new();
    };
    let id = sources.push(source.clone());
    if !whole {
        let message = text!("无法读取 `{name}`", "`{name}` cannot be read");
        let note = text!(
            "请改正 `{HOUSE}` 中的文件名",
            "correct its name under `{HOUSE}`"
        );
        reader.fault(Span::point(id, 0), message, note);
        return Vec::new();
    }
    let Some(tree) = parse(id, &source.text, reader.faults) else {
        return Vec::new();
    };
    if is_first {
        let lint = tree.root().get(LINT);
        lint.map(|lint| reader.lint(lint)).unwrap_or_default()
    } else {
        reader.house(tree.root())
    }
}

struct Reader<'f> {
    settings: Settings,
    /// Where each rule of the project is, and each level that names none of the rules known before.
    ids: HashMap<String, Span>,
    faults: &'f mut Faults,
}

impl Reader<'_> {
    fn fault(&mut self, span: Span, message: Text, note: Text) {
        let code = FaultCode::Lint(SETTINGS);
        self.faults
            .push(Diagnostic::error(code, span, message).note(note));
    }

    /// A word that is not one of those that may stand there.
    fn unknown<'w>(
        &mut self,
        node: Node<'_>,
        what: &Text,
        words: impl Iterator<Item = &'w str> + Clone,
    ) {
        let word = node.as_str().unwrap_or_default();
        let fault = Diagnostic::error(
            FaultCode::Lint(SETTINGS),
            node.span(),
            text!(
                "没有{what} `{word}`",
                "there is no {what} `{word}`",
                what = what
            ),
        );
        self.faults.push(match nearest(word, words.clone()) {
            Some(near) => fault.fix(node.span(), near, meant(near)),
            None => {
                let words: Vec<_> = words.map(|word| format!("`{word}`")).collect();
                let (zh, en) = (words.join("、"), words.join(", "));
                fault.note(text!("可用的有：{zh}", "it is one of {en}"))
            }
        });
    }

    /// What stands under `lint`, and the files that it names.
    fn lint(&mut self, node: Node<'_>) -> Vec<String> {
        let mut files = Vec::new();
        for entry in node.entries() {
            match entry.name() {
                LEVELS => self.levels(entry.value),
                HOUSE => files = self.house(entry.value),
                _ => self.unknown(entry.key, &text!("键", "key"), [LEVELS, HOUSE].into_iter()),
            }
        }
        if node.as_mapping().is_none() && !node.is_null() {
            let note = text!(
                "请在下面写 `{LEVELS}:` 或 `{HOUSE}:`",
                "write `{LEVELS}:` or `{HOUSE}:` below"
            );
            self.fault(
                node.span(),
                text!("这里没有设置", "these are no settings"),
                note,
            );
        }
        files
    }

    fn levels(&mut self, node: Node<'_>) {
        for entry in node.entries() {
            if let Some(level) = self.level(entry.value) {
                let name = entry.name();
                let rule = Rule::parse(name).map(|rule| rule.code);
                self.ids
                    .insert(format!("{LEVELS} {name}"), entry.key.span());
                let key = rule.unwrap_or(name).to_owned();
                self.settings.levels.insert(key, level);
            }
        }
    }

    fn level(&mut self, node: Node<'_>) -> Option<Level> {
        let levels = Level::ALL.iter();
        let found = levels
            .clone()
            .find(|level| node.as_str() == Some(level.name()));
        if found.is_none() {
            self.unknown(
                node,
                &text!("级别", "level"),
                levels.map(|level| level.name()),
            );
        }
        found.copied()
    }

    /// Every level is that of something. Asked when all rules of the project are known.
    fn check_levels(&mut self, sources: &Sources) {
        let categories = Category::ALL.iter().map(|category| category.name());
        let house: Vec<String> = self.settings.house.iter().map(|it| it.id.clone()).collect();
        let mut spans: Vec<Span> = self
            .ids
            .iter()
            .filter_map(|(key, span)| {
                let name = key.strip_prefix(LEVELS)?.trim_start();
                let is_known = Rule::parse(name).is_some()
                    || categories.clone().any(|it| it == name)
                    || house.iter().any(|it| it == name);
                (!is_known).then_some(*span)
            })
            .collect();
        spans.sort();
        for span in spans {
            let name = sources.slice(span).trim_matches(['"', '\'']);
            let rules = Rule::all().flat_map(|rule| [rule.code, rule.name]);
            let known = categories.clone().chain(rules);
            let known = known.chain(house.iter().map(String::as_str));
            let message = text!(
                "没有规则或类别 `{name}`",
                "there is no rule and no category `{name}`"
            );
            let fault = Diagnostic::error(FaultCode::Lint(SETTINGS), span, message);
            self.faults.push(match nearest(name, known) {
                Some(near) => fault.fix(span, near, meant(near)),
                None => fault.note(text!(
                    "`fc explain` 列出全部规则",
                    "`fc explain` lists the rules"
                )),
            });
        }
    }

    /// Rules, and the files that hold others.
    fn house(&mut self, node: Node<'_>) -> Vec<String> {
        let mut files = Vec::new();
        if node.as_sequence().is_none() && !node.is_null() {
            let note = text!(
                "每条规则前写短横线：`- id: …`",
                "write each rule behind a dash: `- id: …`"
            );
            let message = text!("项目的规则应为列表", "the rules of the project are a list");
            self.fault(node.span(), message, note);
        }
        for item in node.items() {
            if let Some(file) = item.as_str() {
                files.push(file.to_owned());
            } else if let Some(rule) = self.rule(item) {
                let span = item.get("id").map_or(item.span(), Node::span);
                if let Some(first) = self.ids.insert(rule.id.clone(), span) {
                    let message = text!(
                        "两条规则的 `id` 都是 `{id}`",
                        "two rules have the id `{id}`",
                        id = rule.id
                    );
                    let fault = Diagnostic::error(FaultCode::Lint(SETTINGS), span, message);
                    self.faults
                        .push(fault.also(first, text!("第一次用在这里", "first used here")));
                }
                self.settings.house.push(rule);
            }
        }
        files
    }

    fn rule(&mut self, node: Node<'_>) -> Option<HouseRule> {
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
                let note = text!(
                    "规则要有 `id`、`zh`、`en`、`for` 和 `require`",
                    "a rule has `id`, `zh`, `en`, `for` and `require`"
                );
                self.fault(
                    node.entries()
                        .next()
                        .map_or(node.span(), |it| it.key.span()),
                    message,
                    note,
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
            let note = text!(
                "请写明要求，例如 `require: {{ since: present }}`",
                "say what has to hold, such as `require: {{ since: present }}`"
            );
            self.fault(
                node.span(),
                text!("这条规则没有要求", "this rule requires nothing"),
                note,
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
            let note = text!(
                "请写明针对什么，例如 `for: command`",
                "say what it is about, such as `for: command`"
            );
            self.fault(node.span(), missing("for"), note);
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
            let note = text!(
                "请写明哪个路径应是什么，例如 `{{ effect: motion }}`",
                "write what is asked of which path: `{{ effect: motion }}`"
            );
            self.fault(
                node.span(),
                text!("判断应为映射", "a test is a mapping"),
                note,
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
            let note = text!("每项判断前写短横线", "write each test behind a dash");
            self.fault(
                node.span(),
                text!("`all` 和 `any` 下应为列表", "`all` and `any` take a list"),
                note,
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
                let note = text!(
                    "只能判断它有没有，以及长度：`min_length`、`max_length`",
                    "a rule can ask whether it is there, and for its length: `min_length`, `max_length`"
                );
                self.fault(
                    key.span(),
                    text!("`{list}` 是列表", "`{list}` is a list"),
                    note,
                );
                return None;
            }
            let message = text!(
                "`fc inspect` 的输出在这里没有键 `{part}`",
                "`fc inspect` prints no key `{part}` there"
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
                let note = text!(
                    "请写 `present`、`absent`、一个值，或 `{{ one_of: [ … ] }}` 等",
                    "write `present`, `absent`, a value, or `{{ one_of: [ … ] }}` and the like"
                );
                self.fault(
                    node.span(),
                    text!("这里没有判断", "this asks nothing"),
                    note,
                );
                None
            }
        }
    }

    /// A value as the dump has it: a word where there are words to choose from.
    fn value(&mut self, node: Node<'_>, at: &At<'_>) -> Option<Value> {
        let Some(scalar) = node.as_scalar() else {
            let note = text!(
                "请写文本、数或布尔值",
                "write a text, a number or a truth value"
            );
            self.fault(
                node.span(),
                text!("这里应为单个值", "a single value is asked for"),
                note,
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
                    "this is no regular expression: {error}"
                );
                let note = text!("它要与整个文本匹配", "it is matched against the whole text");
                self.fault(node.span(), message, note);
                None
            }
        }
    }

    fn number(&mut self, node: Node<'_>) -> Option<f64> {
        let number = scalar::number(node).map(|number| number.to_f64());
        if number.is_none() {
            let note = text!(
                "例如 `3`、`0.5` 或 `0x0A00`",
                "such as `3`, `0.5` or `0x0A00`"
            );
            self.fault(
                node.span(),
                text!("这里应为数", "a number is wanted here"),
                note,
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

fn meant(near: &str) -> Text {
    text!("是否为 `{near}`？", "did you mean `{near}`?")
}
