//! Completion of a call.

use crate::support::small;
use fc_workshop::complete::complete;

/// The words before, the word, and its completions.
const CASES: &[(&[&str], &str, &[&str])] = &[
    (&[], "set_", &["set_light"]),
    (&["--allow=config"], "set_", &["set_light"]),
    (&[], "dim", &[]),
    (&["set_light"], "l", &["lvl=", "lit="]),
    (
        &["set_light"],
        "spot.",
        &["spot.room=", "spot.floor=", "spot.x=", "spot.y="],
    ),
    (&["set_light", "lvl=1"], "tr", &["tree."]),
    (&["set_light"], "tree.ne", &["tree.next.0."]),
    (&["set_light"], "tree.next.0.le", &["tree.next.0.leaf="]),
    (&["set_light"], "on=", &["on=true", "on=false"]),
    (&["set_light"], "mode=n", &["mode=night"]),
    (&["set_light"], "lvl=", &[]),
    (&["set_light"], "other.", &[]),
    (&["nothing"], "l", &[]),
];

#[test]
fn words_of_a_call_are_completed() {
    let model = small();
    for (before, word, completions) in CASES {
        assert_eq!(
            complete(&model, before, word),
            *completions,
            "{before:?} {word}"
        );
    }
}
