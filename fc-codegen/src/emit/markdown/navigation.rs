//! `navigation.json`: groups and their operations, for the site's sidebar, map and search.

use super::escape::{self, Slot};
use super::links::Page;
use fc_spec::model::{Group, Model, Text, Value};

/// `{ "groups": [ { "zh", "en", "about": { "zh", "en" }, "items": [ { "zh", "en", "link":
/// "commands/get_station", "code": "0x0A03", "kind": "command" } ] } ] }`
pub(super) fn navigation(model: &Model) -> String {
    let mut groups: Vec<(&Group, Vec<Value>)> = model
        .groups
        .iter()
        .map(|group| (group, Vec::new()))
        .collect();
    for operation in &model.operations {
        let path = Page::Operation(operation).path();
        let link = path.strip_suffix(".md").unwrap_or(&path).to_owned();
        let kind = operation.kind().name();
        let code = operation
            .code
            .value
            .map(|_| operation.code.spelling.clone());
        let item = titled(
            &operation.title,
            vec![
                ("link", Value::String(link)),
                ("code", code.map_or(Value::Null, Value::String)),
                ("kind", Value::String(kind.to_owned())),
            ],
        );
        if let Some((.., items)) = groups
            .iter_mut()
            .find(|(group, _)| group.id == operation.group)
        {
            items.push(item);
        }
    }
    groups.retain(|(.., items)| !items.is_empty());
    let groups = groups.into_iter().map(|(group, items)| {
        let about = group
            .about
            .as_ref()
            .map_or(Value::Null, |about| titled(about, Vec::new()));
        titled(
            &group.title,
            vec![("about", about), ("items", Value::Array(items))],
        )
    });
    let groups = ("groups".to_owned(), Value::Array(groups.collect()));
    Value::Object(vec![groups]).pretty() + "\n"
}

fn titled(title: &Text, more: Vec<(&str, Value)>) -> Value {
    let texts = [("zh", &title.zh), ("en", &title.en)].map(|(key, text)| {
        (
            key.to_owned(),
            Value::String(escape::write(text, Slot::Data)),
        )
    });
    let more = more.into_iter().map(|(key, value)| (key.to_owned(), value));
    Value::Object(texts.into_iter().chain(more).collect())
}
