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

use super::project_rules::{HouseRule, SETTINGS};
use super::rule::{Category, Level, Rule};
use crate::diagnostic::{Diagnostic, FaultCode, Faults, nearest};
use crate::language::grammar::{
    Form as _, HOUSE_RULE, HouseRule as RuleForm, LINT, Lint, List, PROJECT,
};
use crate::load::check_kind;
use crate::model::{Languages, Text};
use crate::project::languages;
use crate::source::{Sources, Span};
use crate::syntax::{Node, parse, read_files};
use crate::text;
use std::collections::HashMap;
use std::path::Path;

/// The levels and the rules of the project.
#[derive(Debug, Default)]
pub struct Settings {
    /// The key is the code of a rule, the name of a category, or the id of a rule of the project.
    levels: HashMap<String, Level>,
    house: Vec<HouseRule>,
}

impl Settings {
    /// Returns the rules of the project.
    pub(super) fn house(&self) -> &[HouseRule] {
        &self.house
    }

    /// Returns the level of a finding.
    ///
    /// The id of a rule of the project comes first, then the code, the category and the category that contains it. Without a setting, the
    /// level is the default of the rule.
    #[must_use]
    pub fn level(&self, rule: &Rule, house: Option<&str>) -> Level {
        let own = house.and_then(|id| self.levels.get(id));
        let categories = std::iter::successors(Some(rule.category), |it| it.within());
        let keys = std::iter::once(rule.code.number);
        let mut keys = keys.chain(categories.map(Category::name));
        let said = own.or_else(|| keys.find_map(|key| self.levels.get(key)));
        let usual = || {
            let house = house.and_then(|id| self.house.iter().find(|rule| rule.id == id));
            house.map_or(rule.level, |house| house.level)
        };
        said.copied().unwrap_or_else(usual)
    }
}

/// Reads the key `lint` of `fc.yaml`, at `file` below `root`, and the rule files that it lists.
///
/// Returns the defaults if the file or the key is missing. Adds an error for each invalid setting; its place refers to the returned
/// sources.
pub fn settings(root: &Path, file: &str, faults: &mut Faults) -> (Settings, Sources) {
    let mut sources = Sources::new();
    if root.join(file).symlink_metadata().is_err() {
        return (Settings::default(), sources);
    }
    let mut reader = Reader {
        settings: Settings::default(),
        texts: Languages::All,
        levels: Vec::new(),
        ids: HashMap::new(),
        faults,
    };
    // A rule file cannot list other files, so one pass is enough.
    for file in read(root, file, &mut sources, &mut reader, true) {
        read(root, &file, &mut sources, &mut reader, false);
    }
    reader.check_levels();
    (reader.settings, sources)
}

/// Reads a file and returns the files that it lists.
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
        let advice = text!(
            "改正 `house` 中的文件名",
            "correct the file name under `house`"
        );
        let fault = error(Span::point(id, 0), message).note(advice);
        reader.faults.push(fault);
        return Vec::new();
    }
    let Some(tree) = parse(id, &source.text, reader.faults) else {
        return Vec::new();
    };
    let root = tree.root();
    if !is_first {
        let kind = List::<RuleForm>::KIND;
        check_kind(&kind, root, root.span(), reader.texts, reader.faults);
        return reader.house(root);
    }
    if let Some(texts) = languages(PROJECT.languages, root) {
        reader.texts = texts;
    }
    let Some(lint) = PROJECT.lint.entry(root).filter(|it| !it.value.is_null()) else {
        return Vec::new();
    };
    let at = lint.key.span();
    check_kind(&Lint::KIND, lint.value, at, reader.texts, reader.faults);
    reader.levels(lint.value);
    let house = LINT.house.of(lint.value);
    house.map(|it| reader.house(it)).unwrap_or_default()
}

pub(super) struct Reader<'f> {
    settings: Settings,
    /// The languages that each text requires.
    texts: Languages,
    /// The keys of `levels` with their places.
    levels: Vec<(String, Span)>,
    /// The place of each rule of the project, by its id.
    ids: HashMap<String, Span>,
    pub(super) faults: &'f mut Faults,
}

impl Reader<'_> {
    /// Adds an error. Returns `None` for the setting.
    pub(super) fn fault<T>(&mut self, span: Span, message: Text, advice: Text) -> Option<T> {
        self.faults.push(error(span, message).note(advice));
        None
    }

    /// Adds an error for a word that is not in `words`. Returns `None` for the setting.
    pub(super) fn unknown<'w, T>(
        &mut self,
        node: Node<'_>,
        what: &Text,
        words: impl Iterator<Item = &'w str> + Clone,
    ) -> Option<T> {
        let word = node.as_str().unwrap_or_default();
        let message = text!(
            "没有{what} `{word}`",
            "there is no {what} `{word}`",
            what = what
        );
        let fault = error(node.span(), message);
        self.faults
            .push(if let Some(near) = nearest(word, words.clone()) {
                fault.fix(node.span(), near, meant(near))
            } else {
                let words: Vec<_> = words.map(|word| format!("`{word}`")).collect();
                let (zh, en) = (words.join("、"), words.join(", "));
                fault.note(text!("可以写：{zh}", "expected one of {en}"))
            });
        None
    }

    fn levels(&mut self, lint: Node<'_>) {
        for entry in LINT.levels.get(lint) {
            if let Some(level) = entry.value.as_str().and_then(Level::named) {
                let name = entry.name();
                let rule = Rule::parse(name).map(|rule| rule.code.number);
                self.levels.push((name.to_owned(), entry.key.span()));
                let key = rule.unwrap_or(name).to_owned();
                self.settings.levels.insert(key, level);
            }
        }
    }

    /// Checks that every key of `levels` names a rule or a category. The caller has read all rules of the project before.
    fn check_levels(&mut self) {
        let categories = Category::ALL.iter().map(|category| category.name());
        let house: Vec<String> = self.settings.house.iter().map(|it| it.id.clone()).collect();
        for (name, span) in &self.levels {
            let is_known = Rule::parse(name).is_some()
                || categories.clone().any(|it| it == name)
                || house.iter().any(|it| it == name);
            if is_known {
                continue;
            }
            let rules = Rule::all().flat_map(|rule| [rule.code.number, rule.name]);
            let known = categories.clone().chain(rules);
            let known = known.chain(house.iter().map(String::as_str));
            let message = text!(
                "没有规则或类别 `{name}`",
                "there is no rule and no category `{name}`"
            );
            let fault = error(*span, message);
            self.faults.push(match nearest(name, known) {
                Some(near) => fault.fix(*span, near, meant(near)),
                None => fault.note(text!(
                    "`fcproto explain` 列出全部规则",
                    "`fcproto explain` lists the rules"
                )),
            });
        }
    }

    /// Reads the list of rules and returns the files that it names.
    fn house(&mut self, node: Node<'_>) -> Vec<String> {
        let mut files = Vec::new();
        for item in node.items() {
            if let Some(file) = item.as_str() {
                files.push(file.to_owned());
            } else if let Some(rule) = self.rule(item) {
                let span = HOUSE_RULE.id.of(item).map_or(item.span(), Node::span);
                if let Some(first) = self.ids.insert(rule.id.clone(), span) {
                    let message = text!(
                        "两条规则的 `id` 都是 `{id}`",
                        "two rules have the id `{id}`",
                        id = rule.id
                    );
                    let label = text!("第一次用在这里", "first used here");
                    self.faults.push(error(span, message).also(first, label));
                }
                self.settings.house.push(rule);
            }
        }
        files
    }
}

/// Returns an error in the settings.
pub(super) fn error(span: Span, message: Text) -> Diagnostic {
    Diagnostic::error(FaultCode::Lint(&SETTINGS.code), span, message)
}

pub(super) fn meant(near: &str) -> Text {
    text!("是否为 `{near}`？", "did you mean `{near}`?")
}
