//! From syntax trees to the draft.
//!
//! Shape faults have been reported before: what is malformed is skipped or gets a neutral value here
//! without a word, and what depends on it is flagged so that no check complains a second time.

mod body;
mod operation;
mod text;
mod types;
mod wire;

pub(super) use body::value;
pub(super) use wire::envelope_type_fits;

use super::draft::{Draft, Place, Placed};
use super::section::Section;
use crate::model::{Answer, Location, Subject};
use crate::syntax::{Entry, Node, Sources, Span};
use std::collections::HashMap;

/// Makes the draft of all sections.
pub(super) fn lower<'a>(sections: &[Section<'a>], sources: &Sources) -> Draft<'a> {
    let mut lowering = Lowering {
        draft: Draft::default(),
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
    draft.answers.sort_by_key(|answer| answer.place.key.span());
    name_answers(&mut draft);
    draft
}

/// Names each answer after its first id, apart from others of its file that begin with the same.
fn name_answers(draft: &mut Draft<'_>) {
    let mut taken: HashMap<(String, String), usize> = HashMap::new();
    for Placed { item, .. } in &mut draft.answers {
        let id = item.ids.first().cloned().unwrap_or_default();
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

/// The draft as far as it is made.
struct Lowering<'a, 's> {
    draft: Draft<'a>,
    sources: &'s Sources,
    /// Group of the file that is being lowered.
    group: Option<String>,
    /// Keys of the entry that is being lowered: `commands.get_station`.
    entry: String,
}

impl<'a> Lowering<'a, '_> {
    fn section(&mut self, section: &Section<'a>) {
        let place = section.place;
        section.name.clone_into(&mut self.entry);
        match section.name {
            "group" => self.group(place),
            "commands" => self.entries(section, Self::command),
            "reports" => self.entries(section, Self::report),
            "streams" => self.entries(section, Self::stream),
            "types" => self.entries(section, Self::type_def),
            "tables" => self.entries(section, Self::table),
            "conflicts" => self.entries(section, Self::conflict),
            "sections" => {
                self.entries(section, Self::retained_section);
                self.draft.sections_known = section.clean;
            }
            "changes" => self.draft.changes = text::changes(Some(place.node)),
            // What lies below the messages is checked as a whole, which makes no sense where it is broken.
            _ if !section.clean => {}
            "protocol" => self.protocol(place),
            "transport" => self.transport(place),
            "frame" => self.frame(place),
            "json" => self.json(place),
            "envelope" => self.envelope(place),
            "results" => self.results(place),
            "calls" => self.calls(place),
            "ack" => self.default_ack(place),
            "limits" => self.limits(place),
            "codes" => self.codes(place),
            _ => {}
        }
    }

    /// Lowers each entry of a section.
    fn entries(&mut self, section: &Section<'a>, lower: fn(&mut Self, Place<'a>)) {
        for Entry { key, value: node } in section.place.node.entries() {
            self.entry = format!("{}.{}", section.name, key.as_str().unwrap_or_default());
            lower(self, Place { key, node });
        }
    }

    fn location(&self, span: Span) -> Location {
        Location {
            file: self.sources.path(span).to_owned(),
            name: self.entry.clone(),
            line: self.sources.line(span),
        }
    }

    /// Keeps the entries of `answers:`.
    fn answers(&mut self, node: Node<'a>, subject: &Subject) {
        for node in node.get("answers").into_iter().flat_map(Node::items) {
            let Some(kind) = wire::known(node, "as") else {
                self.draft.broken_answers = true;
                continue;
            };
            self.draft.broken_answers |= node.get("ids").is_none_or(|ids| {
                let mut ids = ids.items();
                ids.clone().next().is_none() || ids.any(|id| id.as_str().is_none())
            });
            let ids = node.get("ids").into_iter().flat_map(Node::items);
            let answer = Answer {
                ids: ids.filter_map(Node::as_str).map(str::to_owned).collect(),
                kind,
                text: text::text(node),
                subject: subject.clone(),
                location: self.location(node.span()),
            };
            self.draft.answers.push(Placed {
                item: answer,
                place: Place { key: node, node },
            });
        }
    }
}
