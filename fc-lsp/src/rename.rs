//! Rename.

use crate::item::meant;
use crate::snapshot::Snapshot;
use fc_codegen::check::check_trees;
use fc_spec::diagnostic::{Faults, Severity};
use fc_spec::model::Lang;
use fc_spec::source::{FileId, SourceFile, Span};
use gen_lsp_types::{PrepareRenamePlaceholder, WorkspaceEdit};
use std::collections::{BTreeMap, BTreeSet};

/// Returns the renamable words at an offset, and their current name.
#[must_use]
pub fn prepare_rename(
    snapshot: &Snapshot,
    at: (FileId, usize),
) -> Option<PrepareRenamePlaceholder> {
    let meant = meant(snapshot, at)?;
    let place = snapshot.definitions().get(&meant.item)?;
    let item = (&meant.item, place);
    let name = name(snapshot, &meant.item);
    fc_spec::rename::rename(snapshot.index(), item, &name)?;
    Some(PrepareRenamePlaceholder {
        range: snapshot.range(meant.span),
        placeholder: name,
    })
}

/// Returns the name of an item in code. For a field this is not the wire key.
fn name(snapshot: &Snapshot, item: &fc_spec::index::DefId) -> String {
    let owner = item.owner.as_deref();
    let owner = owner.and_then(|owner| snapshot.known().analysis().types().named(owner));
    let field = owner.and_then(|owner| owner.shape.structure()?.field(&item.name));
    field.map_or(&item.name, |field| &field.name).clone()
}

/// Returns the edits that rename the item at an offset.
///
/// # Errors
/// A sentence in the client's language, if the item cannot be renamed or the new name would cause errors.
pub fn rename(
    snapshot: &Snapshot,
    at: (FileId, usize),
    new: &str,
) -> Result<WorkspaceEdit, String> {
    let lang = snapshot.settings.lang;
    let changes = meant(snapshot, at).and_then(|meant| {
        let place = snapshot.definitions().get(&meant.item)?;
        fc_spec::rename::rename(snapshot.index(), (&meant.item, place), new)
    });
    let changes = changes.ok_or_else(|| {
        lang.pick("这里没有可以重命名的内容", "nothing here can be renamed")
            .to_owned()
    })?;
    let worse = worse(snapshot, &changes);
    if worse.is_empty() {
        return Ok(snapshot.edit(changes));
    }
    let worse: Vec<_> = worse.into_iter().collect();
    Err(match lang {
        Lang::En => format!("the spec would have errors: {}", worse.join("; ")),
        Lang::Zh => format!("规范会出现错误：{}", worse.join("；")),
    })
}

/// Returns the errors that a change would add.
fn worse(snapshot: &Snapshot, changes: &[(Span, String)]) -> BTreeSet<String> {
    let mut sources = snapshot.sources().clone();
    for (id, file) in snapshot.sources().iter() {
        let mut own: Vec<_> = changes.iter().filter(|(span, _)| span.file == id).collect();
        if own.is_empty() {
            continue;
        }
        own.sort_by_key(|(span, _)| std::cmp::Reverse(span.start));
        let mut text = file.text.clone();
        for (span, new) in own {
            text.replace_range(span.start..span.end, new);
        }
        sources.replace(SourceFile::new(file.path.as_str(), text));
    }
    let trees = snapshot.trees().with(&sources);
    let mut faults = Faults::new();
    check_trees(
        &trees,
        &snapshot.project.targets.requirements(),
        &mut faults,
    );
    // Compares the number of errors per code, because a rename can change the messages of existing errors.
    let errors = |faults: &Faults| {
        let lang = snapshot.settings.lang;
        let mut errors: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        for fault in faults.iter().filter(|it| it.severity == Severity::Error) {
            let text = crate::diagnostics::text(fault, lang);
            let first = text.lines().next().unwrap_or_default();
            let texts = errors.entry(fault.code.to_string()).or_default();
            texts.insert(format!("{first} ({})", fault.code));
        }
        errors
    };
    let before = errors(&snapshot.analysis().faults);
    let mut worse = BTreeSet::new();
    for (code, after) in errors(&faults) {
        let before = before.get(&code).cloned().unwrap_or_default();
        if after.len() > before.len() {
            worse.extend(after.difference(&before).cloned());
        }
    }
    worse
}
