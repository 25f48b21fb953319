//! Checks result codes.

use super::frame::check_each_once;
use super::names::check_distinct;
use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::language::grammar::{ERROR, FILE, OPERATION, RESULT};
use crate::load::draft::Draft;
use crate::model::ResultRole;
use crate::syntax::Node;
use crate::text;
use std::collections::HashMap;

/// Checks that the runtime has a result code for each response that it creates.
pub(super) fn check_roles(draft: &Draft<'_>, faults: &mut Faults) {
    let Some(&origin) = draft.valid.get(FILE.results.name) else {
        return;
    };
    let used = draft.results.iter();
    let used = used.filter_map(|it| Some((it.item.role?, it.origin.at(RESULT.role))));
    check_each_once(
        |_: ResultRole| true,
        used,
        origin.name(),
        &text!("结果码", "result code"),
        faults,
    );
}

/// Checks that result codes have different names.
pub(super) fn check_names(draft: &Draft<'_>, faults: &mut Faults) {
    let names = draft
        .results
        .iter()
        .map(|result| (result.item.name.as_str(), result.origin.at(RESULT.name)));
    check_distinct(&text!("结果码", "result codes"), names, faults);
}

/// Checks that an operation declares each error once.
pub(super) fn check_errors(draft: &Draft<'_>, faults: &mut Faults) {
    let at = |error| ERROR.code.of(error).unwrap_or(error);
    for operation in &draft.operations {
        let mut first: HashMap<i64, Node<'_>> = HashMap::new();
        for node in OPERATION.errors.items(operation.origin.node).map(at) {
            let Some(code) = ERROR.code.read_in_or_at(node) else {
                continue;
            };
            if let Some(earlier) = first.insert(code, node) {
                let message = text!(
                    "{code} 在这个列表中出现两次",
                    "{code} occurs twice in this list"
                );
                let fault = Diagnostic::error(FaultCode::DuplicateItem, node.span(), message);
                faults.push(fault.also(earlier.span(), text!("第一次在这里", "first here")));
            }
        }
    }
}
