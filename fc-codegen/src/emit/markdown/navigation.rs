//! `navigation.json`: groups and their operations, for the site's sidebar.

use super::links::Page;
use crate::model::{Model, Text, Value};

/// `{ "groups": [ { "zh", "en", "items": [ { "zh", "en", "link": "commands/get_station" } ] } ] }`
pub(super) fn navigation(model: &Model) -> String {
    let mut groups: Vec<(&str, &Text, Vec<Value>)> = model
        .groups
        .iter()
        .map(|group| (group.id.as_str(), &group.title, Vec::new()))
        .collect();
    for operation in &model.operations {
        let path = Page::Operation(operation).path();
        let link = path.strip_suffix(".md").unwrap_or(&path).to_owned();
        let item = titled(&operation.title, ("link", Value::String(link)));
        if let Some((.., items)) = groups.iter_mut().find(|(id, ..)| *id == operation.group) {
            items.push(item);
        }
    }
    groups.retain(|(.., items)| !items.is_empty());
    let groups = groups
        .into_iter()
        .map(|(_, title, items)| titled(title, ("items", Value::Array(items))));
    let groups = ("groups".to_owned(), Value::Array(groups.collect()));
    Value::Object(vec![groups]).pretty() + "\n"
}

fn titled(title: &Text, (key, value): (&str, Value)) -> Value {
    Value::Object(vec![
        ("zh".to_owned(), Value::String(title.zh.clone())),
        ("en".to_owned(), Value::String(title.en.clone())),
        (key.to_owned(), value),
    ])
}
