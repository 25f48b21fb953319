//! Completion of keys, words, names and the next free code.
//!
//! A half-typed line breaks the grammar of the spec language, and usually YAML as well. So completion parses the file
//! with a placeholder word at the cursor. It tries the placeholder as a key and as a value, and closes open brackets.

use crate::language::{self, both, markdown};
use crate::snapshot::Snapshot;
use fc_spec::diagnostic::Faults;
use fc_spec::index::{Occurrence, OtherKey, occurrence_at};
use fc_spec::language::Word;
use fc_spec::source::{FileId, SourceFile, Span};
use fc_spec::syntax::parse;
use gen_lsp_types::{CompletionItem, CompletionItemKind, TextEdit};

/// The placeholder. No spec contains this word.
const WORD: &str = "zzz_here_zzz";

/// Returns the completion items at an offset.
#[must_use]
pub fn completion(snapshot: &Snapshot, (file, offset): (FileId, usize)) -> Vec<CompletionItem> {
    let Some(source) = snapshot.source(file).filter(|source| source.whole) else {
        return Vec::new();
    };
    let Some(typed) = Typed::at(source, offset) else {
        return Vec::new();
    };
    let replaced = Span::new(file, typed.start, typed.end);
    for text in typed.readings(source) {
        let Some(tree) = parse(file, &text, &mut Faults::new()) else {
            continue;
        };
        let Some(occurrence) = occurrence_at(tree.root(), typed.start) else {
            continue;
        };
        let completions = Completions {
            snapshot,
            replaced,
            items: Vec::new(),
        };
        let items = completions.collect(&occurrence);
        if !items.is_empty() {
            return items;
        }
    }
    Vec::new()
}

/// The word at the cursor, and the line around it.
struct Typed<'s> {
    start: usize,
    end: usize,
    before: &'s str,
    after: &'s str,
}

impl<'s> Typed<'s> {
    fn at(source: &'s SourceFile, offset: usize) -> Option<Self> {
        let line = source.line(offset);
        let (first, last) = source.lines(line, line)?;
        let (before, after) = (
            source.text.get(first..offset)?,
            source.text.get(offset..last)?,
        );
        let is_word = |c: char| c.is_alphanumeric() || "_%/²³·°℃Ω".contains(c);
        let start = before.trim_end_matches(is_word).len();
        let end = after.len() - after.trim_start_matches(is_word).len();
        Some(Self {
            start: first + start,
            end: offset + end,
            before: before.get(..start)?,
            after: after.get(end..)?,
        })
    }

    /// Returns the text of the file with the placeholder instead of the typed word, the more likely reading first.
    fn readings(&self, source: &SourceFile) -> Vec<String> {
        let Self { before, after, .. } = self;
        let in_key = {
            let part = before.rsplit(['{', '[', ',']).next().unwrap_or_default();
            let is_item = before.rfind('[') > before.rfind('{');
            !part.contains(':') && !is_item && !after.trim_start().starts_with(':')
        };
        let closing = closing(before, after);
        let value = format!("{WORD}{after}{closing}");
        let key = format!("{WORD}: ~{after}{closing}");
        let lines = if in_key { [key, value] } else { [value, key] };
        let head = source.text.get(..self.start).unwrap_or_default();
        let line = source.line(self.start);
        let tail = source
            .lines(line, line)
            .map_or(source.text.len(), |(_, end)| end);
        let tail = source.text.get(tail..).unwrap_or_default();
        let line = lines.into_iter();
        line.map(|line| [head, &line, tail].concat()).collect()
    }
}

/// Returns the brackets that close the open brackets of a line.
fn closing(before: &str, after: &str) -> String {
    let mut open = Vec::new();
    for c in before.chars().chain(after.chars()) {
        match c {
            '{' => open.push('}'),
            '[' => open.push(']'),
            '}' | ']' => {
                open.pop();
            }
            _ => {}
        }
    }
    let closing: String = open.into_iter().rev().collect();
    if closing.is_empty() {
        closing
    } else {
        format!(" {closing}")
    }
}

struct Completions<'s> {
    snapshot: &'s Snapshot,
    replaced: Span,
    items: Vec<CompletionItem>,
}

impl Completions<'_> {
    fn collect(mut self, occurrence: &Occurrence<'_>) -> Vec<CompletionItem> {
        let keys = occurrence.other_keys();
        let is_key = !keys.is_empty();
        for key in keys {
            self.key(key);
        }
        if is_key {
            return self.items;
        }
        let path = self.snapshot.sources().path(occurrence.node.span());
        if let Some(code) = occurrence
            .code_of()
            .and_then(|it| self.snapshot.known().analysis().next_code(it, path))
        {
            let lang = self.snapshot.settings.lang;
            let what = lang.pick("下一个空闲的功能码", "the next free code");
            let code = format!("0x{code:04X}");
            self.add(&code, CompletionItemKind::Value, what.to_owned(), None);
        }
        for kind in occurrence.names() {
            self.things(kind, occurrence);
        }
        for word in occurrence.words() {
            self.word(&word);
        }
        self.items
    }

    fn key(&mut self, key: OtherKey) {
        let lang = self.snapshot.settings.lang;
        let Some(known) = language::key(key.part, key.name) else {
            return;
        };
        let required = if known.required {
            lang.pick("必填", "required")
        } else {
            ""
        };
        let text = both(&known.text, lang);
        let kind = CompletionItemKind::Property;
        self.add(key.name, kind, required.to_owned(), Some(text));
        let after = if key.opens_lines { ":" } else { ": " };
        let new_text = key.name.to_owned() + after;
        let range = self.snapshot.range(self.replaced);
        // Required keys come first.
        let rank = if known.required { '0' } else { '1' };
        let rank = format!("{rank}{:03}", self.items.len());
        if let Some(item) = self.items.last_mut() {
            item.sort_text = Some(rank);
            item.text_edit = Some(TextEdit { range, new_text }.into());
        }
    }

    fn word(&mut self, word: &Word) {
        let lang = self.snapshot.settings.lang;
        let about = both(&word.text, lang);
        let detail = lang.text(&word.text).to_owned();
        let kind = CompletionItemKind::EnumMember;
        self.add(word.word, kind, detail, Some(about));
    }

    /// Adds the definitions of a kind. Enum values come from the enum at the cursor only.
    fn things(&mut self, kind: &str, occurrence: &Occurrence<'_>) {
        let lang = self.snapshot.settings.lang;
        let known = self.snapshot.known();
        let places = known.definitions().iter();
        let things: Vec<_> = places
            .filter(|(item, _)| item.kind == kind)
            .filter(|(item, _)| item.owner.is_none() || item.owner.as_deref() == occurrence.owner())
            .collect();
        for (item, place) in things {
            let title = known.title(item, place);
            let title = title.map_or(String::new(), |title| lang.text(&title).to_owned());
            self.add(&item.name, CompletionItemKind::Reference, title, None);
        }
    }

    fn add(&mut self, label: &str, kind: CompletionItemKind, detail: String, text: Option<String>) {
        let range = self.snapshot.range(self.replaced);
        let new_text = label.to_owned();
        let edit = TextEdit { range, new_text };
        self.items.push(CompletionItem {
            label: label.to_owned(),
            kind: Some(kind),
            detail: (!detail.is_empty()).then_some(detail),
            documentation: text.map(|text| markdown(text).into()),
            sort_text: Some(format!("{:03}", self.items.len())),
            text_edit: Some(edit.into()),
            ..CompletionItem::default()
        });
    }
}
