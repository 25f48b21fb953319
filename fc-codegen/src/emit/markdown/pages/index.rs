//! The overview of the protocol.

use super::shared::{Desk, list};
use crate::emit::markdown::links::{Anchor, Page};
use fc_spec::model::{Group, Party, Subject};
use minijinja::{Value, context};
use std::collections::HashMap;

pub(in crate::emit::markdown) fn index(desk: Desk<'_, '_>) -> Value {
    let model = desk.book.model;
    let lang = desk.lang;
    let party = |party: &Party| {
        context! {
            title => lang.text(&party.title),
            about => lang.text(&party.about),
        }
    };
    let pages = Page::FIXED
        .into_iter()
        .filter(|page| !matches!(page, Page::Index));
    let pages = pages.map(|page| {
        context! {
            link => desk.to(page.title(lang), (page, Anchor::none())),
            purpose => page.purpose(lang),
        }
    });
    context! {
        id => &model.protocol.id,
        title => lang.text(&model.protocol.title),
        about => desk.sentence(&model.protocol.about),
        version => &model.protocol.version,
        robot => party(&model.protocol.robot),
        app => party(&model.protocol.app),
        host => &model.transport.host,
        ports => desk.ports(),
        pages => list(pages),
        groups => groups(desk),
        answers => desk.answers_to(&Subject::Protocol),
        wire => desk.link(Page::Wire, Anchor::none()),
    }
}

fn groups(desk: Desk<'_, '_>) -> Vec<Value> {
    let model = desk.book.model;
    let mut operations: HashMap<&str, Vec<Value>> = HashMap::new();
    for operation in &model.operations {
        let group = operations.entry(&operation.group).or_default();
        group.push(desk.entry(operation));
    }
    let view = |group: &Group| {
        context! {
            anchor => Anchor::of("group", &group.id).id(),
            id => &group.id,
            title => desk.lang.text(&group.title),
            about => group.about.as_ref().map(|about| desk.sentence(about)),
            spec => desk.spec(&group.location),
            operations => operations.remove(group.id.as_str()).unwrap_or_default(),
        }
    };
    model.groups.iter().map(view).collect()
}
