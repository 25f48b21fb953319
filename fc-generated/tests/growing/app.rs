//! An app that builds messages and takes them apart, written before they had more keys.

#![allow(missing_docs, reason = "a test")]

use fc_generated::{
    AnyReport, Client, Colour, ColourFields, LevelChanged, LevelChangedFields, Phase,
    SetLevelRequest, SetLevelRequestData, SetLevelRequestDataFields,
};
use fc_runtime::{CallError, Message, RawReport};

fn request() -> SetLevelRequest {
    let colour = Colour::new(ColourFields { red: 1, green: 2 }).with_gamma(0.5);
    let mut data = SetLevelRequestData::new(SetLevelRequestDataFields {
        level: 40,
        ratio: 0.25,
        armed: true,
        title: "lamp".to_owned(),
        serial: "AB".to_owned(),
        colours: vec![colour],
        phase: Phase::Burning,
    })
    .with_old(7);
    data.level = 41;
    SetLevelRequest::new(data)
}

/// Sets the level. Returns `true` if the response has data without a goal.
async fn light(client: &Client) -> Result<bool, CallError> {
    let response = client.set_level(&request()).await?;
    Ok(response.data.is_some_and(|data| data.goal.is_none()))
}

fn level(report: AnyReport) -> Option<i32> {
    match report {
        AnyReport::LevelChanged(LevelChanged { level, .. }) => Some(level),
        _ => None,
    }
}

fn changed() -> LevelChanged {
    LevelChanged::new(LevelChangedFields {
        level: 3,
        pace: Phase::from(4),
        sudden: false,
        reason: String::new(),
        glow: 2,
    })
}

#[test]
fn messages_are_made_and_taken_apart() {
    let _ = light;
    assert_eq!(request().check(), Ok(()));
    assert_eq!(
        request().data.colours.first().map(|colour| colour.green),
        Some(2)
    );
    assert_eq!(level(AnyReport::LevelChanged(changed())), Some(3));
    let raw = RawReport {
        code: 0,
        id: 0,
        text: Vec::new(),
    };
    assert_eq!(level(AnyReport::Unknown(raw)), None);
}
