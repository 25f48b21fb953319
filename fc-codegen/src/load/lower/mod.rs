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
use crate::model::{Answer, AnswerKind, Location, Subject};
use crate::syntax::{Node, Sources, Span};

/// Makes the draft of all sections.
pub(super) fn lower<'a>(sections: &[Section<'a>], sources: &Sources) -> Draft<'a> {
    let mut lowering = Lowering {
        draft: Draft::default(),
        sources,
        group: None,
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
    draft
}

/// The draft as far as it is made.
struct Lowering<'a, 's> {
    draft: Draft<'a>,
    sources: &'s Sources,
    /// Group of the file that is being lowered.
    group: Option<String>,
}

impl<'a> Lowering<'a, '_> {
    fn section(&mut self, section: &Section<'a>) {
        let place = section.place;
        let entries = || {
            place.node.entries().map(|entry| Place {
                key: entry.key,
                node: entry.value,
            })
        };
        match section.name {
            "group" => self.group(place),
            "commands" => entries().for_each(|place| self.command(place)),
            "reports" => entries().for_each(|place| self.report(place)),
            "streams" => entries().for_each(|place| self.stream(place)),
            "types" => entries().for_each(|place| self.type_def(place)),
            "tables" => entries().for_each(|place| self.table(place)),
            "conflicts" => entries().for_each(|place| self.conflict(place)),
            "sections" => {
                entries().for_each(|place| self.retained_section(place));
                self.draft.sections_known = section.clean;
            }
            "changes" => self.draft.changes = text::changes(Some(place.node)),
            // What lies below the messages is checked as a whole, which makes no sense where it is broken.
            _ if !section.clean => {}
            "protocol" => self.protocol(place),
            "transport" => self.transport(place),
            "frame" => self.frame(place),
            "envelope" => self.envelope(place),
            "results" => self.results(place),
            "calls" => self.calls(place),
            "ack" => self.default_ack(place),
            "limits" => self.limits(place),
            "codes" => self.codes(place),
            _ => {}
        }
    }

    fn location(&self, span: Span) -> Location {
        Location {
            file: self.sources.path(span).to_owned(),
            line: self.sources.line(span),
        }
    }

    /// Keeps the entries of `answers:`.
    fn answers(&mut self, node: Node<'a>, subject: &Subject) {
        for node in node.get("answers").into_iter().flat_map(Node::items) {
            let kind = match node.get("as").and_then(Node::as_str) {
                Some("decision") => AnswerKind::Decision,
                Some("quirk") => AnswerKind::Quirk,
                Some("note") => AnswerKind::Note,
                Some("question") => AnswerKind::Question,
                _ => continue,
            };
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
