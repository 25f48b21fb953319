//! The texts of errors.

use crate::support::root;
use fc_spec::model::Lang;
use fc_workshop::decode;
use serde_json::Value;

#[test]
fn texts_are_those_of_the_conformance_data() {
    let data = std::fs::read_to_string(root().join("conformance/errors.json")).unwrap();
    let data: Value = serde_json::from_str(&data).unwrap();
    for error in data["errors"].as_array().unwrap() {
        let name = error["name"].as_str().unwrap();
        let is_read = error["where"] != "call";
        for (lang, key) in [(Lang::Zh, "zh"), (Lang::En, "en")] {
            let expected = error[key].as_str().filter(|_| is_read);
            assert_eq!(decode::error_text(name, lang), expected, "{name}");
        }
    }
}
