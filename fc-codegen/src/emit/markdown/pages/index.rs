//! The overview of the protocol.

use super::shared::{AnswerView, Desk, OperationEntry, PortView};
use crate::emit::markdown::links::{Anchor, Link, Page};
use fc_spec::model::{Party, Subject};
use serde::Serialize;

#[derive(Debug, Serialize)]
pub(in crate::emit::markdown) struct IndexView {
    id: String,
    title: String,
    about: String,
    version: String,
    robot: PartyView,
    app: PartyView,
    host: String,
    ports: Vec<PortView>,
    pages: Vec<PageView>,
    groups: Vec<GroupView>,
    answers: Vec<AnswerView>,
    wire: String,
}

#[derive(Debug, Serialize)]
struct PartyView {
    title: String,
    about: String,
}

#[derive(Debug, Serialize)]
struct PageView {
    link: Link,
    purpose: &'static str,
}

#[derive(Debug, Serialize)]
struct GroupView {
    anchor: String,
    id: String,
    title: String,
    about: Option<String>,
    spec: Link,
    operations: Vec<OperationEntry>,
}

pub(in crate::emit::markdown) fn index(desk: Desk<'_, '_>) -> IndexView {
    let model = desk.book.model;
    let lang = desk.lang;
    let party = |party: &Party| PartyView {
        title: lang.text(&party.title).to_owned(),
        about: lang.text(&party.about).to_owned(),
    };
    let pages = Page::FIXED
        .into_iter()
        .filter(|page| !matches!(page, Page::Index));
    let pages = pages.map(|page| PageView {
        link: Link {
            text: page.title(lang).to_owned(),
            href: desk.link(page, Anchor::none()),
        },
        purpose: page.purpose(lang),
    });
    IndexView {
        id: model.protocol.id.clone(),
        title: lang.text(&model.protocol.title).to_owned(),
        about: desk.sentence(&model.protocol.about),
        version: model.protocol.version.clone(),
        robot: party(&model.protocol.robot),
        app: party(&model.protocol.app),
        host: model.transport.host.clone(),
        ports: desk.ports(),
        pages: pages.collect(),
        groups: groups(desk),
        answers: desk.answers_to(&Subject::Protocol),
        wire: desk.link(Page::Wire, Anchor::none()),
    }
}

fn groups(desk: Desk<'_, '_>) -> Vec<GroupView> {
    let model = desk.book.model;
    let mut groups: Vec<GroupView> = model
        .groups
        .iter()
        .map(|group| GroupView {
            anchor: Anchor::of("group", &group.id).id(),
            id: group.id.clone(),
            title: desk.lang.text(&group.title).to_owned(),
            about: group.about.as_ref().map(|about| desk.sentence(about)),
            spec: desk.spec(&group.location),
            operations: Vec::new(),
        })
        .collect();
    for operation in &model.operations {
        if let Some(group) = groups.iter_mut().find(|group| group.id == operation.group) {
            group.operations.push(desk.entry(operation));
        }
    }
    groups
}
