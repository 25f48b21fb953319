//! The types that operations share.

use super::shared::{Desk, list};
use crate::emit::markdown::links::Anchor;
use crate::sample::Profile;
use fc_spec::model::{TypeDef, TypeShape};
use minijinja::value::Serde;
use minijinja::{Value, context};

pub(in crate::emit::markdown) fn types(desk: Desk<'_, '_>) -> Value {
    let model = desk.book.model;
    let of_groups = model.groups.iter();
    let of_groups = of_groups.map(|it| {
        let anchor = Anchor::of("group", &it.id).id();
        (anchor, desk.lang.text(&it.title), Vec::new())
    });
    let shared = desk.lang.pick("多组共用", "Shared by several groups");
    let mut sections = vec![("shared-by-several-groups".to_owned(), shared, Vec::new())];
    sections.extend(of_groups);
    for ty in model.types.iter().filter(|ty| ty.body_of.is_none()) {
        let group = ty.group.as_ref();
        let group = group.and_then(|id| model.groups.iter().position(|group| group.id == *id));
        let index = group.map_or(0, |group| group + 1);
        if let Some((_, _, types)) = sections.get_mut(index) {
            types.push(view(desk, ty));
        }
    }
    let sections = sections
        .into_iter()
        .filter(|(_, _, types)| !types.is_empty());
    let sections = sections.map(|(anchor, title, types)| context! { anchor, title, types });
    context! { sections => list(sections) }
}

fn view<'m>(desk: Desk<'_, 'm>, ty: &'m TypeDef) -> Value {
    let (shape, values) = match &ty.shape {
        TypeShape::Struct(_) => ("struct", None),
        TypeShape::Enum(values) => ("enum", Some(desk.enum_view(ty, values))),
        TypeShape::OneOf(_) => ("one_of", None),
    };
    let example = || desk.book.samples.named(ty, Profile::Example).pretty();
    let users = desk.book.users(ty).iter();
    let users = users.map(|operation| desk.operation(operation));
    context! {
        anchor => Anchor::of("type", &ty.name).id(),
        name => &ty.name,
        title => desk.lang.text(&ty.title),
        about => ty.about.as_ref().map(|about| desk.sentence(about)),
        since => &ty.since,
        given => match &ty.shape {
            TypeShape::Struct(it) => it
                .coordinates
                .as_deref()
                .map(|name| desk.given(name)),
            TypeShape::Enum(_) | TypeShape::OneOf(_) => None,
        },
        shape,
        rows => Serde(desk.type_rows(ty, Anchor::of("type", &ty.name))),
        json => values.is_none().then(example),
        values,
        users => list(users),
        changes => desk.history(&ty.changes),
        answers => desk.answers(desk.book.answers_in_type(ty)),
        spec => desk.spec(&ty.location),
    }
}
