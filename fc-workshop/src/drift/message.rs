//! Deviations inside a message.

use super::{DeviationKind, Found, Moment, Place, kind, of_all_items, place};
use crate::decode::{Record, scalar};
use fc_reflect::{About, Error, Key, Node, Value as Content};
use fc_spec::model::{Model, Type};
use serde_json::Value;

/// Finds the deviations of a frame and its message.
pub(super) fn compare<'m>(model: &'m Model, record: &Record<'m>, found: &mut Found<'m>) {
    if let Some(error) = &record.error {
        let place = Place {
            path: of_all_items(error.path()),
            ..place(record, kind(error))
        };
        found.add_at(&Moment::of(record), place, || {
            let example = match error {
                Error::Frame(_) => String::new(),
                Error::Body { .. } => value_at(record, error.path()),
            };
            (example, error.detail().to_owned())
        });
    }
    if record.frame.is_none() {
        return;
    }
    if record.operation.is_none() {
        let place = place(record, DeviationKind::UnknownCode);
        return found.add(record, place, || body_text(record));
    }
    if let Some(code) = record.result()
        && !model.results.iter().any(|result| result.code == code)
    {
        let place = Place {
            value: code.to_string(),
            ..place(record, DeviationKind::UnknownResult)
        };
        found.add(record, place, || code.to_string());
    }
    let Some(Ok(body)) = record.message.as_ref().map(|message| &message.body) else {
        return;
    };
    let direction = record.id.map(|id| id.direction);
    let operation = record.operation.zip(direction);
    let ty = operation.and_then(|(operation, direction)| operation.body(direction));
    let owner = ty.map(|body| body.ty.name());
    let mut search = Search { record, found };
    search.nodes("", owner, body);
}

/// A search for deviations in a body.
struct Search<'s, 'm> {
    record: &'s Record<'m>,
    found: &'s mut Found<'m>,
}

impl Search<'_, '_> {
    /// Finds the deviations in the keys of a struct or the items of a list. The recursion is as deep as the text is
    /// nested, which is bounded.
    fn nodes(&mut self, path: &str, owner: Option<&str>, nodes: &[Node<'_>]) {
        for node in nodes {
            let path = match &node.key {
                Key::Name(name) if path.is_empty() => name.clone(),
                Key::Name(name) => format!("{path}.{name}"),
                Key::Item(_) if path.ends_with("[]") => path.to_owned(),
                Key::Item(_) => format!("{path}[]"),
            };
            self.node(&path, owner, node);
            let inside = match (&node.value, node.ty) {
                (Content::OneOf { variant, .. }, _) => Some(variant.ty.name()),
                (Content::Object(_), Some(Type::Named(named))) => Some(named.name()),
                _ => owner,
            };
            self.nodes(&path, inside, node.children());
        }
    }

    fn node(&mut self, path: &str, owner: Option<&str>, node: &Node<'_>) {
        let (kind, value, example) = match (&node.about, &node.value) {
            (About::Unknown, Content::Json(text)) => {
                (DeviationKind::UnknownKey, String::new(), text.clone())
            }
            (_, Content::Enum { wire, named: None }) => {
                let value = scalar(wire);
                (DeviationKind::UnknownEnumValue, value.clone(), value)
            }
            _ => return,
        };
        let place = Place {
            owner: owner.map(str::to_owned),
            path: path.to_owned(),
            value,
            ..place(self.record, kind)
        };
        self.found.add(self.record, place, || example);
    }
}

/// Returns the data of a frame as text.
fn body_text(record: &Record<'_>) -> String {
    let data = record.frame.as_ref().map(|frame| frame.data.as_slice());
    String::from_utf8_lossy(data.unwrap_or_default()).into_owned()
}

/// Returns the JSON value at a path such as `data.stations[3].x`, or an empty text if there is none.
fn value_at(record: &Record<'_>, path: &str) -> String {
    let data = record.frame.as_ref().map(|frame| frame.data.as_slice());
    let body = serde_json::from_slice(data.unwrap_or_default());
    let mut value: Option<&Value> = body.as_ref().ok();
    for step in path.split(['.', '[']) {
        value = match step.strip_suffix(']') {
            Some(index) => value.and_then(|it| it.get(index.parse::<usize>().ok()?)),
            None => value.and_then(|it| it.get(step)),
        };
    }
    value.map(Value::to_string).unwrap_or_default()
}
