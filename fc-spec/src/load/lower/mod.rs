//! Lowers syntax trees to the draft.
//!
//! The shape check has already reported malformed parts. Lowering silently skips them or uses a neutral value, and
//! flags their dependents, so that no check reports them again.

mod available;
mod body;
mod needs;
mod operation;
mod text;
mod things;
mod types;
mod wire;

pub(super) use body::USUAL_OBJECT;
pub(super) use wire::envelope_type_fits;

use super::draft::{AnswerDraft, Draft, Origin};
use super::section::Section;
use crate::language::grammar::{
    ANSWER, Availability, CHANGE, COMMON, CONFIRMED, FILE, File, Kind, both_languages,
};
use crate::model::{Answer, Confirmation, Governed, Languages, Location, Subject};
use crate::names::is_conflict_id;
use crate::source::{Sources, Span};
use crate::syntax::{Entry, Node};
use std::collections::HashMap;

/// Makes the draft from all sections.
pub(super) fn lower<'a>(
    sections: &[Section<'a>],
    sources: &Sources,
    texts: Languages,
) -> Draft<'a> {
    let mut lowering = Lowering {
        draft: Draft {
            texts,
            ..Draft::default()
        },
        sources,
        group: None,
        entry: String::new(),
    };
    for section in sections {
        lowering.group = section.group.map(str::to_owned);
        lowering.section(section);
    }
    let mut draft = lowering.draft;
    for (index, ty) in draft.types.iter().enumerate() {
        draft.type_index.entry(ty.def.name.clone()).or_insert(index);
    }
    draft.answers.sort_by_key(|answer| answer.origin.key.span());
    name_answers(&mut draft);
    draft
}

/// Names each answer after its first id. Numbers the later answers of a file with the same first id. An answer without
/// ids keeps the name of the entry that contains it.
fn name_answers(draft: &mut Draft<'_>) {
    let mut taken: HashMap<(String, String), usize> = HashMap::new();
    for AnswerDraft { item, .. } in &mut draft.answers {
        let Some(id) = item.ids.first().cloned() else {
            continue;
        };
        let count = taken
            .entry((item.location.file.clone(), id.clone()))
            .and_modify(|count| *count += 1)
            .or_insert(1);
        item.location.name = match count {
            1 => id,
            _ => format!("{id}.{count}"),
        };
    }
}

/// The draft under construction. Methods in the file of each part lower that part.
struct Lowering<'a, 's> {
    draft: Draft<'a>,
    sources: &'s Sources,
    /// Group of the current file.
    group: Option<String>,
    /// Keys of the current entry, such as `commands.get_station`.
    entry: String,
}

/// The name of a section, and the method that lowers it or one of its entries.
type Lower<'a, S> = (&'static str, fn(&mut S, Origin<'a>));

impl<'a> Lowering<'a, '_> {
    fn section(&mut self, section: &Section<'a>) {
        let (name, origin) = (section.name, section.origin);
        let each: [Lower<'a, Self>; 7] = [
            (FILE.commands.name, Self::command),
            (FILE.reports.name, Self::report),
            (FILE.streams.name, Self::stream),
            (FILE.types.name, Self::type_def),
            (FILE.tables.name, Self::table),
            (FILE.conflicts.name, Self::conflict),
            (FILE.sections.name, Self::missing_section),
        ];
        let whatever: [Lower<'a, Self>; 3] = [
            (FILE.group.name, Self::group),
            (FILE.availability.name, Self::availability),
            (FILE.changes.name, Self::changes),
        ];
        // Later steps use the sections below the messages as a whole, so a malformed one is left out.
        let clean: [Lower<'a, Self>; 10] = [
            (FILE.protocol.name, Self::protocol),
            (FILE.transport.name, Self::transport),
            (FILE.frame.name, Self::frame),
            (FILE.json.name, Self::json),
            (FILE.envelope.name, Self::envelope),
            (FILE.results.name, Self::results),
            (FILE.calls.name, Self::calls),
            (FILE.ack.name, Self::default_ack),
            (FILE.limits.name, Self::limits),
            (FILE.codes.name, Self::codes),
        ];
        let is_read = |(key, _): &&Lower<'a, Self>| *key == name;
        let each = each.iter().chain(&Self::THINGS).find(is_read);
        let clean = clean.iter().filter(|_| section.clean);
        let whole = whatever.iter().chain(clean).find(is_read);
        if each.or(whole).is_some() {
            self.draft.references.extend(&section.references);
            if let Some(key) = File::TABLE.key(name) {
                self.declare(&key.kind, origin.node);
            }
        }
        if let Some((_, lower)) = each {
            for entry in origin.node.entries() {
                self.entry = format!("{name}.{}", entry.name());
                lower(self, Origin::from(entry));
            }
        }
        name.clone_into(&mut self.entry);
        if let Some((_, lower)) = whole {
            lower(self, origin);
        }
        if section.clean {
            self.draft.valid.insert(name, origin);
        } else {
            self.draft.invalid.insert(name);
        }
    }

    /// Records the named things that a section declares.
    fn declare(&mut self, kind: &'static Kind, node: Node<'a>) {
        match kind {
            Kind::Entries {
                key: Kind::Name | Kind::ConflictId | Kind::Text,
                value: Kind::Map(table),
                ..
            } => {
                let things = node.entries().map(|entry| (*table, Origin::from(entry)));
                self.draft.declared.extend(things);
            }
            Kind::Map(table) if table.name == Availability::NAME => {
                for entry in node.entries() {
                    if let Some(key) = table.key(entry.name()) {
                        self.declare(&key.kind, entry.value);
                    }
                }
            }
            _ => {}
        }
    }

    fn changes(&mut self, origin: Origin<'a>) {
        self.draft.changes = text::changes(origin.node.items());
    }

    fn location(&self, span: Span) -> Location {
        Location {
            file: self.sources.path(span).to_owned(),
            name: self.entry.clone(),
            line: self.sources.line(span),
        }
    }

    /// Lowers the entries of `answers:`.
    fn answers(&mut self, holder: Node<'a>, subject: &Subject) {
        for node in COMMON.answers.items(holder) {
            let Some(kind) = ANSWER.r#as.read(node) else {
                self.draft.broken_answers = true;
                continue;
            };
            let mut items = ANSWER.ids.items(node);
            let ids = ANSWER.ids.get(node);
            let about = ANSWER.about.of(node);
            let is_broken = ids.is_empty() && about.is_none();
            self.draft.broken_answers |=
                is_broken || items.any(|id| !id.as_str().is_some_and(is_conflict_id));
            let about = about.map(Node::entries).into_iter().flatten();
            let answer = Answer {
                ids,
                kind,
                text: both_languages(node),
                about: about.filter_map(governed).collect(),
                runtime: ANSWER.runtime.get(node),
                confirmed: ANSWER.confirmed.of(node).map(confirmation),
                subject: subject.clone(),
                location: self.location(node.span()),
            };
            self.draft.answers.push(AnswerDraft {
                item: answer,
                origin: Origin { key: node, node },
                holder,
            });
        }
    }
}

/// Lowers an entry of `about:`; `None` for a mapping or list, which has its own error.
fn governed(entry: Entry<'_>) -> Option<Governed> {
    Some(Governed {
        path: entry.key.as_str()?.to_owned(),
        meanwhile: entry.value.as_str()?.to_owned(),
    })
}

/// Lowers `confirmed:`.
fn confirmation(node: Node<'_>) -> Confirmation {
    Confirmation {
        by: CONFIRMED.by.get(node),
        date: CHANGE.date.get(node),
        reference: CONFIRMED.reference.read(node),
        reply: CONFIRMED.reply.read(node),
    }
}
