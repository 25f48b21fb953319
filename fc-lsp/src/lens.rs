//! Code lenses: free codes, numbers of users, and breaks since the last release.

use crate::snapshot::Snapshot;
use fc_diff::Finding;
use fc_spec::index::{DefId, DefSite, Role, visit};
use fc_spec::model::{Lang, RangeUse};
use fc_spec::source::{FileId, Span};
use gen_lsp_types::{CodeLens, Command, Location};

/// The client command that shows references. Its arguments are the file, the position of the definition, and the places
/// that name it.
pub const SHOW_REFERENCES: &str = "fc.showReferences";

/// The contents of lenses that depend on a check.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Checked {
    /// The next free code of each group and use.
    codes: Vec<Option<u16>>,
    /// The breaks: the names they affect, and the message.
    breaks: Vec<(Vec<String>, String)>,
}

/// Returns the contents of lenses for the state that [`Snapshot::known`] returns.
pub fn checked(snapshot: &Snapshot) -> Checked {
    let known = snapshot.known();
    let uses = [RangeUse::Commands, RangeUse::Reports];
    let breaking = breaking(known.findings()).map(|finding| {
        let names = finding.new.iter().map(|spot| spot.name.clone());
        let message = snapshot.settings.lang.text(&finding.message);
        (names.collect(), message.to_owned())
    });
    let analysis = known.analysis();
    let files = analysis.groups().iter().map(|group| &group.location.file);
    let codes = files.flat_map(|file| uses.map(|usage| analysis.next_code(usage, file)));
    Checked {
        codes: codes.collect(),
        breaks: breaking.collect(),
    }
}

/// Returns all lenses of a file.
#[must_use]
pub fn lenses(snapshot: &Snapshot, file: FileId) -> Vec<CodeLens> {
    let mut lenses = free_codes(snapshot, file);
    for (item, place) in snapshot.definitions().in_file(file) {
        if is_declared(snapshot, item, place) {
            lenses.extend(users(snapshot, item, place));
        }
    }
    lenses.extend(breaks(snapshot, file));
    lenses.sort_by_key(|lens| lens.range.start);
    lenses
}

/// Returns the next free code, above the section for the next operation.
fn free_codes(snapshot: &Snapshot, file: FileId) -> Vec<CodeLens> {
    let mut lenses = Vec::new();
    let Some(tree) = snapshot.trees().tree(file) else {
        return lenses;
    };
    let lang = snapshot.settings.lang;
    let known = snapshot.known();
    visit(tree.root(), &mut |occurrence| {
        let usage = occurrence
            .operations()
            .filter(|_| occurrence.role == Role::Key);
        let path = snapshot.sources().path(occurrence.node.span());
        let code = usage.and_then(|usage: RangeUse| known.analysis().next_code(usage, path));
        if let Some(code) = code {
            let title = lang.pick("空闲的功能码", "free code");
            let lens = said(
                snapshot,
                occurrence.node.span(),
                format!("{title} 0x{code:04X}"),
                None,
            );
            lenses.push(lens);
        }
    });
    lenses
}

/// Returns `true` for an item with its own declaration. A type that an operation or field defines inline is not
/// declared.
fn is_declared(snapshot: &Snapshot, item: &DefId, place: &DefSite) -> bool {
    let key = snapshot.sources().slice(place.key);
    item.owner.is_none() && key == item.name
}

/// Returns a lens with the number of places that name an item. An item without users gets a lens only if it is a type.
fn users(snapshot: &Snapshot, item: &DefId, place: &DefSite) -> Option<CodeLens> {
    let uses = snapshot
        .references()
        .of(item)
        .map(|reference| reference.span);
    let places: Vec<Location> = uses.filter_map(|span| snapshot.location(span)).collect();
    if places.is_empty() && !item.is_type() {
        return None;
    }
    let title = match (snapshot.settings.lang, places.len()) {
        (Lang::En, 1) => "1 user".to_owned(),
        (Lang::En, many) => format!("{many} users"),
        (Lang::Zh, many) => format!("{many} 处使用"),
    };
    let mut lens = said(snapshot, place.key, title, None);
    let here = snapshot.location(place.key)?;
    if let Some(command) = lens
        .command
        .as_mut()
        .filter(|_| snapshot.settings.shows_references)
    {
        SHOW_REFERENCES.clone_into(&mut command.command);
        let arguments = [
            serde_json::to_value(&here.uri),
            serde_json::to_value(here.range.start),
            serde_json::to_value(&places),
        ];
        command.arguments = Some(arguments.into_iter().flatten().collect());
    }
    Some(lens)
}

/// Returns the breaks since the last release that are not waived, each above its operation or type.
fn breaks(snapshot: &Snapshot, file: FileId) -> Vec<CodeLens> {
    let Some(release) = snapshot.project.release() else {
        return Vec::new();
    };
    let lang = snapshot.settings.lang;
    let mut broken: Vec<(Span, Vec<&str>)> = Vec::new();
    for finding in breaking(snapshot.known().findings()) {
        let Some(key) = shown_at(snapshot, finding).filter(|key| key.file == file) else {
            continue;
        };
        let message = lang.text(&finding.message);
        match broken.iter_mut().find(|(known, _)| *known == key) {
            Some((_, messages)) => messages.push(message),
            None => broken.push((key, vec![message])),
        }
    }
    let title = lang.pick("不兼容", "breaks");
    let lenses = broken.into_iter().map(|(key, messages)| {
        let title = format!("{title} {}", release.name);
        said(snapshot, key, title, Some(messages.join("\n")))
    });
    lenses.collect()
}

fn breaking(findings: &[Finding]) -> impl Iterator<Item = &Finding> {
    let findings = findings.iter();
    findings.filter(|finding| finding.is_break() && finding.waived.is_none())
}

/// Returns the key of the operation or declared type that contains a finding.
fn shown_at(snapshot: &Snapshot, finding: &Finding) -> Option<Span> {
    let places = snapshot.definitions();
    let spot = finding.new.iter().find_map(|spot| spot.place(places))?;
    let around = places.in_file(spot.key.file).filter(|(item, place)| {
        (item.is_operation() || item.is_type()) && crate::item::holds(place, spot.key)
    });
    let largest = around.max_by_key(|(_, place)| place.whole.end - place.whole.start);
    Some(largest.map_or(spot.key, |(_, place)| place.key))
}

fn said(snapshot: &Snapshot, span: Span, title: String, tooltip: Option<String>) -> CodeLens {
    CodeLens {
        range: snapshot.range(span),
        command: Some(Command {
            title,
            tooltip,
            // Clients show a command without a name as plain text.
            command: String::new(),
            arguments: None,
        }),
        data: None,
    }
}
