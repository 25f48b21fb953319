//! Giving a thing another name.

use crate::item::meant;
use crate::snapshot::Snapshot;
use fc_codegen::check::check_trees;
use fc_spec::diagnostic::{Faults, Severity};
use fc_spec::model::Lang;
use fc_spec::source::{FileId, SourceFile, Span};
use gen_lsp_types::{PrepareRenamePlaceholder, WorkspaceEdit};
use std::collections::{BTreeMap, BTreeSet};

/// The words at an offset that can be another name, and the name there is.
#[must_use]
pub fn prepare_rename(
    snapshot: &Snapshot,
    at: (FileId, usize),
) -> Option<PrepareRenamePlaceholder> {
    let meant = meant(snapshot, at)?;
    let place = snapshot.places().get(&meant.item)?;
    let item = (&meant.item, place);
    let name = name(snapshot, &meant.item);
    fc_spec::rename::rename(snapshot.index(), item, &name)?;
    Some(PrepareRenamePlaceholder {
        range: snapshot.range(meant.span),
        placeholder: name,
    })
}

/// What a thing is called in code; of a field not its wire key.
fn name(snapshot: &Snapshot, item: &fc_spec::index::Item) -> String {
    let owner = item.owner.as_deref();
    let owner = owner.and_then(|owner| snapshot.known().analysis().types().named(owner));
    let field = owner.and_then(|owner| match &owner.shape {
        fc_spec::model::TypeShape::Struct(shape) => shape.field(&item.name),
        _ => None,
    });
    field.map_or(&item.name, |field| &field.name).clone()
}

/// What changes so that the thing at an offset is called otherwise.
///
/// # Errors
/// Why that cannot be, in the client's language: it has no name of its own, or the spec would have errors.
pub fn rename(
    snapshot: &Snapshot,
    at: (FileId, usize),
    new: &str,
) -> Result<WorkspaceEdit, String> {
    let lang = snapshot.settings.lang;
    let changes = meant(snapshot, at).and_then(|meant| {
        let place = snapshot.places().get(&meant.item)?;
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

/// What would be wrong after a change that is not wrong now.
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
    // By code: a fault that is there already may only call the thing by its new name.
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
