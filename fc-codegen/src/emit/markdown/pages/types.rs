//! The types that operations share.

use super::shared::{AnswerView, Desk, HistoryItem};
use crate::emit::markdown::enums::EnumView;
use crate::emit::markdown::links::{Anchor, Link};
use crate::emit::markdown::places::Given;
use crate::emit::markdown::rows::Row;
use crate::sample::Profile;
use fc_spec::model::{TypeDef, TypeShape};
use serde::Serialize;

#[derive(Debug, Serialize)]
pub(in crate::emit::markdown) struct TypesView {
    sections: Vec<Section>,
}

/// Types of one file.
#[derive(Debug, Serialize)]
struct Section {
    anchor: String,
    title: String,
    types: Vec<TypeView>,
}

#[derive(Debug, Serialize)]
struct TypeView {
    anchor: String,
    name: String,
    title: String,
    about: Option<String>,
    since: Option<String>,
    /// The coordinate system of its values.
    given: Option<Given>,
    /// `struct`, `enum`, `one_of`.
    shape: &'static str,
    rows: Vec<Row>,
    values: Option<EnumView>,
    json: Option<String>,
    users: Vec<Link>,
    changes: Vec<HistoryItem>,
    answers: Vec<AnswerView>,
    spec: Link,
}

pub(in crate::emit::markdown) fn types(desk: Desk<'_, '_>) -> TypesView {
    let model = desk.book.model;
    let mut sections = vec![Section {
        anchor: "shared-by-several-groups".to_owned(),
        title: desk
            .lang
            .pick("多组共用", "Shared by several groups")
            .to_owned(),
        types: Vec::new(),
    }];
    sections.extend(model.groups.iter().map(|group| Section {
        anchor: Anchor::of("group", &group.id).id(),
        title: desk.lang.text(&group.title).to_owned(),
        types: Vec::new(),
    }));
    for ty in model.types.iter().filter(|ty| ty.body_of.is_none()) {
        let group = ty.group.as_ref();
        let group = group.and_then(|id| model.groups.iter().position(|group| group.id == *id));
        let index = group.map_or(0, |group| group + 1);
        if let Some(section) = sections.get_mut(index) {
            section.types.push(view(desk, ty));
        }
    }
    sections.retain(|section| !section.types.is_empty());
    TypesView { sections }
}

fn view<'m>(desk: Desk<'_, 'm>, ty: &'m TypeDef) -> TypeView {
    let (shape, values) = match &ty.shape {
        TypeShape::Struct(_) => ("struct", None),
        TypeShape::Enum(values) => ("enum", Some(desk.rows().enum_view(ty, values))),
        TypeShape::OneOf(_) => ("one_of", None),
    };
    let example = || desk.book.samples.named(ty, Profile::Example).pretty();
    TypeView {
        anchor: Anchor::of("type", &ty.name).id(),
        name: ty.name.clone(),
        title: desk.lang.text(&ty.title).to_owned(),
        about: ty.about.as_ref().map(|about| desk.sentence(about)),
        since: ty.since.clone(),
        given: match &ty.shape {
            TypeShape::Struct(it) => it
                .coordinates
                .as_deref()
                .map(|name| desk.rows().given(name)),
            TypeShape::Enum(_) | TypeShape::OneOf(_) => None,
        },
        shape,
        rows: desk.rows().of_type(ty, Anchor::of("type", &ty.name)),
        json: values.is_none().then(example),
        values,
        users: desk
            .book
            .users(ty)
            .iter()
            .map(|operation| desk.operation(operation))
            .collect(),
        changes: desk.history(&ty.changes),
        answers: desk.answers(desk.book.answers_in_type(ty)),
        spec: desk.spec(&ty.location),
    }
}
