//! Dumps that the reader refuses.

use crate::good_spec;
use fc_codegen::inspect;
use fc_spec::model::{Dump, DumpError};
use serde_json::json;

/// Returns the error of a dump, or an empty string for a valid dump.
fn refused(text: &str) -> String {
    let error = Dump::read(text).err();
    error.map_or_else(String::new, |error| error.to_string())
}

/// Returns the item with this name in a list of the dump.
fn named<'d>(dump: &'d mut serde_json::Value, list: &str, name: &str) -> &'d mut serde_json::Value {
    let items = dump[list].as_array_mut().expect("a list");
    let item = items.iter_mut().find(|item| item["name"] == name);
    item.expect("it is there")
}

#[test]
fn invalid_dump_is_refused_with_a_reason() {
    let text = inspect::json(&good_spec::model());
    assert!(refused("[]").starts_with("not a dump of `fcproto inspect`: "));
    assert!(refused(&text[..text.len() / 2]).contains("EOF while parsing"));
    let other = text.replacen("\"format\": 3", "\"format\": 1", 1);
    assert!(matches!(Dump::read(&other), Err(DumpError::Format(1))));
    let role = text.replacen("\"role\": \"digest\"", "\"role\": \"hash\"", 1);
    assert!(refused(&role).contains("unknown variant `hash`"));
    let code = text.replacen("\"code_spelling\": \"0x", "\"code_spelling\": \"0xF", 1);
    assert!(refused(&code).contains("is not a code"));
    let spelled = "\"code_spelling\": \"";
    let start = text.find(spelled).expect("a code") + spelled.len();
    let mut code = text.clone();
    code.replace_range(start..start + 6, "0xFFFE");
    assert!(refused(&code).contains("does not match its number"));
}

#[test]
fn dump_with_a_body_of_no_operation_is_refused() {
    let text = inspect::json(&good_spec::model());
    for (operation, user) in [
        ("get_thing", "GetThingRequest"),
        ("thing_moved", "ThingMoved"),
    ] {
        let owner = format!("\"operation\": \"{operation}\"");
        assert!(text.contains(&owner));
        for other in ["nowhere", "level_changed"] {
            let renamed = text.replace(&owner, &format!("\"operation\": \"{other}\""));
            assert_eq!(
                refused(&renamed),
                format!("`{user}` names the request of `{other}`, which is not in the dump")
            );
        }
    }
}

#[test]
fn dump_with_an_example_of_another_type_is_refused() {
    let text = inspect::json(&good_spec::model());
    for (ty, key, other) in [
        ("GetThingResponseData", "x", json!("half")),
        ("GetThingResponseData", "x", json!(0.5)),
        ("GetThingResponseData", "name", json!(1)),
        ("GetThingRequest", "thingId", json!("seven")),
        ("GetThingRequest", "thingId", json!([7])),
        ("GetThingRequest", "thingId", json!(7.5)),
    ] {
        let mut dump = serde_json::from_str(&text).expect("JSON");
        let fields = named(&mut dump, "types", ty)["fields"].as_array_mut();
        let mut fields = fields.expect("a list").iter_mut();
        let field = fields.find(|field| field["path"] == key);
        let field = field.expect("it is there");
        field["example_is"] = json!("given");
        field["example"] = other;
        assert_eq!(
            refused(&dump.to_string()),
            format!("a value of `{ty}.{key}` does not fit its type")
        );
    }
}

#[test]
fn dump_with_a_row_of_another_type_is_refused() {
    let text = inspect::json(&good_spec::model());
    let mut dump: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let table = &mut dump["tables"][0];
    let id = table["id"].as_str().expect("an id").to_owned();
    let row = table["rows"][0].as_object_mut().expect("an object");
    let number = row.values_mut().find(|value| value.is_number());
    *number.expect("a number") = json!("wide");
    assert_eq!(
        refused(&dump.to_string()),
        format!("a value of `{id}` does not fit its type")
    );
}

/// Renames an entry at its declaration or at its use, so that the dump uses an unknown name.
#[test]
fn a_dump_with_an_unknown_name_is_refused() {
    let text = inspect::json(&good_spec::model());
    for (key, name, user, missing) in [
        ("type", "Color", "GetThingResponseData.color", "type"),
        ("refers", "thing", "ThingMoved.thingId", "entity"),
        ("kept", "config_file", "Size.depth", "store"),
        ("coordinates", "plan", "Size", "coordinate system"),
    ] {
        let renamed = text.replace(
            &format!("\"{key}\": \"{name}\""),
            &format!("\"{key}\": \"Nowhere\""),
        );
        assert_eq!(
            refused(&renamed),
            format!("`{user}` names the {missing} `Nowhere`, which is not in the dump")
        );
    }
    for (word, other, missing) in [
        ("debugging_app", "nobody", "audience"),
        ("second_generation", "hovercraft", "hardware"),
        ("adp", "bdp", "releases"),
    ] {
        let declared = format!("\"name\": \"{word}\"");
        let renamed = text.replace(&declared, "\"name\": \"another\"");
        let renamed = renamed.replace(&format!("\"{word}\""), &format!("\"{other}\""));
        assert_eq!(
            refused(&renamed),
            format!(
                "`GetThingResponseData.y` names the {missing} `{other}`, which is not in the dump"
            )
        );
    }
}

/// Adds names of operations, types and values that the dump does not declare.
#[test]
fn dump_with_an_unknown_name_is_refused() {
    let text = inspect::json(&good_spec::model());
    let tied = |command: &str, report: &str| {
        let tie = json!({ "side": "request", "command": [command], "report": [report] });
        json!([{ "report": "thing_moved", "tied": [tie] }])
    };
    let accepted = |states: serde_json::Value, after: &[&str]| json!({ "in": states, "after": after, "note": null });
    let states = json!({ "states": [{ "type": "Colour", "values": [0] }] });
    for (place, value, missing) in [
        (
            "Color/values/1/then",
            json!(["red", "blue"]),
            "value `blue`",
        ),
        (
            "GetThingResponse/group",
            json!("nowhere"),
            "group `nowhere`",
        ),
        ("get_thing/group", json!("nowhere"), "group `nowhere`"),
        (
            "get_thing/sets_off",
            json!([{ "report": "thing_moved", "tied": [] }, { "report": "get_thing", "tied": [] }]),
            "report `get_thing`",
        ),
        ("get_thing/sets_off", tied("thingId", "thingId"), ""),
        ("get_thing/sets_off", tied("id", "thingId"), "key `id`"),
        ("get_thing/sets_off", tied("thingId", "id"), "key `id`"),
        (
            "get_thing/accepted",
            accepted(json!(null), &["get_thing", "thing_moved"]),
            "command `thing_moved`",
        ),
        ("get_thing/accepted", accepted(states, &[]), "type `Colour`"),
        (
            "thing_picture/started_by",
            json!("thing_moved"),
            "command `thing_moved`",
        ),
        (
            "thing_picture/stopped_by",
            json!("thing_moved"),
            "command `thing_moved`",
        ),
    ] {
        let (user, pointer) = place.split_once('/').expect("a place");
        let is_type = user.starts_with(char::is_uppercase);
        let mut dump: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        let list = if is_type { "types" } else { "operations" };
        let item = named(&mut dump, list, user);
        *item.pointer_mut(&format!("/{pointer}")).expect("a key") = value;
        let user = user.replace("Color", "Color.green");
        let expected = match missing {
            "" => String::new(),
            missing => format!("`{user}` names the {missing}, which is not in the dump"),
        };
        assert_eq!(refused(&dump.to_string()), expected);
    }
}
