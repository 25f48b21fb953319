//! Code actions that fix errors.

use crate::diagnostics::diagnostic;
use crate::snapshot::Snapshot;
use fc_spec::diagnostic::Fix;
use fc_spec::fix::in_files;
use fc_spec::model::Lang;
use fc_spec::source::Span;
use gen_lsp_types::{CodeAction, CodeActionKind, Range, Uri};

/// Returns the changes that fix the errors in a range of a file. An error with several places gets one change for the
/// place in the range, and one for all places.
#[must_use]
pub fn actions(snapshot: &Snapshot, uri: &Uri, range: Range) -> Vec<CodeAction> {
    let Some((file, start)) = snapshot.offset(uri, range.start) else {
        return Vec::new();
    };
    let end = snapshot
        .offset(uri, range.end)
        .map_or(start, |(_, end)| end);
    let is_here = |span: &Span| span.file == file && span.start <= end && start <= span.end;
    let mut actions = Vec::new();
    for fault in &snapshot.analysis().faults {
        let is_only = fault.fixes.len() == 1;
        for fix in &fault.fixes {
            let here = fix.places().find(is_here);
            let here = here.or(is_here(&fault.primary.span).then_some(fix.span));
            let Some(here) = here else { continue };
            let change = |places: &[Span]| {
                let changes = places.iter().map(|span| (*span, fix.replacement.clone()));
                snapshot.edit(changes)
            };
            let action = CodeAction {
                title: title(snapshot, fix),
                kind: Some(CodeActionKind::QuickFix),
                diagnostics: Some(vec![diagnostic(snapshot, fault)]),
                is_preferred: Some(is_only),
                edit: Some(change(&[here])),
                ..CodeAction::default()
            };
            let places: Vec<Span> = fix.places().collect();
            let all = (places.len() > 1).then(|| CodeAction {
                title: everywhere(snapshot, &action.title, places.len()),
                is_preferred: Some(false),
                edit: Some(change(&places)),
                ..action.clone()
            });
            actions.push(action);
            actions.extend(all);
        }
    }
    actions
}

/// Returns one change with all fixes of a file that need no choice, or `None` without such a fix. Applying it can
/// reveal further errors.
#[must_use]
pub fn fix_all(snapshot: &Snapshot, uri: &Uri) -> Option<CodeAction> {
    let file = snapshot.file(uri)?;
    let certain = in_files(&snapshot.analysis().faults, snapshot.sources());
    let fixes = certain.get(&file)?.iter();
    let changes = fixes.map(|(_, fix)| (fix.span, fix.replacement.clone()));
    let lang = snapshot.settings.lang;
    let title = lang.pick("修复所有无需选择的错误", "fix all that leaves no choice");
    Some(CodeAction {
        title: title.to_owned(),
        kind: Some(CodeActionKind::SourceFixAll),
        edit: Some(snapshot.edit(changes)),
        ..CodeAction::default()
    })
}

fn everywhere(snapshot: &Snapshot, title: &str, places: usize) -> String {
    match snapshot.settings.lang {
        Lang::En => format!("at all {places} places: {title}"),
        Lang::Zh => format!("全部 {places} 处：{title}"),
    }
}

/// The maximum number of characters of a text that a title shows.
const MAX_CHARACTERS: usize = 40;

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

/// Returns the text on one line, cut to [`MAX_CHARACTERS`] characters.
fn shown(text: &str) -> String {
    let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    if line.chars().count() <= MAX_CHARACTERS {
        return line;
    }
    line.chars().take(MAX_CHARACTERS).chain(['…']).collect()
}
