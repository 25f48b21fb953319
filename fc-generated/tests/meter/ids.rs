//! The meter with a type for the ids of each entity. `tests/it/other_protocols.rs` runs this in a crate that is
//! generated with such types.

#![allow(missing_docs, reason = "tests")]

use fc_generated::{Band, Operator, OperatorId, SetTariffRequest, TariffId};
use fc_runtime::json::to_vec;
use fc_runtime::{Allowance, Message as _, json};

/// Ids occur alone, in a list, in a string and in an object.
#[test]
fn fields_hold_ids_of_their_entity() {
    let request = SetTariffRequest::new(Band::Day)
        .with_tariff(TariffId(12))
        .with_others(vec![TariffId(13), 14.into()]);
    let text = String::from_utf8(to_vec(&request)).unwrap();
    assert_eq!(text, r#"{"band":1,"tariff":"12","others":[13,14]}"#);
    let read: SetTariffRequest = json::from_str(&text, Allowance::depth(4)).unwrap();
    assert_eq!(read, request);
    assert_eq!(u32::from(read.tariff_or_default()), 12);
    assert_eq!(SetTariffRequest::DEFAULT_TARIFF, TariffId(7));
    // A constant cannot hold an id that is a string, so this default stays a string.
    assert_eq!(request.by_or_default(), "nobody");
    let operator = Operator::new(OperatorId::from("anna"));
    assert_eq!(operator.name.to_string(), "anna");
}

#[test]
fn constraints_of_ids_are_checked() {
    let request = SetTariffRequest::new(Band::Day).with_tariff(TariffId(0));
    assert!(request.check().is_err());
    assert!(Operator::new("annabella".into()).check().is_err());
}
