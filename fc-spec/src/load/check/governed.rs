//! What answers govern: an open question keeps its facts as they are, a settled one does not.

use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::load::draft::Draft;
use crate::load::govern::{ABSENT, Found, Governed, governed, is_doubt};
use crate::load::grammar::ANSWER;
use crate::model::BodyState;
use crate::vocabulary::Word as _;

/// An answer says what it answers.
pub(super) fn check_purpose(draft: &Draft<'_>, faults: &mut Faults) {
    for answer in &draft.answers {
        let node = answer.place.node;
        if ANSWER.ids.of(node).is_none() && ANSWER.about.of(node).is_none() {
            let message = "the answer does not say what it answers";
            faults.push(
                Diagnostic::error(FaultCode::AnswerToNothing, answer.place.name(), message)
                    .note("name a conflict in `ids:`, or what it is about in `about:`"),
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
                    format!("there is no `{key}` here"),
                    "a path begins where the answer stands; its keys are those of the YAML",
                ),
                Found::Several(node) => (
                    governed.path.span(),
                    format!(
                        "`{}` is {}, not a single value",
                        text(&governed),
                        node.describe()
                    ),
                    "name the value that the owner has to confirm",
                ),
                Found::Fact(..)
                    if !BodyState::named(governed.meanwhile()).is_some_and(is_doubt) =>
                {
                    (
                        governed.meanwhile.span(),
                        format!(
                            "`{}` is neither `inferred` nor `open`",
                            governed.meanwhile()
                        ),
                        "of a code, an effect or a body `about:` says the confidence before the owner's answer",
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
        let name = answer.item.ids.first().map_or("the answer", String::as_str);
        for governed in governed(draft, answer) {
            let (path, before) = (text(&governed), governed.meanwhile());
            match &answer.item.confirmed {
                None if governed.is_as_before() == Some(false) => {
                    let message = format!(
                        "`{path}` is {}, but {name} says {before} and is not confirmed",
                        now(&governed)
                    );
                    faults.push(
                        Diagnostic::error(FaultCode::GovernedFact, governed.path.span(), message)
                            .note("`fc settle` writes down the owner's answer and who gave it; if nobody has, change `about:` as well"),
                    );
                }
                Some(_) if governed.is_untouched() => {
                    let message = format!(
                        "{name} is confirmed, but `{path}` is still {}",
                        now(&governed)
                    );
                    let at = ANSWER.confirmed.entry(answer.place.node);
                    let at = at.map_or(governed.path.span(), |entry| entry.key.span());
                    faults.push(
                        Diagnostic::error(FaultCode::SettledButUntouched, at, message)
                            .also(governed.path.span(), "it is about this")
                            .note("write down what the owner said, or take it out of `about:` if they said nothing about it"),
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
