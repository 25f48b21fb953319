//! Descriptions of the parts of a package, in Chinese and in English.

use super::context::{Context, page_of};
use super::docs::Docs;
use fc_spec::model::{Group, Operation};

/// The layer below the messages.
pub const WIRE: [&str; 2] = [
    "消息之下的一层：包头、公共字段、结果码、端口和各种上限。",
    "The layer below the messages: frame header, envelopes, result codes, ports and limits.",
];

/// The envelope of requests.
pub const REQUEST_ENVELOPE: [&str; 2] = [
    "每个请求和上报都带的公共字段。",
    "The keys of every request and report, in addition to those of its body.",
];

/// The envelope of responses.
pub const RESPONSE_ENVELOPE: [&str; 2] = [
    "每个响应和应答都带的公共字段。",
    "The keys of every response and acknowledgement, in addition to those of its body.",
];

/// The tables of constants.
pub const TABLES: [&str; 2] = ["规范中的常量表。", "Tables of constants in the spec."];

/// Adds what the types of a module are: those of a group, or those that several share.
pub fn group<'m>(docs: &mut Docs<'m>, group: Option<&'m Group>) {
    if let Some(group) = group {
        docs.text(&group.title);
        docs.texts(group.about.as_ref());
    } else {
        docs.paragraph("各分组共用的类型。");
        docs.paragraph("Types that several groups share.");
    }
}

/// The result codes.
pub fn results(context: &Context<'_>) -> Docs<'static> {
    let mut docs = Docs::said(&[
        "结果码。用结果码判断成败，不要用随附的文字。",
        "Result codes. Use the code to detect success, not the text that comes with it.",
    ]);
    if let Some(page) = context.page("reference/results.md") {
        docs.paragraph(page);
    }
    docs
}

/// The errors that a command declares.
pub fn errors(context: &Context<'_>, command: &Operation) -> Docs<'static> {
    let title = &command.title;
    let mut docs = Docs::default();
    docs.paragraph(format!("{}：声明的错误", title.zh));
    docs.paragraph(format!("{}: its declared errors", title.en));
    docs.paragraph(context.links(&command.location, &page_of(command)));
    docs
}
