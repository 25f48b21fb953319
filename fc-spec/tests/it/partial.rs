//! A spec with errors is read as far as possible, and every item of it has its place.

use crate::good_spec;
use fc_spec::diagnostic::Faults;
use fc_spec::index::{DefId, definitions};
use fc_spec::load::{Loaded, load};
use fc_spec::model::{Availability, TypeDef, TypeShape};
use fc_spec::source::Sources;

/// Loads the good spec with some of its text replaced, and returns its number of errors.
fn loaded(changes: &[(&str, &str)]) -> (Sources, Loaded, usize) {
    let mut seen = 0;
    let files = good_spec::FILES.map(|path| {
        let mut text = good_spec::file(path);
        for (from, to) in changes {
            seen += text.matches(from).count();
            text = text.replace(from, to);
        }
        (format!("spec/{path}"), text)
    });
    assert_eq!(seen, changes.len(), "each change is made once");
    let sources = Sources::from_texts(files);
    let mut faults = Faults::new();
    let loaded = load(&sources, &mut faults);
    (sources, loaded, faults.errors())
}

fn fields(loaded: &Loaded, ty: &str) -> Vec<String> {
    match &loaded.partial.types.named(ty).expect(ty).shape {
        TypeShape::Struct(shape) => shape.fields.iter().map(|it| it.wire.clone()).collect(),
        _ => panic!("{ty} is no struct"),
    }
}

fn field(owner: &str, name: &str) -> DefId {
    DefId {
        kind: "field",
        owner: Some(owner.to_owned()),
        name: name.to_owned(),
    }
}

#[test]
fn parts_without_errors_are_read() {
    let (sources, loaded, errors) = loaded(&[
        ("color: Color\n", "color: Colour\n"),
        ("max: 100, example: 3", "example: 3, maximum: 100"),
        ("row: Size", "row: Sizes"),
        ("code: 0x0201", "code: x"),
        ("host:", "hosts:"),
    ]);
    assert!(errors >= 5, "{errors}");
    let partial = &loaded.partial;
    assert!(partial.transport.is_none() && partial.frame.is_some());
    let operations = partial.operations.iter();
    let operations: Vec<_> = operations
        .map(|it| (it.name.as_str(), it.code.value))
        .collect();
    assert_eq!(
        operations,
        [
            ("get_thing", Some(0x0101)),
            ("thing_moved", None),
            ("thing_picture", Some(0x0501))
        ]
    );
    // A field of an unknown type is left out, and so is a table with an unknown row type.
    assert_eq!(
        fields(&loaded, "GetThingResponseData"),
        ["name", "x", "y", "tags", "choice"]
    );
    assert_eq!(fields(&loaded, "Size"), ["width", "label", "depth"]);
    assert!(partial.tables.is_empty());
    // The place of the field is still known.
    let color = field("GetThingResponseData", "color");
    assert!(definitions(&sources).get(&color).is_some());
    assert!(loaded.model().is_none());
}

#[test]
fn references_of_readable_parts_resolve() {
    let (_, loaded, _) = loaded(&[
        ("enum: u8", "enum: u9"),
        ("tags: { type: [string]", "tags: { type: [Sise]"),
    ]);
    let partial = &loaded.partial;
    for ty in &partial.types {
        if let TypeShape::Struct(shape) = &ty.shape {
            let types = shape.fields.iter().filter_map(|field| match &field.ty {
                fc_spec::model::Type::Named(named) => Some(named),
                _ => None,
            });
            for named in types {
                assert_eq!(partial.types.get(named).name, named.name());
            }
        }
    }
    assert_eq!(
        fields(&loaded, "GetThingResponseData"),
        ["name", "color", "x", "y", "choice"]
    );
}

/// Returns the words that limit the availability of items, with their kinds.
fn limits(words: &Availability) -> Vec<(&'static str, String)> {
    let kinds = [
        ("audience", &words.audiences),
        ("line of machines", &words.hardware),
        ("series of releases", &words.releases),
    ];
    let named = kinds.into_iter().flat_map(|(kind, declared)| {
        let names = declared.iter().map(|it| it.name.clone());
        names.map(move |name| (kind, name))
    });
    named.collect()
}

/// Returns the kinds and names of types, and of their fields, values and variants.
fn types(types: &[TypeDef]) -> Vec<(&'static str, String)> {
    let mut all = Vec::new();
    for ty in types {
        let (kind, inside, names): (_, _, Vec<&String>) = match &ty.shape {
            TypeShape::Struct(shape) => (
                "struct",
                "field",
                shape.fields.iter().map(|it| &it.wire).collect(),
            ),
            TypeShape::Enum(shape) => (
                "enum",
                "enum value",
                shape.values.iter().map(|it| &it.name).collect(),
            ),
            TypeShape::OneOf(choice) => (
                "choice",
                "variant",
                choice.variants.iter().map(|it| &it.name).collect(),
            ),
        };
        all.push((kind, ty.name.clone()));
        all.extend(names.into_iter().map(|name| (inside, name.clone())));
    }
    all
}

/// Kinds of items whose name is their key.
const KEYED: [&str; 9] = [
    "field",
    "command",
    "header field",
    "conflict",
    "entity",
    "coordinate system",
    "store",
    "term",
    "variant",
];

#[test]
fn every_node_of_a_model_has_its_place() {
    let (sources, loaded, errors) = loaded(&[]);
    assert_eq!(errors, 0);
    let model = loaded.partial;
    let mut expected: Vec<(&'static str, String)> = Vec::new();
    let mut expect = |kind, names: &[&dyn ToString]| {
        expected.extend(names.iter().map(|name| (kind, name.to_string())));
    };
    for kind in [
        "protocol",
        "transport",
        "frame",
        "envelope",
        "calls",
        "limits",
    ] {
        expect(kind, &[&kind]);
    }
    expect("port", &[&"command", &"data"]);
    let frame = model.frame.expect("a frame");
    frame
        .header
        .iter()
        .for_each(|it| expect("header field", &[&it.wire]));
    frame
        .kinds
        .each()
        .iter()
        .for_each(|it| expect("frame kind", &[&it.value]));
    frame
        .encodings
        .iter()
        .for_each(|it| expect("encoding", &[&it.value]));
    let envelope = model.envelope.expect("an envelope");
    let fields = envelope.request.iter().chain(&envelope.response);
    fields.for_each(|it| expect("envelope field", &[&it.wire]));
    model
        .results
        .iter()
        .for_each(|it| expect("result code", &[&it.code]));
    model
        .ranges
        .iter()
        .for_each(|it| expect("range", &[&it.first_spelling]));
    model
        .retired
        .iter()
        .for_each(|it| expect("retired code", &[&it.spelling]));
    model
        .groups
        .iter()
        .for_each(|it| expect("group", &[&it.id]));
    model
        .operations
        .iter()
        .for_each(|it| expect(it.kind().name(), &[&it.name]));
    model
        .tables
        .iter()
        .for_each(|it| expect("table", &[&it.id]));
    for it in &model.entities {
        expect("entity", &[&it.name]);
    }
    for it in &model.coordinates {
        expect("coordinate system", &[&it.name]);
    }
    for it in &model.stores {
        expect("store", &[&it.name]);
    }
    model
        .glossary
        .iter()
        .for_each(|it| expect("term", &[&it.id]));
    model
        .missing_sections
        .iter()
        .for_each(|it| expect("missing section", &[&it.section]));
    model
        .conflicts
        .iter()
        .for_each(|it| expect("conflict", &[&it.id]));
    (1..=model.answers.len()).for_each(|at| expect("answer", &[&at]));
    (1..=model.changes.len()).for_each(|at| expect("change", &[&at]));
    expected.extend(limits(&model.availability));
    expected.extend(types(&model.types));
    let places = definitions(&sources);
    let mut found: Vec<_> = places
        .iter()
        .map(|(item, _)| (item.kind, item.name.clone()))
        .collect();
    expected.sort();
    found.sort();
    assert_eq!(found, expected);
}

#[test]
fn every_place_contains_its_item() {
    let (sources, ..) = loaded(&[]);
    for (item, place) in definitions(&sources).iter() {
        let says = sources.slice(place.key);
        let is_keyed = KEYED.contains(&item.kind);
        assert!(!is_keyed || says == item.name, "{item}: {says}");
        assert!(
            place.whole.start == place.key.start && place.whole.end >= place.key.end,
            "{item}"
        );
    }
}

#[test]
fn names_are_found_alone_and_with_their_owner() {
    let (sources, ..) = loaded(&[("      x: {", "      # Of the map.\n        x: {")]);
    let places = definitions(&sources);
    let found = |name: &str| -> Vec<String> {
        places
            .named(name)
            .map(|(item, _)| item.to_string())
            .collect()
    };
    assert_eq!(found("Size.width"), ["field Size.width"]);
    assert_eq!(
        found("thingId"),
        ["field GetThingRequest.thingId", "field ThingMoved.thingId"]
    );
    assert_eq!(found("frame"), ["frame"]);
    assert!(found("widht").is_empty());
    assert_eq!(places.nearest("widht"), Some("width"));
    let x = places
        .get(&field("GetThingResponseData", "x"))
        .expect("a place");
    assert_eq!(x.comments.len(), 1);
}
