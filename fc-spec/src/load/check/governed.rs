//! Checks the facts that answers cover: they change when the owner confirms the answer, and not before.

use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::language::grammar::ANSWER;
use crate::load::answer_scope::{ABSENT, CoveredFact, Found, covered_facts, is_doubt};
use crate::load::draft::Draft;
use crate::model::BodyState;
use crate::text;
use crate::vocabulary::Word as _;

/// Checks that an answer names a conflict or a fact.
pub(super) fn check_purpose(draft: &Draft<'_>, faults: &mut Faults) {
    for answer in &draft.answers {
        let node = answer.origin.node;
        if ANSWER.ids.of(node).is_none() && ANSWER.about.of(node).is_none() {
            let message = text!(
                "答复没有 `ids`，也没有 `about`",
                "the answer has neither `ids` nor `about`"
            );
            let span = answer.origin.name();
            let fault = Diagnostic::error(FaultCode::AnswerToNothing, span, message);
            faults.push(fault.note(text!(
                "在 `ids:` 中写明疑问，或在 `about:` 中写明涉及的内容",
                "name a conflict in `ids:`, or a fact in `about:`"
            )));
        }
    }
}

/// Checks that the paths in `about:` exist.
pub(super) fn check_paths(draft: &Draft<'_>, faults: &mut Faults) {
    for answer in &draft.answers {
        for covered in covered_facts(draft, answer) {
            let (span, message, note) = match covered.found {
                Found::Nowhere(key) => (
                    covered.path.span(),
                    text!("这里没有 `{key}`", "there is no `{key}` here"),
                    text!(
                        "从答复所在的位置开始，写出 YAML 中各级的键",
                        "write the keys of the YAML, starting at the place of the answer"
                    ),
                ),
                Found::Several(node) => (
                    covered.path.span(),
                    text!(
                        "`{path}` 应为单个的值，实际为{found}",
                        "expected a single value at `{path}`, found {found}",
                        path = text(&covered),
                        found = node.describe()
                    ),
                    text!(
                        "写出需要负责人确认的那个值的路径",
                        "name the value that the owner must confirm"
                    ),
                ),
                Found::Fact(..) if !BodyState::named(covered.meanwhile()).is_some_and(is_doubt) => {
                    (
                        covered.meanwhile.span(),
                        text!(
                            "应为 `inferred` 或 `open`，实际为 `{word}`",
                            "expected `inferred` or `open`, found `{word}`",
                            word = covered.meanwhile()
                        ),
                        text!(
                            "写负责人答复之前的可靠程度",
                            "write the confidence before the owner answered"
                        ),
                    )
                }
                _ => continue,
            };
            faults.push(Diagnostic::error(FaultCode::GovernsNothing, span, message).note(note));
        }
    }
}

/// Checks that facts of an open question match `about:`, and that facts of a settled one no longer wait for the owner.
pub(super) fn check_held(draft: &Draft<'_>, faults: &mut Faults) {
    for answer in &draft.answers {
        let name = match answer.item.ids.first() {
            Some(id) => text!("答复 {id} ", "{id}"),
            None => text!("答复", "the answer"),
        };
        for covered in covered_facts(draft, answer) {
            let (path, before) = (text(&covered), covered.meanwhile());
            match &answer.item.confirmed {
                None if covered.is_as_before() == Some(false) => {
                    let message = text!(
                        "`{path}` 应为 {before}，实际为 {now}；{name}尚未确认",
                        "`{path}` is {now}, but {name} expects {before} and is not confirmed",
                        now = now(&covered),
                        name = name
                    );
                    let span = covered.path.span();
                    let note = text!(
                        "用 `fcproto settle` 写入负责人的答复；还没有答复时，把 `about:` 一起修改",
                        "record the owner's answer with `fcproto settle`; without an answer, change `about:` as well"
                    );
                    let fault = Diagnostic::error(FaultCode::GovernedFact, span, message);
                    faults.push(fault.note(note));
                }
                Some(_) if covered.is_untouched() => {
                    let message = text!(
                        "{name}已经确认，但 `{path}` 仍然是 {now}",
                        "{name} is confirmed, but `{path}` is still {now}",
                        now = now(&covered),
                        name = name
                    );
                    let at = ANSWER.confirmed.entry(answer.origin.node);
                    let at = at.map_or(covered.path.span(), |entry| entry.key.span());
                    let note = text!(
                        "写入负责人的答复；答复没有涉及它时，从 `about:` 中去掉",
                        "write the owner's answer, or remove it from `about:` if the owner did not mention it"
                    );
                    let fault = Diagnostic::error(FaultCode::SettledButUntouched, at, message);
                    let fault = fault.also(covered.path.span(), text!("涉及的内容", "its fact"));
                    faults.push(fault.note(note));
                }
                _ => {}
            }
        }
    }
}

fn text<'a>(covered: &CoveredFact<'a>) -> &'a str {
    covered.path.as_str().unwrap_or_default()
}

/// Returns the current state or value of a fact.
fn now<'a>(covered: &CoveredFact<'a>) -> &'a str {
    match covered.found {
        Found::Fact(_, state, _) => state.name(),
        Found::Value(node) => node.as_str().unwrap_or_default(),
        Found::Absent(_) | Found::Several(_) | Found::Nowhere(_) => ABSENT,
    }
}
