//! Changes to messages.

use fc_reflect::{Frame, Key, Node, Reflector, Value as Content};
use fc_spec::model::{EnumRepr, EnumType, Number, Scalar, Type, TypeShape, Value};

/// The key that [`unknown_key`] adds.
const KEY: &str = "unknownKey";

/// The text that [`unknown_value`] writes.
const TEXT: &str = "unknown value";

/// Adds a key that the spec lacks.
pub(super) fn unknown_key(body: &mut Value) -> bool {
    if !matches!(body, Value::Object(_)) {
        return false;
    }
    body.set(KEY, Value::Bool(true));
    true
}

/// Gives an enum of a message a value that the spec lacks. `choose` returns an index below a number.
pub(super) fn unknown_value(
    reflector: &Reflector<'_>,
    frame: &Frame<'_>,
    body: &mut Value,
    choose: impl FnOnce(usize) -> usize,
) -> bool {
    let message = reflector.message(frame.operation, frame.id.direction, &frame.data);
    let Some(nodes) = message.ok().and_then(|message| message.body.ok()) else {
        return false;
    };
    let mut enums = Vec::new();
    collect(reflector, &nodes, &mut Vec::new(), &mut enums);
    if enums.is_empty() {
        return false;
    }
    let index = choose(enums.len());
    let Some((path, value)) = enums.into_iter().nth(index) else {
        return false;
    };
    let place = path.iter().try_fold(body, |value, key| match key {
        Key::Name(name) => value.get_mut(name),
        Key::Item(item) => value.items_mut().nth(*item),
    });
    place.is_some_and(|place| {
        *place = value;
        true
    })
}

/// Collects the path of each enum, with an unknown value. The recursion is as deep as the text is nested, which is
/// bounded.
fn collect(
    reflector: &Reflector<'_>,
    nodes: &[Node<'_>],
    path: &mut Vec<Key>,
    enums: &mut Vec<(Vec<Key>, Value)>,
) {
    for node in nodes {
        path.push(node.key.clone());
        if matches!(node.value, Content::Enum { .. })
            && let Some(Type::Named(named)) = node.ty
            && let TypeShape::Enum(shape) = &reflector.model().types.get(named).shape
            && let Some(value) = unknown(shape)
        {
            enums.push((path.clone(), value));
        }
        collect(reflector, node.children(), path, enums);
        path.pop();
    }
}

/// Returns a value that an enum lacks.
fn unknown(shape: &EnumType) -> Option<Value> {
    let has = |wire: &Scalar| shape.values.iter().any(|value| value.wire == *wire);
    if shape.repr == EnumRepr::String {
        return Some(Value::String(TEXT.to_owned()));
    }
    let numbers = (0..=i128::from(i8::MAX)).rev().map(Number::Int);
    let mut scalars = numbers.map(Scalar::Number);
    match scalars.find(|scalar| !has(scalar))? {
        Scalar::Number(number) => Some(Value::Number(number)),
        Scalar::Bool(_) | Scalar::String(_) => None,
    }
}
