//! Every word that a decoder must know has a vector: the specs of the tests use it, and one of their vectors shows it.
//! Otherwise decoders could differ although every test passes.

use crate::docs_support::{fixture, model, project};
use fc_codegen::emit::vectors;
use fc_codegen::target::Targets;
use fc_spec::model::{
    Argument, Condition, Constraints, Field, HeaderQuirk, HeaderRole, Model, Quirk, TypeShape,
    WireForm,
};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;

/// A spec that no owner edits, and the content of its vectors.
struct Shown {
    model: Model,
    /// Cases of accepted vectors, such as `quirk_note_null`.
    accepted: Vec<String>,
    /// Error and case of refused vectors, such as `bad_length` and `request_bad_length_note_long`.
    rejected: Vec<(String, String)>,
}

fn shown() -> Vec<Shown> {
    let tests = project().join("fc-generated/tests");
    let roots = ["meter", "beacon", "odd"].map(|name| tests.join(name));
    let roots = roots.into_iter().chain([fixture()]);
    roots
        .map(|root| {
            let model = model(&root);
            let mut accepted = Vec::new();
            let mut rejected = Vec::new();
            for artifact in vectors::emit(&model, &Targets::default()) {
                let file: Value = serde_json::from_str(&artifact.contents).expect("JSON");
                let text =
                    |entry: &Value, key: &str| entry[key].as_str().unwrap_or_default().to_owned();
                let entries = |list: &str| file[list].as_array().cloned().unwrap_or_default();
                accepted.extend(entries("accepted").iter().map(|it| text(it, "case")));
                let refused = entries("rejected");
                rejected.extend(
                    refused
                        .iter()
                        .map(|it| (text(it, "error"), text(it, "name"))),
                );
            }
            Shown {
                model,
                accepted,
                rejected,
            }
        })
        .collect()
}

/// The vectors show every error that an operation declares, if responses can carry it.
#[test]
fn every_declared_error_is_shown() {
    let mut count = 0;
    for shown in shown() {
        let model = &shown.model;
        let is_sent = model.envelope.result_code().is_some();
        let errors = model.operations.iter().flat_map(|it| &it.errors);
        let mut expected: Vec<String> = errors
            .filter(|_| is_sent)
            .filter_map(|error| {
                let mut results = model.results.iter();
                let result = results.find(|result| result.code == error.code)?;
                Some(format!("error_{}", result.name))
            })
            .collect();
        let cases = shown
            .accepted
            .iter()
            .filter(|case| case.starts_with("error_"));
        let mut found: Vec<String> = cases.cloned().collect();
        expected.sort_unstable();
        found.sort_unstable();
        assert_eq!(found, expected, "{}", model.protocol.id);
        count += found.len();
    }
    assert!(count >= 5, "{count}");
}

impl Shown {
    fn fields(&self) -> impl Iterator<Item = &Field> {
        let structs = self.model.types.iter().filter_map(|ty| match &ty.shape {
            TypeShape::Struct(shape) => Some(&shape.fields),
            TypeShape::Enum(_) | TypeShape::OneOf(_) => None,
        });
        structs.flatten()
    }

    /// Returns `true` if a vector shows that this field accepts another form than the one that is sent.
    fn shows_a_form_of(&self, field: &Field) -> bool {
        let mut quirks = self.accepted.iter();
        quirks.any(|case| {
            case.starts_with("quirk_") && case.contains(&field.wire) && !case.contains("_also_")
        })
    }

    /// Returns `true` if a body is refused with this error because of this field.
    fn refuses(&self, field: &Field, error: &str, form: &str) -> bool {
        let end = format!("{}{form}", field.wire);
        let mut rejected = self.rejected.iter();
        rejected.any(|(name, case)| name == error && case.ends_with(&end))
    }
}

#[test]
fn each_error_of_a_frame_or_a_body_has_a_vector() {
    let text = fs::read_to_string(project().join("conformance/errors.json")).expect("the errors");
    let errors: Value = serde_json::from_str(&text).expect("JSON");
    let errors = errors["errors"].as_array().expect("a list");
    // A spec does not define the limits that a runtime sets itself.
    let of_the_wire = errors
        .iter()
        .filter(|it| it["where"] != "call" && it["own_limit"] != true);
    let names = of_the_wire.filter_map(|it| it["name"].as_str());
    let shown = shown();
    let rejected = shown.iter().flat_map(|it| &it.rejected);
    let rejected: BTreeSet<&str> = rejected.map(|(error, _)| error.as_str()).collect();
    let missing: Vec<_> = names.filter(|name| !rejected.contains(name)).collect();
    assert_eq!(missing, [""; 0]);
}

#[test]
fn each_quirk_of_a_field_has_a_vector() {
    let shown = shown();
    for quirk in Quirk::ALL {
        let is_shown = shown.iter().any(|it| {
            let mut fields = it.fields();
            fields.any(|field| field.details().quirks.contains(quirk) && it.shows_a_form_of(field))
        });
        assert!(is_shown, "{}", quirk.name());
    }
}

/// A body with the value in the plain form of its type is refused.
#[test]
fn each_wire_form_has_a_vector() {
    let shown = shown();
    for form in WireForm::ALL {
        let own = match form {
            WireForm::Plain => continue,
            WireForm::String => "_number",
            WireForm::Number => "_bool",
        };
        let is_shown = shown.iter().any(|it| {
            let mut fields = it.fields().filter(|field| field.wire_form == *form);
            fields.any(|field| it.refuses(field, "wrong_type", own))
        });
        assert!(is_shown, "{}", form.name());
    }
}

/// After the name of the field, a case names the value that breaks the constraint. New constraints use their own name.
#[test]
fn each_constraint_has_a_vector() {
    let forms = BTreeMap::from([
        ("min", "_below"),
        ("max", "_above"),
        ("length", "_long"),
        ("pattern", ""),
        ("only", "_other"),
    ]);
    let mut seen = BTreeSet::new();
    for it in &shown() {
        for field in it.fields() {
            for constraint in field.details().constraints.iter() {
                let name = constraint.name();
                let error = match constraint.argument() {
                    Argument::Number(_) | Argument::Values(_) => "out_of_range",
                    Argument::Range(..) => "bad_length",
                    Argument::Pattern(_) => "bad_pattern",
                };
                let form = forms.get(name).map(ToString::to_string);
                if it.refuses(field, error, &form.unwrap_or_else(|| format!("_{name}"))) {
                    seen.insert(name.to_owned());
                }
            }
        }
    }
    let all = serde_json::to_value(Constraints::default()).expect("JSON");
    let all = all.as_object().expect("the keys of all constraints");
    assert_eq!(seen, all.keys().cloned().collect());
}

/// A body whose field contradicts its condition is accepted. Vectors show a missing and an unexpected field, for both
/// kinds of conditions.
#[test]
fn each_condition_has_a_vector() {
    let mut seen = BTreeSet::new();
    for it in shown() {
        for field in it.fields().filter(|field| field.optional) {
            let word = match field.details().condition {
                Some(Condition::When(_)) => "when",
                Some(Condition::Unless(_)) => "unless",
                None => continue,
            };
            for way in ["missing", "unasked"] {
                let case = format!("condition_{}_{way}", field.wire);
                if it.accepted.contains(&case) {
                    seen.insert((word, way));
                }
            }
        }
    }
    let all = ["unless", "when"].map(|word| [(word, "missing"), (word, "unasked")]);
    assert_eq!(Vec::from_iter(seen), all.concat());
}

/// Frames of these specs show the effect of each role and quirk.
#[test]
fn each_role_and_quirk_of_a_header_is_in_a_spec() {
    let shown = shown();
    for role in HeaderRole::ALL {
        let is_there = shown.iter().any(|it| it.model.frame.field(*role).is_some());
        assert!(is_there, "{}", role.name());
    }
    for quirk in HeaderQuirk::ALL {
        let is_there = shown.iter().any(|it| it.model.frame.has_quirk(*quirk));
        assert!(is_there, "{}", quirk.name());
    }
}
