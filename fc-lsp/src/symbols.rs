//! Symbols: the outline of a file, and search by name in the spec.

use crate::snapshot::Snapshot;
use fc_spec::index::{DefId, DefSite};
use fc_spec::source::{FileId, Span};
use gen_lsp_types::{BaseSymbolInformation, DocumentSymbol, SymbolKind, WorkspaceSymbol};
use std::collections::BTreeMap;

/// The maximum number of results of a search.
const FOUND: usize = 200;

/// Returns the definitions of a file as a tree.
#[must_use]
pub fn document_symbols(snapshot: &Snapshot, file: FileId) -> Vec<DocumentSymbol> {
    // If one key defines an operation or field and a type made from it, the operation or field wins.
    let mut own: BTreeMap<(usize, usize), (&DefId, &DefSite)> = BTreeMap::new();
    for (item, place) in snapshot.definitions().in_file(file) {
        // At the same key, the longer definition comes first and contains the shorter one.
        let key = (place.key.start, usize::MAX - place.whole.end);
        let known = own.entry(key).or_insert((item, place));
        if known.0.is_type() && !item.is_type() {
            *known = (item, place);
        }
    }
    let mut open: Vec<(usize, DocumentSymbol)> = Vec::new();
    let mut top = Vec::new();
    for (item, place) in own.into_values() {
        close(&mut open, &mut top, place.key.start);
        open.push((place.whole.end, symbol(snapshot, item, place)));
    }
    close(&mut open, &mut top, usize::MAX);
    top
}

/// Moves the symbols that end before `at` into their parents.
fn close(open: &mut Vec<(usize, DocumentSymbol)>, top: &mut Vec<DocumentSymbol>, at: usize) {
    while open.last().is_some_and(|(end, _)| *end <= at) {
        let Some((_, symbol)) = open.pop() else {
            return;
        };
        match open.last_mut() {
            Some((_, around)) => around.children.get_or_insert_default().push(symbol),
            None => top.push(symbol),
        }
    }
}

#[allow(deprecated, reason = "a field of the protocol's that has to be named")]
fn symbol(snapshot: &Snapshot, item: &DefId, place: &DefSite) -> DocumentSymbol {
    DocumentSymbol {
        name: item.name.clone(),
        detail: Some(item.kind.to_owned()),
        kind: kind(item),
        tags: None,
        deprecated: None,
        range: snapshot.range(place.whole),
        selection_range: snapshot.range(first_line(snapshot, place)),
        children: None,
    }
}

/// Returns the key of a definition. A list item has no key, so the first line represents it.
fn first_line(snapshot: &Snapshot, place: &DefSite) -> Span {
    let key = place.key;
    let text = snapshot.sources().slice(key);
    let line = text.lines().next().map_or(0, str::len);
    Span::new(key.file, key.start, key.start + line)
}

/// Returns the definitions whose names contain a text, in any case.
#[must_use]
pub fn workspace_symbols(snapshot: &Snapshot, query: &str) -> Vec<WorkspaceSymbol> {
    let query = query.to_lowercase();
    let places = snapshot.definitions().iter();
    let found = places.filter(|(item, _)| item.name.to_lowercase().contains(&query));
    let found = found.filter_map(|(item, place)| {
        let location = snapshot.location(first_line(snapshot, place))?;
        Some(WorkspaceSymbol {
            location: location.into(),
            data: None,
            base_symbol_information: BaseSymbolInformation {
                name: item.name.clone(),
                kind: kind(item),
                tags: None,
                container_name: item.owner.clone(),
            },
        })
    });
    found.take(FOUND).collect()
}

fn kind(item: &DefId) -> SymbolKind {
    if item.is_operation() {
        SymbolKind::Function
    } else if item.is_type() {
        SymbolKind::Struct
    } else if item.owner.is_some() {
        SymbolKind::Field
    } else {
        SymbolKind::Constant
    }
}
