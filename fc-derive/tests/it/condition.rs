//! Fields that are present only under conditions on other fields.

use fc_derive::{Message, New, OpenEnum};
use fc_runtime::condition::{Asked, Condition};
use fc_runtime::json::{from_str, to_vec};
use fc_runtime::{Allowance, ConditionError, ConditionErrorKind};

#[derive(Clone, Copy, Debug, PartialEq, OpenEnum)]
#[fc(repr = u8)]
enum Mode {
    #[fc(value = 1)]
    Still,
    #[fc(value = 2)]
    Driving,
    #[fc(other)]
    Other(u8),
}

#[derive(Clone, Debug, PartialEq, OpenEnum)]
#[fc(repr = str)]
enum Place {
    #[fc(value = "in")]
    Inside,
    #[fc(value = "out")]
    Outside,
    #[fc(other)]
    Other(String),
}

#[derive(Clone, Debug, PartialEq, Message, New)]
struct Order {
    #[fc(when(mode = 2 | 3, armed = true))]
    speed: Option<f64>,
    #[fc(key = "workMode")]
    mode: Mode,
    armed: bool,
    place: Place,
    #[fc(unless(place = "in", r#type = -1))]
    door: Option<String>,
    r#type: i8,
    #[fc(when(label = "x"))]
    lift: Option<Vec<u8>>,
    label: String,
}

fn order(mode: Mode) -> Order {
    Order::new(OrderFields {
        mode,
        armed: true,
        place: Place::Inside,
        r#type: -1,
        label: String::new(),
    })
}

fn fault(order: Order) -> Option<(&'static str, ConditionErrorKind)> {
    let error = order.checked().err();
    error.map(|error| (error.key(), error.kind()))
}

#[test]
fn a_message_is_checked_by_its_own_conditions() {
    use ConditionErrorKind::{Missing, Unasked};
    let still = order(Mode::Still);
    assert_eq!(still.clone().checked(), Ok(still.clone()));
    let driving = order(Mode::Driving);
    let other = order(Mode::from(3));
    let elsewhere = |place: Place| Order {
        place,
        ..still.clone()
    };
    for (order, expected) in [
        (still.clone().with_speed(1.0), Some(("speed", Unasked))),
        (driving.clone(), Some(("speed", Missing))),
        (driving.clone().with_speed(1.0), None),
        (other.clone(), Some(("speed", Missing))),
        (other.with_speed(1.0), None),
        // All that is asked must hold, with `unless` as well.
        (
            Order {
                armed: false,
                ..driving
            },
            None,
        ),
        (still.clone().with_door("left"), Some(("door", Unasked))),
        (elsewhere(Place::Outside), Some(("door", Missing))),
        (elsewhere(Place::Outside).with_door("left"), None),
        (elsewhere(Place::from("on")).with_door("left"), None),
        (
            Order {
                r#type: 1,
                ..still.clone()
            },
            Some(("door", Missing)),
        ),
        (
            Order {
                label: "x".to_owned(),
                ..still.clone()
            },
            Some(("lift", Missing)),
        ),
    ] {
        assert_eq!(fault(order.clone()), expected, "{order:?}");
    }
}

#[test]
fn an_error_names_wire_keys_and_values() {
    let error = order(Mode::Driving).checked().map_err(|error| {
        let said = error.to_string();
        (error, said)
    });
    let Err((error, said)) = error else {
        unreachable!("it is driving");
    };
    assert_eq!(
        said,
        "`speed` is missing: it is sent when `workMode` is 2 or 3 and `armed` is true"
    );
    let asked: &[Asked] = &[
        Asked {
            key: "workMode",
            values: &["2", "3"],
        },
        Asked {
            key: "armed",
            values: &["true"],
        },
    ];
    assert!(matches!(error.condition(), Condition::When(found) if found == asked));
    let error: Option<ConditionError> = order(Mode::Still).with_door("left").checked().err();
    assert_eq!(
        error.map(|error| error.to_string()).as_deref(),
        Some("`door` is not asked for: it is sent unless `place` is \"in\" and `type` is -1")
    );
}

/// Received messages are accepted unchanged, and sent again unchanged.
#[test]
fn reading_and_writing_ignore_conditions() {
    for text in [
        r#"{"speed":1.5,"workMode":1,"armed":true,"place":"in","type":-1,"label":""}"#,
        r#"{"workMode":2,"armed":true,"place":"out","type":0,"label":"x"}"#,
    ] {
        let order: Order = from_str(text, Allowance::DEFAULT).unwrap();
        assert_eq!(to_vec(&order), text.as_bytes());
        assert!(order.checked().is_err(), "{text}");
    }
}
