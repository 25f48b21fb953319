//! A message as a struct literal. A new key would break it, so it does not compile in the first place.

#![allow(missing_docs, reason = "a test")]

use fc_generated::{LevelChanged, Phase};

#[test]
fn a_literal_names_every_key() {
    let report = LevelChanged {
        level: 3,
        actor: None,
        pace: Phase::from(4),
        sudden: false,
        rest: None,
        blink: None,
        reason: String::new(),
        glow: 2,
        extra: fc_runtime::Extra::new(),
    };
    assert_eq!(report.level, 3);
}
