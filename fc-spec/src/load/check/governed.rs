//! What answers govern: an open question keeps its facts as they are, a settled one does not.

use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::load::draft::Draft;
use crate::load::govern::{ABSENT, Found, Governed, governed, is_doubt};
use crate::load::grammar::ANSWER;
use crate::model::BodyState;
use crate::text;
use crate::vocabulary::Word as _;

/// An answer says what it answers.
pub(super) fn check_purpose(draft: &Draft<'_>, faults: &mut Faults) {
    for answer in &draft.answers {
        let node = answer.place.node;
        if ANSWER.ids.of(node).is_none() && ANSWER.about.of(node).is_none() {
            let message = text!(
                "答复没有写明针对什么",
                "the answer does not say what it answers"
            );
            faults.push(
                Diagnostic::error(FaultCode::AnswerToNothing, answer.place.name(), message).note(
                    text!(
                        "用 `ids:` 写明疑问，或用 `about:` 写明相关的内容",
                        "name a conflict in `ids:`, or what it is about in `about:`"
                    ),
                ),
            );
        }
    }
}

/// What an answer is about is there.
pub(super) fn check_paths(draft: &Draft<'_>, faults: &mut Faults) {
    for answer in &draft.answers {
        for governed in governed(draft, answer) {
            let (span, message, note) = match governed.found {
                Found::Nowhere(key) => (
                    governed.path.span(),
                    text!("这里没有 `{key}`", "there is no `{key}` here"),
                    text!(
                        "路径从答复所在的位置算起，由 YAML 中的键组成",
                        "a path begins where the answer stands; its keys are those of the YAML"
                    ),
                ),
                Found::Several(node) => (
                    governed.path.span(),
                    text!(
                        "`{path}` 不是单个的值，而是{found}",
                        "`{path}` is {found}, not a single value",
                        path = text(&governed),
                        found = node.describe()
                    ),
                    text!(
                        "写明需要负责人确认的那个值",
                        "name the value that the owner has to confirm"
                    ),
                ),
                Found::Fact(..)
                    if !BodyState::named(governed.meanwhile()).is_some_and(is_doubt) =>
                {
                    (
                        governed.meanwhile.span(),
                        text!(
                            "`{word}` 既不是 `inferred`，也不是 `open`",
                            "`{word}` is neither `inferred` nor `open`",
                            word = governed.meanwhile()
                        ),
                        text!(
                            "对功能码、影响和消息体，`about:` 写的是负责人答复之前的可靠程度",
                            "of a code, an effect or a body `about:` says the confidence before the owner's answer"
                        ),
                    )
                }
                _ => continue,
            };
            faults.push(Diagnostic::error(FaultCode::GovernsNothing, span, message).note(note));
        }
    }
}

/// What an open question is about is as the question says, and what a settled one is about no longer is.
pub(super) fn check_held(draft: &Draft<'_>, faults: &mut Faults) {
    for answer in &draft.answers {
        let name = match answer.item.ids.first() {
            Some(id) => text!("答复 {id} ", "{id}"),
            None => text!("答复", "the answer"),
        };
        for governed in governed(draft, answer) {
            let (path, before) = (text(&governed), governed.meanwhile());
            match &answer.item.confirmed {
                None if governed.is_as_before() == Some(false) => {
                    let message = text!(
                        "`{path}` 是 {now}，但{name}写的是 {before}，而且尚未确认",
                        "`{path}` is {now}, but {name} says {before} and is not confirmed",
                        now = now(&governed),
                        name = name
                    );
                    faults.push(
                        Diagnostic::error(FaultCode::GovernedFact, governed.path.span(), message)
                            .note(text!("`fcproto settle` 会写下负责人的答复和答复人；如果还没有人答复，就连同 `about:` 一起修改", "`fcproto settle` writes down the owner's answer and who gave it; if nobody has, change `about:` as well")),
                    );
                }
                Some(_) if governed.is_untouched() => {
                    let message = text!(
                        "{name}已经确认，但 `{path}` 仍然是 {now}",
                        "{name} is confirmed, but `{path}` is still {now}",
                        now = now(&governed),
                        name = name
                    );
                    let at = ANSWER.confirmed.entry(answer.place.node);
                    let at = at.map_or(governed.path.span(), |entry| entry.key.span());
                    faults.push(
                        Diagnostic::error(FaultCode::SettledButUntouched, at, message)
                            .also(governed.path.span(), text!("针对的是这里", "it is about this"))
                            .note(text!("写下负责人的答复；如果没有谈到它，就从 `about:` 中去掉", "write down what the owner said, or take it out of `about:` if they said nothing about it")),
                    );
                }
                _ => {}
            }
        }
    }
}

fn text<'a>(governed: &Governed<'a>) -> &'a str {
    governed.path.as_str().unwrap_or_default()
}

/// What is said of it now.
fn now<'a>(governed: &Governed<'a>) -> &'a str {
    match governed.found {
        Found::Fact(_, state, _) => state.name(),
        Found::Value(node) => node.as_str().unwrap_or_default(),
        Found::Absent(_) | Found::Several(_) | Found::Nowhere(_) => ABSENT,
    }
}
