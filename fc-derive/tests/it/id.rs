//! Types with `#[derive(Id)]`, which are sent as their inner value.

use fc_derive::{Defaults, Id, Message, New};
use fc_runtime::json::{from_str, to_vec};
use fc_runtime::{Allowance, BodyError, Extra};
use std::collections::BTreeSet;

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Id)]
struct StationId(pub i64);

#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Id)]
struct PersonId(pub String);

#[derive(Clone, Debug, PartialEq, Message, New, Defaults)]
struct Tour {
    #[fc(key = "stationId", min = 1, max = 99)]
    station: StationId,
    #[fc(wire = "string", lenient(number), default = StationId(3))]
    next: Option<StationId>,
    #[fc(length = 0..=2)]
    others: Vec<StationId>,
    #[fc(length = 1..=4, pattern = "[a-z]+")]
    guide: Option<PersonId>,
    #[fc(extra)]
    extra: Extra,
}

/// The same with what the ids hold.
#[derive(Clone, Debug, PartialEq, Message)]
struct Plain {
    #[fc(key = "stationId", min = 1, max = 99)]
    station: i64,
    #[fc(wire = "string", lenient(number))]
    next: Option<i64>,
    #[fc(length = 0..=2)]
    others: Vec<i64>,
    #[fc(length = 1..=4, pattern = "[a-z]+")]
    guide: Option<String>,
    #[fc(extra)]
    extra: Extra,
}

fn read<T: fc_runtime::Message>(text: &str) -> Result<T, BodyError> {
    let message: T = from_str(text, Allowance::depth(4))?;
    message.check()?;
    Ok(message)
}

/// Sent and rejected values are the same as without ids, word for word.
#[test]
fn an_id_is_sent_as_its_value() {
    for text in [
        r#"{"stationId":7,"next":"4","others":[1,2],"guide":"anna","more":1}"#,
        r#"{"stationId":7,"next":4,"others":[]}"#,
        r#"{"stationId":7.0,"next":"0x1F","others":[-1]}"#,
        r#"{"stationId":0,"others":[]}"#,
        r#"{"stationId":100,"others":[]}"#,
        r#"{"stationId":"7","others":[]}"#,
        r#"{"stationId":7,"next":"seven","others":[]}"#,
        r#"{"stationId":7,"others":[1,2,3]}"#,
        r#"{"stationId":7,"others":[1,"2"]}"#,
        r#"{"stationId":7,"others":[],"guide":"annabel"}"#,
        r#"{"stationId":7,"others":[],"guide":"ANNA"}"#,
        r#"{"stationId":7,"others":[],"guide":5}"#,
        r#"{"stationId":9223372036854775808,"others":[]}"#,
        r#"{"others":[]}"#,
    ] {
        match (read::<Tour>(text), read::<Plain>(text)) {
            (Ok(tour), Ok(plain)) => assert_eq!(to_vec(&tour), to_vec(&plain), "{text}"),
            (Err(tour), Err(plain)) => assert_eq!(tour, plain, "{text}"),
            differing => panic!("{text}: {differing:?}"),
        }
    }
    let tour: Tour = read(r#"{"stationId":7,"next":"4","others":[1,2],"guide":"anna"}"#).unwrap();
    let expected = Tour::new(TourFields {
        station: StationId(7),
        others: vec![StationId(1), StationId(2)],
    })
    .with_next(StationId(4))
    .with_guide("anna".into());
    assert_eq!(tour, expected);
}

#[test]
fn an_id_is_shown_compared_and_taken_apart() {
    assert_eq!(StationId(-7).to_string(), "-7");
    assert_eq!(format!("{:>4}", StationId(7)), "   7");
    assert_eq!(format!("{:?}", StationId(7)), "StationId(7)");
    assert_eq!(PersonId::from("anna").to_string(), "anna");
    assert_eq!(StationId::from(7), StationId(7));
    assert_eq!(i64::from(StationId(7)), 7);
    assert_eq!(String::from(PersonId::from("anna".to_owned())), "anna");
    assert!(PersonId::from("anna").as_ref().starts_with('a'));
    let ids: BTreeSet<StationId> = [3, 1, 2].map(StationId).into();
    assert_eq!(
        ids.into_iter().map(i64::from).collect::<Vec<_>>(),
        [1, 2, 3]
    );
    let tour = Tour::new(TourFields {
        station: StationId(1),
        others: Vec::new(),
    });
    assert_eq!(tour.next_or_default(), StationId(3));
}
