//! Indexes the model for the pages of both languages.

use super::links::{Anchor, Page};
use super::tabs::{Tabs, TabsByOperation};
use super::terms::Terms;
use super::words;
use crate::sample::Samples;
use fc_reflect::Reflector;
use fc_spec::model::Lang;
use fc_spec::model::{
    Answer, Direction, Field, Model, Operation, Subject, TypeDef, TypeRef, TypeShape,
};
use std::collections::HashMap;
use std::hash::Hash;

/// The model and its indices.
pub(crate) struct Book<'m> {
    pub(crate) model: &'m Model,
    pub(super) samples: Samples<'m>,
    pub(super) reflector: Reflector<'m>,
    /// The samples of operations in each language, by operation name.
    tabs: TabsByOperation,
    operations: HashMap<&'m str, &'m Operation>,
    /// Answers by subject.
    answers: HashMap<&'m Subject, Vec<&'m Answer>>,
    /// Types made for the bodies of an operation, by operation name.
    bodies: HashMap<&'m str, Vec<&'m TypeDef>>,
    /// The place that lists the fields of a type made for a body, by type name.
    listed: HashMap<&'m str, (&'m Operation, Anchor)>,
    /// Operations whose bodies contain a shared type, by type name.
    users: HashMap<&'m str, Vec<&'m Operation>>,
    /// The terms of the glossary, by [`Lang`].
    terms: [Terms<'m>; 2],
}

impl<'m> Book<'m> {
    /// Indexes a model. `tabs` has the samples of operations.
    pub(crate) fn new(model: &'m Model, tabs: TabsByOperation) -> Self {
        let samples = Samples::new(model);
        let answers = model.answers.iter().map(|it| (&it.subject, it));
        let bodies = model.types.iter();
        let bodies = bodies.filter_map(|ty| Some((ty.body_of.as_ref()?.operation.as_str(), ty)));
        let operations = model.operations.iter().map(|it| (it.name.as_str(), it));
        let users = model.operations.iter().flat_map(|operation| {
            let types = types_of(model, operation).into_iter();
            types.map(move |ty| (ty.name.as_str(), operation))
        });
        let mut listed = HashMap::new();
        for operation in &model.operations {
            for direction in Direction::ALL {
                if let Some(body) = operation.body(*direction) {
                    let ty = model.types.get(&body.ty);
                    let anchor = Anchor::named(direction.name());
                    list(model, operation, ty, anchor, &mut listed);
                }
            }
        }
        Self {
            model,
            samples,
            reflector: Reflector::new(model),
            tabs,
            operations: operations.collect(),
            answers: gathered(answers),
            bodies: gathered(bodies),
            listed,
            users: gathered(users),
            terms: Lang::ALL.map(|lang| Terms::new(&model.glossary, lang)),
        }
    }

    /// Returns the terms of the glossary in a language.
    pub(super) fn terms(&self, lang: Lang) -> &Terms<'m> {
        let [zh, en] = &self.terms;
        lang.pick(zh, en)
    }

    /// Returns the samples of an operation, or `None` if it has no code.
    pub(super) fn tabs(&self, operation: &Operation) -> Option<&Tabs> {
        self.tabs.get(operation.name.as_str())
    }

    pub(super) fn operation(&self, name: &str) -> Option<&'m Operation> {
        self.operations.get(name).copied()
    }

    /// Returns a type that the spec declares.
    fn type_named(&self, name: &str) -> Option<&'m TypeDef> {
        self.model.types.named(name)
    }

    /// Returns the answers to exactly this subject.
    pub(super) fn answers_to(&self, subject: &Subject) -> &[&'m Answer] {
        self.answers.get(subject).map_or(&[], Vec::as_slice)
    }

    /// Returns the answers to a type and to its fields.
    pub(super) fn answers_in_type(&self, ty: &'m TypeDef) -> Vec<&'m Answer> {
        let mut answers = self.answers_to(&Subject::Type(ty.name.clone())).to_vec();
        if let TypeShape::Struct(shape) = &ty.shape {
            for field in &shape.fields {
                answers.extend(self.answers_to_field(&ty.name, field));
            }
        }
        answers
    }

    pub(super) fn answers_to_field(&self, owner: &str, field: &Field) -> &[&'m Answer] {
        let subject = Subject::Field {
            owner: owner.to_owned(),
            key: field.wire.clone(),
        };
        self.answers_to(&subject)
    }

    /// Returns the types made for an operation's bodies, outer before inner.
    pub(super) fn body_types(&self, operation: &Operation) -> &[&'m TypeDef] {
        self.bodies
            .get(operation.name.as_str())
            .map_or(&[], Vec::as_slice)
    }

    /// Returns all types in the bodies of an operation, outer before inner.
    pub(super) fn types_of(&self, operation: &Operation) -> Vec<&'m TypeDef> {
        types_of(self.model, operation)
    }

    /// Returns the operations whose bodies contain a shared type.
    pub(super) fn users(&self, ty: &TypeDef) -> &[&'m Operation] {
        self.users.get(ty.name.as_str()).map_or(&[], Vec::as_slice)
    }

    /// Returns the page and the anchor of a type.
    pub(super) fn place_of_type(&self, ty: &'m TypeDef) -> (Page<'m>, Anchor) {
        match self.listed.get(ty.name.as_str()) {
            Some((operation, anchor)) => (Page::Operation(operation), anchor.clone()),
            None => (Page::Types, Anchor::of("type", &ty.name)),
        }
    }

    /// Returns the page and the anchor of the subject of an answer.
    pub(super) fn place_of(&self, subject: &'m Subject) -> (Page<'m>, Anchor) {
        let of_type = |name: &str| match self.type_named(name) {
            Some(ty) => self.place_of_type(ty),
            None => (Page::Types, Anchor::none()),
        };
        match subject {
            Subject::Protocol => (Page::Index, Anchor::named("open-questions-and-decisions")),
            Subject::Transport => (Page::Wire, Anchor::named("transport")),
            Subject::Frame(None) => (Page::Wire, Anchor::named("frame")),
            Subject::Frame(Some(name)) => {
                let mut header = self.model.frame.header.iter();
                match header.find(|field| field.name == *name || field.wire == *name) {
                    Some(field) => (Page::Wire, Anchor::of("header", &field.name)),
                    None => (Page::Wire, Anchor::named("frame")),
                }
            }
            Subject::Envelope(_) => (Page::Wire, Anchor::named("envelope")),
            Subject::Results(None) => (Page::Results, Anchor::none()),
            Subject::Results(Some(code)) => {
                (Page::Results, Anchor::of("result", &code.to_string()))
            }
            Subject::Codes => (Page::Codes, Anchor::none()),
            Subject::Operation(name) => match self.operation(name) {
                Some(operation) => (Page::Operation(operation), Anchor::none()),
                None => (Page::Index, Anchor::none()),
            },
            Subject::Field { owner, key } => match self.type_named(owner) {
                Some(ty) => {
                    let (page, anchor) = self.place_of_type(ty);
                    (page, anchor.step(key))
                }
                None => (Page::Types, Anchor::none()),
            },
            Subject::Type(name) => of_type(name),
            Subject::Table(id) => (Page::Tables, Anchor::of("table", id)),
            Subject::Section(number) => (
                Page::OpenQuestions,
                Anchor::of("section", &number.to_string()),
            ),
        }
    }

    /// Returns the title of the subject of an answer. On the page of an operation it leaves out that operation's title.
    pub(crate) fn name_of(&self, subject: &Subject, lang: Lang, page: Page<'_>) -> String {
        let title = |page: Page<'_>| page.title(lang).to_owned();
        match subject {
            Subject::Protocol => lang.pick("协议", "The protocol").to_owned(),
            Subject::Transport => lang.pick("传输", "Transport").to_owned(),
            Subject::Frame(None) => lang.pick("帧", "Frame").to_owned(),
            Subject::Frame(Some(name)) => lang.pick(
                format!("包头字段 `{name}`"),
                format!("Header field `{name}`"),
            ),
            Subject::Envelope(None) => lang.pick("公共字段", "Envelope").to_owned(),
            Subject::Envelope(Some(name)) => lang.pick(
                format!("公共字段 `{name}`"),
                format!("Envelope key `{name}`"),
            ),
            Subject::Results(None) => title(Page::Results),
            Subject::Results(Some(code)) => {
                lang.pick(format!("结果码 {code}"), format!("Result code {code}"))
            }
            Subject::Codes => title(Page::Codes),
            Subject::Operation(name) => match self.operation(name) {
                Some(operation) => lang.text(&operation.title).to_owned(),
                None => name.clone(),
            },
            Subject::Field { owner, key } => self.name_of_field(owner, key, lang, page),
            Subject::Type(name) => format!("`{name}`"),
            Subject::Table(id) => match self.model.tables.iter().find(|table| table.id == *id) {
                Some(table) => lang.text(&table.title).to_owned(),
                None => id.clone(),
            },
            Subject::Section(number) => {
                lang.pick(format!("第 {number} 节"), format!("Section {number}"))
            }
        }
    }

    fn name_of_field(&self, owner: &str, key: &str, lang: Lang, page: Page<'_>) -> String {
        let body = self.type_named(owner).and_then(|ty| ty.body_of.as_ref());
        let operation = body.and_then(|body| self.operation(&body.operation));
        let (Some(body), Some(operation)) = (body, operation) else {
            return format!("`{owner}.{key}`");
        };
        let mut path = body.path.clone();
        path.push(key.to_owned());
        let path = path.join(".");
        let side = words::side(operation.kind(), body.side, lang);
        if matches!(page, Page::Operation(own) if own.name == operation.name) {
            return format!("{side} `{path}`");
        }
        let title = lang.text(&operation.title);
        lang.pick(
            format!("{title}：{side} `{path}`"),
            format!("{title}: {side} `{path}`"),
        )
    }
}

/// Returns the values of each key.
fn gathered<K: Eq + Hash, V>(pairs: impl Iterator<Item = (K, V)>) -> HashMap<K, Vec<V>> {
    let mut gathered: HashMap<K, Vec<V>> = HashMap::new();
    for (key, value) in pairs {
        gathered.entry(key).or_default().push(value);
    }
    gathered
}

/// Returns all types in the bodies of an operation, outer before inner.
fn types_of<'m>(model: &'m Model, operation: &Operation) -> Vec<&'m TypeDef> {
    let mut found = Vec::new();
    for body in operation.bodies() {
        add_types_in(model, &body.ty, &mut found);
    }
    found
}

/// Adds the places that list a type made for a body, and all such types in it.
fn list<'m>(
    model: &'m Model,
    operation: &'m Operation,
    ty: &'m TypeDef,
    anchor: Anchor,
    listed: &mut HashMap<&'m str, (&'m Operation, Anchor)>,
) {
    if ty.body_of.is_none() || listed.contains_key(ty.name.as_str()) {
        return;
    }
    let inner = inside(ty).into_iter();
    let inner: Vec<_> = inner
        .map(|(named, key)| (named, anchor.step(key)))
        .collect();
    listed.insert(&ty.name, (operation, anchor));
    for (named, anchor) in inner {
        list(model, operation, model.types.get(named), anchor, listed);
    }
}

/// Adds a type and all types in it, each once.
fn add_types_in<'m>(model: &'m Model, named: &TypeRef, found: &mut Vec<&'m TypeDef>) {
    let ty = model.types.get(named);
    if found.iter().any(|known| known.name == ty.name) {
        return;
    }
    found.push(ty);
    for (named, _) in inside(ty) {
        add_types_in(model, named, found);
    }
}

/// Returns the named types in a type, each with the key of its field or the name of its variant.
fn inside(ty: &TypeDef) -> Vec<(&TypeRef, &str)> {
    match &ty.shape {
        TypeShape::Struct(shape) => {
            let fields = shape.fields.iter();
            let named = fields.filter_map(|it| Some((it.ty.innermost()?, it.wire.as_str())));
            named.collect()
        }
        TypeShape::OneOf(choice) => {
            let variants = choice.variants.iter();
            variants.map(|it| (&*it.ty, it.name.as_str())).collect()
        }
        TypeShape::Enum(_) => Vec::new(),
    }
}
