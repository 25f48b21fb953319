//! Sample messages follow the conditions of their fields.

use crate::docs_support::{fixture, model, project};
use fc_reflect::sample::{Profile, Samples};
use fc_spec::model::TypeShape;
use std::collections::BTreeSet;

#[test]
fn sample_has_a_field_if_its_condition_holds() {
    let profiles = [
        Profile::Example,
        Profile::Full,
        Profile::Minimal,
        Profile::Maximal,
    ];
    let mut seen = BTreeSet::new();
    for root in [fixture(), project().join("fc-generated/tests/meter")] {
        let model = model(&root);
        let samples = Samples::new(&model);
        for ty in &model.types {
            let TypeShape::Struct(shape) = &ty.shape else {
                continue;
            };
            for profile in profiles {
                let sample = samples.named(ty, profile);
                for field in shape.fields.iter().filter(|field| field.optional) {
                    let Some(condition) = &field.details().condition else {
                        continue;
                    };
                    let is_there = sample.get(&field.wire).is_some();
                    let holds = condition.holds(&sample);
                    assert_eq!(is_there, holds, "{}.{} {profile:?}", ty.name, field.wire);
                    seen.insert((format!("{profile:?}"), is_there));
                }
            }
        }
    }
    assert_eq!(seen.len(), 2 * profiles.len(), "{seen:?}");
}

/// A sample includes a required field even if its condition does not hold, because the field is always sent.
#[test]
fn a_required_field_is_always_there() {
    let model = model(&fixture());
    let samples = Samples::new(&model);
    let mut unasked = 0;
    for ty in &model.types {
        let TypeShape::Struct(shape) = &ty.shape else {
            continue;
        };
        let sample = samples.named(ty, Profile::Example);
        for field in shape.fields.iter().filter(|field| !field.optional) {
            if let Some(condition) = &field.details().condition {
                assert!(sample.get(&field.wire).is_some(), "{}", field.wire);
                unasked += usize::from(!condition.holds(&sample));
            }
        }
    }
    assert!(unasked > 0);
}
