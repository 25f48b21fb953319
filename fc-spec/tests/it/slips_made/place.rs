//! A spec as the makers see it: the text of its files, and the place of every key and item.

use fc_spec::diagnostic::Faults;
use fc_spec::source::{FileId, Sources};
use fc_spec::syntax::{Node, NodeKind, Style, parse};
use std::collections::HashMap;
use std::ops::{Deref, Range};
use std::path::Path;

/// The notation of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    Nothing,
    Plain,
    Quoted,
    Block,
    List,
    Map,
}

/// A key with its value, or an item of a list, which has an empty key.
#[derive(Debug)]
pub struct Place {
    /// Index of its file.
    pub file: usize,
    /// The keys that lead to it, including its key. Items are `-`.
    pub path: Vec<String>,
    /// Byte range of its key.
    pub key: Range<usize>,
    /// Byte range of its value.
    pub value: Range<usize>,
    /// Notation of the value.
    pub form: Form,
    /// `true` if it is inside brackets.
    pub flow: bool,
    /// Index of the place that contains it.
    pub parent: Option<usize>,
}

/// The files of a spec and their places.
pub struct Spec {
    /// Path and text, sorted by path.
    pub files: Vec<(String, String)>,
    pub places: Vec<Place>,
    /// Indices of the places directly inside each place. `None` has those at the top level.
    inside: HashMap<Option<usize>, Vec<usize>>,
}

impl Spec {
    /// Reads the `*.yaml` files of a folder and of its `commands`.
    pub fn read(folder: &Path) -> Self {
        let mut files = Vec::new();
        for (below, prefix) in [("", "spec/"), ("commands", "spec/commands/")] {
            for entry in std::fs::read_dir(folder.join(below)).expect("a folder of the spec") {
                let path = entry.expect("an entry").path();
                if path
                    .extension()
                    .is_some_and(|extension| extension == "yaml")
                {
                    let name = path.file_name().and_then(|name| name.to_str());
                    let text = std::fs::read_to_string(&path).expect("a file of the spec");
                    files.push((format!("{prefix}{}", name.expect("a name")), text));
                }
            }
        }
        files.sort();
        let mut places = Vec::new();
        for (file, (path, text)) in files.iter().enumerate() {
            let id = FileId(u32::try_from(file).expect("few files"));
            let mut faults = Faults::new();
            let tree = parse(id, text, &mut faults).unwrap_or_else(|| panic!("{path} is no YAML"));
            walk(file, text, tree.root(), &[], None, &mut places);
        }
        let mut inside: HashMap<_, Vec<usize>> = HashMap::new();
        for (index, place) in places.iter().enumerate() {
            inside.entry(place.parent).or_default().push(index);
        }
        Self {
            files,
            places,
            inside,
        }
    }

    /// Returns the places directly inside a place, or those at the top level.
    fn inside(&self, parent: Option<usize>) -> impl Iterator<Item = At<'_>> {
        let inside = self.inside.get(&parent).into_iter().flatten();
        inside.map(|index| self.at(*index))
    }

    pub fn sources(&self) -> Sources {
        Sources::from_texts(self.files.clone())
    }

    pub fn text(&self, file: usize) -> &str {
        &self.files[file].1
    }

    /// Returns every place.
    pub fn each(&self) -> impl Iterator<Item = At<'_>> {
        (0..self.places.len()).map(|index| self.at(index))
    }

    pub fn at(&self, index: usize) -> At<'_> {
        At { spec: self, index }
    }
}

fn walk(
    file: usize,
    text: &str,
    node: Node<'_>,
    path: &[String],
    parent: Option<usize>,
    places: &mut Vec<Place>,
) {
    let flow = text[node.span().start..].starts_with(['{', '[']);
    let mut add = |key: Option<Node<'_>>, value: Node<'_>| {
        let span = value.span();
        let key_span = key.map_or(span.start..span.start, |key| {
            key.span().start..key.span().end
        });
        let name = key.and_then(Node::as_str).unwrap_or("-");
        let path: Vec<String> = path.iter().cloned().chain([name.to_owned()]).collect();
        let form = match value.kind() {
            NodeKind::Null => Form::Nothing,
            NodeKind::Sequence(_) => Form::List,
            NodeKind::Mapping(_) => Form::Map,
            NodeKind::Scalar(scalar) => match scalar.style {
                Style::Plain => Form::Plain,
                Style::Quoted => Form::Quoted,
                Style::Block => Form::Block,
            },
        };
        let index = places.len();
        places.push(Place {
            file,
            path: path.clone(),
            key: key_span,
            value: span.start..span.end,
            form,
            flow,
            parent,
        });
        walk(file, text, value, &path, Some(index), places);
    };
    for entry in node.entries() {
        add(Some(entry.key), entry.value);
    }
    for item in node.items() {
        add(None, item);
    }
}

/// A place together with its spec.
#[derive(Clone, Copy)]
pub struct At<'s> {
    pub spec: &'s Spec,
    pub index: usize,
}

impl Deref for At<'_> {
    type Target = Place;

    fn deref(&self) -> &Place {
        &self.spec.places[self.index]
    }
}

/// Keys of the language that the makers look for.
const WORDS: &[&str] = &[
    "type",
    "zh",
    "en",
    "code",
    "effect",
    "since",
    "source",
    "sections",
    "lost",
    "about",
    "aliases",
    "answers",
    "ids",
    "as",
    "example",
    "refers",
    "unit",
    "enum",
    "values",
    "name",
    "fields",
    "result_text",
    "request",
    "response",
    "body",
    "request_state",
    "response_state",
    "state",
    "note",
    "quirk",
    "wire",
    "min",
    "max",
    "default",
    "cadence",
    "available",
    "deprecated",
    "category",
    "severity",
    "sets_off",
    "kept",
    "group",
    "commands",
    "reports",
    "types",
    "role",
    "id",
    "means",
    "runtime",
    "start",
    "error",
    "date",
    "unless",
    "when",
    "then",
    "value",
    "use",
    "from",
    "to",
    "order",
    "survives_restart",
];

/// Keys with data below them, where no key is one of the language.
const DATA: &[&str] = &["example", "rows", "when", "unless"];

/// The keys that mark the long form of a field.
const FORMS: &[&str] = &["type", "fields", "items", "one_of"];

impl<'s> At<'s> {
    /// Returns the text of its file.
    pub fn whole(self) -> &'s str {
        self.spec.text(self.place().file)
    }

    fn place(self) -> &'s Place {
        &self.spec.places[self.index]
    }

    pub fn name(self) -> &'s str {
        &self.whole()[self.place().key.clone()]
    }

    /// Returns its value as written.
    pub fn written(self) -> &'s str {
        &self.whole()[self.place().value.clone()]
    }

    pub fn parent(self) -> Option<At<'s>> {
        self.place().parent.map(|index| self.spec.at(index))
    }

    pub fn children(self) -> impl Iterator<Item = At<'s>> {
        self.spec.inside(Some(self.index))
    }

    pub fn child(self, name: &str) -> Option<At<'s>> {
        self.children().find(|child| child.name() == name)
    }

    pub fn siblings(self) -> impl Iterator<Item = At<'s>> {
        let file = self.place().file;
        let inside = self.spec.inside(self.place().parent);
        inside.filter(move |other| other.file == file)
    }

    /// Returns the sibling before it.
    pub fn before(self) -> Option<At<'s>> {
        self.siblings()
            .filter(|other| other.index < self.index)
            .last()
    }

    /// Returns the sibling after it.
    pub fn behind(self) -> Option<At<'s>> {
        self.siblings().find(|other| other.index > self.index)
    }

    /// Returns `true` if its children are fields under their wire keys.
    pub fn is_body(self) -> bool {
        let Some(parent) = self.parent().filter(|_| self.form == Form::Map) else {
            return false;
        };
        match self.name() {
            "request" | "response" | "body" if self.path.len() == 3 => self.path[0] != "types",
            "request" | "response" => self.path[0] == "envelope",
            "fields" | "items" if !parent.is_body() => true,
            _ => parent.is_body() && !self.children().any(|child| FORMS.contains(&child.name())),
        }
    }

    /// Returns `true` if its key is one of the language.
    pub fn is_word(self) -> bool {
        WORDS.contains(&self.name()) && !self.is_data() && !self.parent().is_some_and(At::is_body)
    }

    /// Returns `true` if it is inside data, where no key is one of the language.
    fn is_data(self) -> bool {
        let above = &self.path[..self.path.len() - 1];
        let last = above.last().map(String::as_str);
        above.iter().any(|key| DATA.contains(&key.as_str()))
            || (last == Some("about") && above.iter().any(|key| key == "answers"))
    }

    /// Returns `true` if it is this key of the language.
    pub fn is(self, word: &str) -> bool {
        self.name() == word && self.is_word()
    }

    /// Returns `true` if its value is a scalar on one line.
    pub fn is_scalar(self) -> bool {
        matches!(self.form, Form::Plain | Form::Quoted) && !self.written().contains('\n')
    }

    /// Returns `true` if its key begins a line.
    pub fn is_row(self) -> bool {
        let line = self.line();
        !self.flow
            && !self.key.is_empty()
            && self.whole()[line.start..self.key.start].trim().is_empty()
    }

    /// Returns the number of blanks before its key.
    pub fn indent(self) -> usize {
        self.key.start - self.line().start
    }

    /// Returns the line on which it begins, without the line end.
    pub fn line(self) -> Range<usize> {
        line_of(self.whole(), self.key.start)
    }

    /// Returns all of its lines, with the last line end.
    pub fn lines(self) -> Range<usize> {
        let last = line_of(self.whole(), self.value.end.max(self.key.end));
        self.line().start..(last.end + 1).min(self.whole().len())
    }

    /// Returns `true` if it is an entry of this section.
    pub fn is_in(self, section: &str) -> bool {
        self.path.len() == 2 && self.path[0] == section
    }

    /// Returns `true` if it is a command or a report.
    pub fn is_operation(self) -> bool {
        self.is_in("commands") || self.is_in("reports")
    }

    /// Returns `true` if it is the scalar with the type of a field, in the long or the short form.
    pub fn is_type(self) -> bool {
        let long = self.is("type")
            && self
                .parent()
                .is_some_and(|field| field.parent().is_some_and(At::is_body));
        self.is_scalar() && (long || self.parent().is_some_and(At::is_body))
    }
}

/// Returns the line that holds a byte, without the line end.
pub fn line_of(text: &str, at: usize) -> Range<usize> {
    let start = text[..at].rfind('\n').map_or(0, |end| end + 1);
    let end = text[at..].find('\n').map_or(text.len(), |end| at + end);
    start..end
}
