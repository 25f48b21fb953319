//! What a package says of its own parts, which no spec says: in Chinese and in English.

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
    "每个请求和主动上报都带的公共字段。",
    "The keys that every request and every report carries beside its own.",
];

/// The envelope of responses.
pub const RESPONSE_ENVELOPE: [&str; 2] = [
    "每个响应和确认都带的公共字段。",
    "The keys that every response and every acknowledgement carries beside its own.",
];

/// The tables of constants.
pub const TABLES: [&str; 2] = [
    "规范公布的常量表。",
    "Tables of constants that the spec publishes.",
];

/// Adds what the types of a module are: those of a group, or those that several share.
pub fn group<'m>(docs: &mut Docs<'m>, group: Option<&'m Group>) {
    if let Some(group) = group {
        docs.text(&group.title);
        docs.texts(group.about.as_ref());
    } else {
        docs.paragraph("各指令组共用的类型。");
        docs.paragraph("Types that several groups share.");
    }
}

/// The result codes.
pub fn results(context: &Context<'_>) -> Docs<'static> {
    let mut docs = Docs::said(&[
        "结果码。只依据它判断成败，不依据旁边的文字。",
        "Result codes. Go by them and never by the text beside them.",
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
