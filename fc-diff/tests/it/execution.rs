//! Sends the frames of one version to the other and checks that the outcome agrees with the rules.
//!
//! Each message is sent as its example, and again with every value changed in many ways that the sender's version
//! allows. A deployment is broken if the receiver refuses a message, takes it for another one, loses a value or gives
//! it another name.

use crate::support::{base, edits, model};
use fc_diff::{Deployment, diff};
use fc_reflect::{About, Direction, Node, Packing, Reflector, Value, walk};
use fc_spec::model::{Kind, Model, Side, TypeShape};
use serde_json::{Value as Json, json};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

/// Rules whose breaks no frame shows, each with the reason.
const UNSEEN: [(&str, &str); 14] = [
    (
        "kind-or-direction-changed",
        "a frame does not know which end sends it",
    ),
    (
        "pattern-changed",
        "which texts match only one of two patterns is not decided: the rule says the worst",
    ),
    (
        "port-number-changed",
        "a frame does not know over which port it comes",
    ),
    (
        "operation-port-changed",
        "a frame does not know over which port it comes",
    ),
    ("limit-lowered", "no example is as large as a limit"),
    ("limit-raised", "no example is as large as a limit"),
    ("encoding-added", "who sends it is configured"),
    (
        "also-removed",
        "nobody sends a further key of his own accord",
    ),
    (
        "quirk-removed",
        "nobody sends what only a lenient receiver takes of his own accord",
    ),
    (
        "result-code-changed",
        "what a result means is known to the session, not to a frame",
    ),
    ("times-tightened", "a frame has no clock"),
    ("unit-changed", "a number does not tell its unit"),
    ("time-unit-changed", "a number does not tell its unit"),
    (
        "coordinates-changed",
        "a number does not tell where its axis begins",
    ),
];

/// A message as its sender's version writes it.
struct Sent {
    by: Side,
    bytes: Vec<u8>,
}

/// Returns values to put in place of a value.
fn others(value: &Json) -> Vec<Json> {
    match value {
        Json::Bool(_) => vec![json!(true), json!(false)],
        Json::Number(_) => [
            json!(0),
            json!(1),
            json!(3),
            json!(5),
            json!(6),
            json!(8),
            json!(9),
            json!(95),
            json!(100),
            json!(-1),
            json!(200),
            json!(300),
            json!(65536),
            json!(2_147_483_648_i64),
            json!(4_294_967_296_i64),
            json!(0.25),
            json!(1.5),
            json!(1e300),
        ]
        .into(),
        Json::String(_) => [
            "",
            "a",
            "AA",
            "123",
            "aaaaaa",
            "aaaaaaa",
            "AA==",
            "0.25",
            "7",
            "3000000000",
            "calm",
            "wild",
        ]
        .map(Json::from)
        .into(),
        Json::Array(items) => {
            let first = items.first().cloned();
            (0..5)
                .filter_map(|count| Some(vec![first.clone()?; count].into()))
                .chain([json!([])])
                .collect()
        }
        // Includes values for the choices of this spec.
        Json::Object(_) | Json::Null => vec![
            json!("a"),
            json!(1),
            json!({}),
            json!([]),
            json!({ "label": "a" }),
            json!({ "seconds": 5, "times": 2 }),
        ],
    }
}

/// Returns copies of a message, each with one value changed or left out.
fn changed(whole: &Json) -> Vec<Json> {
    fn places(value: &Json, path: &str, found: &mut Vec<String>) {
        match value {
            Json::Object(entries) => {
                for (key, value) in entries {
                    let path = format!("{path}/{}", key.replace('~', "~0").replace('/', "~1"));
                    found.push(path.clone());
                    places(value, &path, found);
                }
            }
            Json::Array(items) => {
                if let Some(first) = items.first() {
                    let path = format!("{path}/0");
                    found.push(path.clone());
                    places(first, &path, found);
                }
            }
            _ => {}
        }
    }
    let mut found = Vec::new();
    places(whole, "", &mut found);
    let mut all = vec![whole.clone()];
    for path in found {
        let value = whole.pointer(&path).expect("a place");
        for other in others(value) {
            let mut changed = whole.clone();
            *changed.pointer_mut(&path).expect("a place") = other;
            all.push(changed);
        }
        let (holder, key) = path.rsplit_once('/').expect("a parent");
        let mut less = whole.clone();
        if let Some(entries) = less.pointer_mut(holder).and_then(Json::as_object_mut) {
            entries.remove(key);
            all.push(less);
        }
    }
    all
}

/// Returns every message that a version sends.
fn sent(model: &Model) -> Vec<Sent> {
    let reflector = Reflector::new(model);
    let mut all = Vec::new();
    for operation in &model.operations {
        for direction in Direction::ALL {
            let Some(id) = reflector.id(operation, *direction, 7) else {
                continue;
            };
            let by = match (direction, operation.sender) {
                (Direction::Request, side) => side,
                (Direction::Response, Side::App) => Side::Robot,
                (Direction::Response, Side::Robot) => Side::App,
            };
            let data = reflector.samples().data(operation, *direction);
            let mut bytes = BTreeSet::new();
            for packing in [Packing::Plain, Packing::Gzip { level: 6 }] {
                bytes.extend(reflector.seal(id, &data, packing).ok());
            }
            if let Ok(whole) = serde_json::from_slice::<Json>(&data) {
                for message in changed(&whole) {
                    bytes.extend(
                        reflector
                            .encode(id, message.to_string().as_bytes(), Packing::Plain)
                            .ok(),
                    );
                }
            }
            all.extend(bytes.into_iter().map(|bytes| Sent { by, bytes }));
        }
    }
    all
}

/// Returns the name of a value if its type names its values.
fn named(node: &Node<'_>) -> Option<String> {
    match &node.value {
        Value::Enum { named, .. } => named.map(|value| value.name.clone()),
        Value::OneOf { variant, .. } => Some(variant.name.clone()),
        _ => None,
    }
}

/// Returns the known values of a message by their path: the name of the field, and the name of the value if it has one.
fn known(
    reflector: &Reflector<'_>,
    bytes: &[u8],
) -> Option<BTreeMap<String, (String, Option<String>)>> {
    let decoded = reflector.decode(bytes).ok()?;
    let mut found = BTreeMap::new();
    let Some(message) = decoded.message else {
        return Some(found);
    };
    let body = message.body.ok()?;
    walk(&body, &mut |path, node| {
        if let About::Field(field) = node.about {
            found.insert(path.to_owned(), (field.name.clone(), named(node)));
        } else if let About::Item = node.about {
            found.insert(path.to_owned(), (String::new(), named(node)));
        }
    });
    Some(found)
}

/// The names that a version has for fields, for values of enums and choices, and for operations.
struct Names {
    fields: BTreeSet<String>,
    values: BTreeSet<String>,
    operations: BTreeSet<String>,
}

impl Names {
    fn of(model: &Model) -> Self {
        let mut names = Self {
            fields: BTreeSet::new(),
            values: BTreeSet::new(),
            operations: model.operations.iter().map(|it| it.name.clone()).collect(),
        };
        for ty in &*model.types {
            match &ty.shape {
                TypeShape::Struct(it) => names
                    .fields
                    .extend(it.fields.iter().map(|it| it.name.clone())),
                TypeShape::Enum(it) => names
                    .values
                    .extend(it.values.iter().map(|it| it.name.clone())),
                TypeShape::OneOf(it) => names
                    .values
                    .extend(it.variants.iter().map(|it| it.name.clone())),
            }
        }
        names
    }
}

/// Describes how a receiver misunderstands a message; `None` if it understands what the sender means.
fn broken(from: &Reflector<'_>, to: &Reflector<'_>, names: &Names, bytes: &[u8]) -> Option<String> {
    let meant = from.frame(bytes).expect("its own frame");
    let operation = meant.operation.expect("its own operation");
    let decoded = match to.decode(bytes) {
        Ok(decoded) => decoded,
        Err(error) => return Some(format!("{}: {}", operation.name, error.name())),
    };
    match decoded.frame.operation {
        // A response that the receiver does not know gets no reply.
        None if meant.id.direction == Direction::Response => return None,
        None if names.operations.contains(&operation.name) => {
            return Some(format!("{}: not known by this code", operation.name));
        }
        // Receivers skip reports and streams that they do not know.
        None if operation.kind() != Kind::Command => return None,
        None => return Some(format!("{}: unknown", operation.name)),
        Some(other)
            if other.name != operation.name && names.operations.contains(&operation.name) =>
        {
            return Some(format!("{} is taken for {}", operation.name, other.name));
        }
        Some(_) => {}
    }
    if let Some(Err(error)) = decoded.message.map(|message| message.body) {
        return Some(format!(
            "{}: {} at {}",
            operation.name,
            error.kind().name(),
            error.path()
        ));
    }
    let sent = known(from, bytes).expect("its own message");
    let read = known(to, bytes)?;
    for (path, (field, value)) in sent {
        let same = read
            .get(&path)
            .or_else(|| read.values().find(|(name, _)| *name == field));
        match same {
            None if names.fields.contains(&field) => {
                return Some(format!("{}: {path} is lost", operation.name));
            }
            Some((_, other))
                if *other != value
                    && value.as_ref().is_some_and(|it| names.values.contains(it)) =>
            {
                return Some(format!(
                    "{}: {path} is {other:?} and not {value:?}",
                    operation.name
                ));
            }
            _ => {}
        }
    }
    None
}

#[test]
#[ignore = "takes long"]
fn the_rules_agree_with_real_frames() {
    let base = base();
    let old = model(&base).expect("the spec");
    let old_reflector = Reflector::new(&old);
    let (old_sent, old_names) = (sent(&old), Names::of(&old));
    let (mut pairs, mut agree, mut frames, mut wrong) = (0, 0, 0, String::new());
    for edit in edits().1 {
        let new = model(&edit.apply(&base)).expect("a spec");
        let new_reflector = Reflector::new(&new);
        let (new_sent, new_names) = (sent(&new), Names::of(&new));
        frames += old_sent.len() + new_sent.len();
        let mut seen: BTreeMap<Deployment, String> = BTreeMap::new();
        // Old senders at new receivers, then the reverse.
        for (sent, from, to, names, is_old) in [
            (&old_sent, &old_reflector, &new_reflector, &new_names, true),
            (&new_sent, &new_reflector, &old_reflector, &old_names, false),
        ] {
            for message in sent {
                let is_old_app = (message.by == Side::App) == is_old;
                let deployment = if is_old_app {
                    Deployment::OldAppNewRobot
                } else {
                    Deployment::NewAppOldRobot
                };
                if !seen.contains_key(&deployment)
                    && let Some(why) = broken(from, to, names, &message.bytes)
                {
                    seen.insert(deployment, why);
                }
            }
        }
        let turned: BTreeMap<Deployment, String> = seen
            .iter()
            .map(|(deployment, why)| match deployment {
                Deployment::OldAppNewRobot => (Deployment::NewAppOldRobot, why.clone()),
                Deployment::NewAppOldRobot => (Deployment::OldAppNewRobot, why.clone()),
            })
            .collect();
        for (way, found, seen) in [
            (">", diff(&old, &new), seen),
            ("<", diff(&new, &old), turned),
        ] {
            let is_seen = |name: &str| UNSEEN.iter().all(|(unseen, _)| *unseen != name);
            let (shown, hidden): (Vec<_>, Vec<_>) =
                found.iter().partition(|it| is_seen(it.rule.name));
            let all = |of: Vec<&fc_diff::Finding>| -> BTreeSet<Deployment> {
                of.iter().flat_map(|it| it.wire.clone()).collect()
            };
            let (said, hidden) = (all(shown), all(hidden));
            let seen_ones: BTreeSet<Deployment> = seen.keys().copied().collect();
            pairs += 1;
            // Frames may show a break of an `UNSEEN` rule, but need not.
            let holds = said.is_subset(&seen_ones)
                && seen_ones
                    .iter()
                    .all(|it| said.contains(it) || hidden.contains(it));
            if holds {
                agree += 1;
            } else {
                let _ = writeln!(
                    wrong,
                    "{way} {}: the rules say {said:?}, the frames {seen:?}",
                    edit.name
                );
            }
        }
    }
    println!("{agree} of {pairs} pairs agree, {frames} frames");
    print!("{wrong}");
    assert!(wrong.is_empty());
}
