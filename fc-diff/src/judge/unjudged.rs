//! Reports all differences between two dumps that no rule has judged.

use super::{Account, ORDER, Path};
use crate::finding::Finding;
use crate::rules::UNJUDGED;
use crate::rules::process::DOCS;
use fc_spec::model::{Dump, Model};
use serde_json::{Map, Value};
use std::collections::BTreeMap;

/// Keys that are derived from other parts of the spec, or are not about the protocol.
const DERIVED: [&str; 4] = ["place", "edit", "format", "waivers"];
/// Lists in the order of the files. Their order has no meaning.
const AS_WRITTEN: [&str; 6] = [
    "answers",
    "questions",
    "conflicts",
    "types",
    "groups",
    "operations",
];
/// The list of questions. The group of a question follows from its subject.
const OF_QUESTIONS: &str = "questions";
/// The maximum number of characters of a value that a finding shows.
const MAX_CHARACTERS: usize = 60;

/// Returns every difference that no claimed path covers.
pub(super) fn unjudged(old: &Model, new: &Model, account: &Account) -> Vec<Finding> {
    let dump = |model: &Model| serde_json::to_value(Dump::from(model)).unwrap_or_default();
    let mut walk = Walk {
        account,
        found: Vec::new(),
    };
    walk.compare(&mut Path::new(), &dump(old), &dump(new));
    walk.found
}

struct Walk<'a> {
    account: &'a Account,
    found: Vec<Finding>,
}

impl Walk<'_> {
    fn compare(&mut self, path: &mut Path, old: &Value, new: &Value) {
        if old == new || self.is_judged(path) {
            return;
        }
        match (old, new) {
            (Value::Object(old), Value::Object(new)) => self.objects(path, old, new),
            (Value::Array(old), Value::Array(new)) => {
                let key = key(path);
                match (by_id(old, key), by_id(new, key)) {
                    (Some(old), Some(new)) => self.lists(path, old, &new),
                    _ => self.differ(path, &Value::Array(old.clone()), &Value::Array(new.clone())),
                }
            }
            _ => self.differ(path, old, new),
        }
    }

    fn objects(&mut self, path: &mut Path, old: &Map<String, Value>, new: &Map<String, Value>) {
        let texts = ["zh", "en"].map(|lang| old.get(lang) != new.get(lang));
        let keys = old
            .keys()
            .chain(new.keys().filter(|key| !old.contains_key(*key)));
        let is_question = path.first().is_some_and(|list| list == OF_QUESTIONS);
        let is_derived = |key: &str| DERIVED.contains(&key) || (is_question && key == "group");
        for key in keys.filter(|key| !is_derived(key)) {
            let (one, other) = (old.get(key), new.get(key));
            let (one, other) = (one.unwrap_or(&Value::Null), other.unwrap_or(&Value::Null));
            path.push(key.clone());
            let is_stale = (key == "zh" || key == "en") && texts[0] != texts[1];
            if is_stale && one != other && !self.is_judged(path) {
                let values = [&*shown(one), &*shown(other)];
                self.found.push(Finding::new(&DOCS, path.join("."), values));
            } else {
                self.compare(path, one, other);
            }
            path.pop();
        }
    }

    fn lists(&mut self, path: &mut Path, mut old: List<'_>, new: &List<'_>) {
        if let Some(names) = self.account.renames.get(path) {
            for (id, _) in &mut old {
                if let Some(name) = names.get(id) {
                    id.clone_from(name);
                }
            }
        }
        let (before, now): (BTreeMap<_, _>, BTreeMap<_, _>) = (
            old.iter().map(|(id, item)| (id.as_str(), *item)).collect(),
            new.iter().map(|(id, item)| (id.as_str(), *item)).collect(),
        );
        let in_both = |list: &List<'_>| -> Vec<String> {
            let ids = list.iter().map(|(id, _)| id);
            ids.filter(|id| before.contains_key(id.as_str()) && now.contains_key(id.as_str()))
                .cloned()
                .collect()
        };
        let (one, other) = (in_both(&old), in_both(new));
        let is_written = path
            .last()
            .is_some_and(|list| AS_WRITTEN.contains(&list.as_str()));
        if one != other && !is_written {
            path.push(ORDER.to_owned());
            self.differ(path, &one.into(), &other.into());
            path.pop();
        }
        let ids = before
            .keys()
            .chain(now.keys().filter(|id| !before.contains_key(*id)));
        for id in ids {
            path.push((*id).to_owned());
            match (before.get(id), now.get(id)) {
                (Some(old), Some(new)) => self.compare(path, old, new),
                (old, new) => {
                    let of = |item: Option<&&Value>| item.map_or(Value::Null, |_| Value::from(*id));
                    self.differ(path, &of(old), &of(new));
                }
            }
            path.pop();
        }
    }

    fn differ(&mut self, path: &Path, old: &Value, new: &Value) {
        if !self.is_judged(path) {
            let values = [&*shown(old), &*shown(new)];
            self.found
                .push(Finding::new(&UNJUDGED, path.join("."), values));
        }
    }

    fn is_judged(&self, path: &Path) -> bool {
        let mut above = (1..=path.len()).filter_map(|length| path.get(..length));
        above.any(|it| self.account.claims.contains(it))
    }
}

type List<'v> = Vec<(String, &'v Value)>;

/// Returns the keys that identify the items of a list.
fn key(path: &Path) -> &'static [&'static str] {
    let list = path.last().map(String::as_str).unwrap_or_default();
    match list {
        "header" | "request" | "response" => &["wire"],
        "fields" => &["path"],
        "ports" => &["role"],
        "kinds" | "encodings" => &["value"],
        "errors" | "result_codes" | "retired_codes" => &["code"],
        "ranges" => &["from"],
        "lost_sections" => &["section"],
        "answers" => &["subject", "kind", "ids", "zh"],
        "changes" => &["date", "zh"],
        _ => &["name", "id"],
    }
}

/// Returns the items by their ids, or `None` if an item has no unique id.
fn by_id<'v>(items: &'v [Value], keys: &[&str]) -> Option<List<'v>> {
    let mut list = List::new();
    for item in items {
        let parts = keys.iter().filter_map(|key| item.get(key));
        let parts = parts.filter(|part| !part.is_null());
        let parts = parts.map(|part| {
            part.as_str()
                .map_or_else(|| part.to_string(), str::to_owned)
        });
        let id = parts.collect::<Vec<_>>().join(" ");
        if id.is_empty() || list.iter().any(|(known, _)| *known == id) {
            return None;
        }
        list.push((id, item));
    }
    Some(list)
}

/// Returns a value, cut to [`MAX_CHARACTERS`] characters. Null becomes an empty string.
fn shown(value: &Value) -> String {
    let text = match value {
        Value::Null => return String::new(),
        Value::String(text) => text.clone(),
        value => value.to_string(),
    };
    match text.char_indices().nth(MAX_CHARACTERS) {
        Some((end, _)) => format!("{}…", text.get(..end).unwrap_or_default()),
        None => text,
    }
}
