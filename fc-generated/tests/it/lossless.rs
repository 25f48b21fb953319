//! The lossless law: reading and writing a message keeps everything that a peer sends, including keys of a later spec.
//!
//! The test generates arbitrary values of every message type, with unknown keys and enum values. Reading and writing
//! one changes nothing, and a second pass changes not even a byte.

use crate::support::arbitrary::{Arbitrary, Random};
use crate::support::{self, TYPES, Type};
use fc_generated::AnyReport;
use fc_generated::descriptors::OPERATIONS;
use fc_reflect::sample::Samples;
use fc_runtime::RawReport;
use proptest::prelude::*;
use serde_json::Value;
use std::sync::LazyLock;

static MODEL: LazyLock<fc_spec::model::Model> = LazyLock::new(|| support::model(&support::root()));

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn reading_and_writing_changes_nothing(seed: u64) {
        let arbitrary = Arbitrary::new(Samples::new(&MODEL));
        let mut random = Random(seed);
        for ty in TYPES {
            let sent = arbitrary.value(definition(ty.name), &mut random).to_string();
            let written = transcode(ty, &sent);
            let (before, after) = (parse(&sent), parse(&written));
            prop_assert!(same(&before, &after), "{}\nsent    {sent}\nwritten {written}", ty.name);
            prop_assert_eq!(transcode(ty, &written), written, "{}", ty.name);
        }
    }
}

/// Returns the definition of a type of the spec, by its name.
fn definition(name: &str) -> &'static fc_spec::model::TypeDef {
    MODEL.types.named(name).expect("it is of the spec")
}

/// The text has numbers that no Rust type represents, white space, and escapes.
#[test]
fn the_value_of_an_unknown_key_keeps_its_text() {
    let samples = Samples::new(&MODEL);
    let kept = r#"[1.00, 1E+2, 123456789012345678901234567890, -0, "\u7ad9\/"]"#;
    for ty in TYPES {
        let example = samples
            .named(definition(ty.name), fc_reflect::sample::Profile::Example)
            .to_string();
        let inner = example.trim_start_matches('{').trim_end_matches('}');
        let comma = if inner.is_empty() { "" } else { "," };
        let open = example.strip_suffix('}').unwrap();
        let written = transcode(
            ty,
            &format!(r#"{open}{comma}"key of a later spec":{kept}}}"#),
        );
        assert!(written.contains(kept), "{}: {written}", ty.name);
    }
}

#[test]
fn a_report_of_an_unknown_code_is_kept() {
    let code = (0..=u16::MAX)
        .find(|code| {
            OPERATIONS
                .iter()
                .all(|operation| operation.code != Some(*code))
        })
        .expect("some code is free");
    let raw = RawReport {
        code,
        id: 1,
        text: b"{ \"a\": 1.00 }".to_vec(),
    };
    // The name of the variant depends on the names of the reports.
    let kept = format!("{:?}", AnyReport::from_raw(raw.clone()).unwrap());
    assert!(kept.ends_with(&format!("({raw:?})")), "{kept}");
}

#[test]
fn every_type_of_the_spec_is_covered() {
    use fc_spec::model::TypeShape;
    let structs = MODEL
        .types
        .iter()
        .filter(|ty| matches!(ty.shape, TypeShape::Struct(_)));
    let named: Vec<&str> = structs.map(|ty| ty.name.as_str()).collect();
    let covered: Vec<&str> = TYPES.iter().map(|ty| ty.name).collect();
    assert_eq!(covered, named);
}

fn transcode(ty: &Type, text: &str) -> String {
    match (ty.transcode)(text.as_bytes()) {
        Ok(written) => String::from_utf8(written).unwrap(),
        Err(error) => panic!("{} does not read {text}: {error}", ty.name),
    }
}

fn parse(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

/// Returns `true` if both are equal, except for the spelling of numbers in strings.
fn same(a: &Value, b: &Value) -> bool {
    match (a, b) {
        (Value::String(a), Value::String(b)) => {
            a == b
                || a.parse::<f64>()
                    .ok()
                    .zip(b.parse::<f64>().ok())
                    .is_some_and(|(a, b)| a.to_bits() == b.to_bits())
        }
        (Value::Array(a), Value::Array(b)) => {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same(a, b))
        }
        (Value::Object(a), Value::Object(b)) => {
            a.len() == b.len()
                && a.iter()
                    .all(|(key, a)| b.get(key).is_some_and(|b| same(a, b)))
        }
        (a, b) => a == b,
    }
}
