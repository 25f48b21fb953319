//! Changes that fix a fault.

use crate::diagnostics::diagnostic;
use crate::snapshot::Snapshot;
use fc_spec::diagnostic::Fix;
use fc_spec::model::Lang;
use gen_lsp_types::{CodeAction, CodeActionKind, Range, Uri};

/// The changes that fix the faults in a range of a file.
#[must_use]
pub fn actions(snapshot: &Snapshot, uri: &Uri, range: Range) -> Vec<CodeAction> {
    let Some((file, start)) = snapshot.offset(uri, range.start) else {
        return Vec::new();
    };
    let end = snapshot
        .offset(uri, range.end)
        .map_or(start, |(_, end)| end);
    let faults = snapshot.analysis().faults.iter().filter(|fault| {
        let span = fault.primary.span;
        span.file == file && span.start <= end && start <= span.end
    });
    let actions = faults.flat_map(|fault| {
        let is_only = fault.fixes.len() == 1;
        fault.fixes.iter().map(move |fix| CodeAction {
            title: title(snapshot, fix),
            kind: Some(CodeActionKind::QuickFix),
            diagnostics: Some(vec![diagnostic(snapshot, fault)]),
            is_preferred: Some(is_only),
            edit: Some(snapshot.edit([(fix.span, fix.replacement.clone())])),
            ..CodeAction::default()
        })
    });
    actions.collect()
}

/// Most of a text that a title shows.
const SHOWN: usize = 40;

fn title(snapshot: &Snapshot, fix: &Fix) -> String {
    let lang = snapshot.settings.lang;
    let old = shown(snapshot.sources().slice(fix.span));
    let new = shown(&fix.replacement);
    let what = match (old.is_empty(), new.is_empty()) {
        (_, true) => lang.pick("删除", "delete").to_owned() + &format!(" `{old}`"),
        (true, _) => lang.pick("插入", "insert").to_owned() + &format!(" `{new}`"),
        _ => match lang {
            Lang::En => format!("replace `{old}` with `{new}`"),
            Lang::Zh => format!("把 `{old}` 改为 `{new}`"),
        },
    };
    format!("{what}{}{}", lang.pick("：", ": "), lang.text(&fix.message))
}

/// On one line, and not too long.
fn shown(text: &str) -> String {
    let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    if line.chars().count() <= SHOWN {
        return line;
    }
    line.chars().take(SHOWN).chain(['…']).collect()
}
