//! Descriptions of the parts of a package, in Chinese and in English.

use super::context::{Context, page_of};
use super::docs::Docs;
use super::facts;
use super::items::Spelled;
use fc_spec::model::{
    CodeRange, DeclaredError, Direction, Entity, EnvelopeField, Group, Model, Operation,
    ResultCode, Table, TypeDef,
};

/// The description of the layer below the messages.
pub const WIRE: [&str; 2] = [
    "消息之下的一层：包头、公共字段、结果码、端口和各种上限。",
    "The layer below the messages: frame header, envelopes, result codes, ports and limits.",
];

/// An envelope, as a type of the package.
pub struct Envelope<'p, 'm> {
    /// The direction of the messages.
    pub side: &'static str,
    /// The name of the type.
    pub name: &'static str,
    /// The description of the type.
    pub about: [&'static str; 2],
    /// The keys.
    pub fields: &'p [Spelled<'m, EnvelopeField>],
}

/// Returns the envelopes of requests and of responses.
pub fn envelopes<'p, 'm>(context: &'p Context<'m>) -> [Envelope<'p, 'm>; 2] {
    let request = Envelope {
        side: Direction::Request.name(),
        name: "RequestEnvelope",
        about: [
            "每个请求和上报都带的公共字段。",
            "The keys of every request and report, in addition to those of its body.",
        ],
        fields: &context.package.request_envelope,
    };
    let response = Envelope {
        side: Direction::Response.name(),
        name: "ResponseEnvelope",
        about: [
            "每个响应和应答都带的公共字段。",
            "The keys of every response and acknowledgement, in addition to those of its body.",
        ],
        fields: &context.package.response_envelope,
    };
    [request, response]
}

/// The description of the tables of constants.
pub const TABLES: [&str; 2] = ["规范中的常量表。", "Tables of constants in the spec."];

/// Adds the description of a module's types: those of a group, or the types that several groups share.
pub fn group<'m>(docs: &mut Docs<'m>, group: Option<&'m Group>) {
    if let Some(group) = group {
        docs.text(&group.title);
        docs.texts(group.about.as_ref());
    } else {
        docs.both(["各分组共用的类型。", "Types that several groups share."]);
    }
}

/// Returns the description of the result codes.
pub fn results(context: &Context<'_>) -> Docs<'static> {
    let mut docs = Docs::said([
        "结果码。用结果码判断成败，不要用随附的文字。",
        "Result codes. Use the code to detect success, not the text that comes with it.",
    ]);
    if let Some(page) = context.page("reference/results.md") {
        docs.paragraph(page);
    }
    docs
}

/// Returns the description of a result code.
pub fn result(result: &ResultCode) -> Docs<'_> {
    let mut docs = Docs::titled(&result.text);
    docs.text(&result.about);
    docs
}

/// Returns the description of the errors that a command declares.
pub fn errors(context: &Context<'_>, command: &Operation) -> Docs<'static> {
    let title = &command.title;
    let zh = format!("{}：声明的错误", title.zh);
    let mut docs = Docs::said([zh, format!("{}: its declared errors", title.en)]);
    docs.paragraph(context.links(&command.location, &page_of(command)));
    docs
}

/// Returns the description of an error that a command declares.
pub fn error<'m>(error: &'m DeclaredError, result: &'m ResultCode) -> Docs<'m> {
    Docs::titled(error.cause.as_ref().unwrap_or(&result.text))
}

/// Returns the description of the protocol.
pub fn protocol(model: &Model) -> Docs<'_> {
    let mut docs = Docs::titled(&model.protocol.title);
    docs.text(&model.protocol.about);
    docs.paragraph(format!("Version {} of the spec.", model.protocol.version));
    docs
}

/// Adds the version of the spec.
pub fn version(docs: &mut Docs<'_>, model: &Model) {
    let version = &model.protocol.version;
    docs.sentences([
        format!("规范版本 {version}。"),
        format!("Version {version} of the spec."),
    ]);
}

/// Returns the description of a table of constants.
pub fn table<'m>(context: &Context<'_>, table: &'m Table) -> Docs<'m> {
    let mut docs = Docs::titled(&table.title);
    docs.text(&table.about);
    docs.paragraph(table.kept.as_deref().map_or_else(String::new, facts::kept));
    docs.paragraph(context.links(&table.location, "reference/tables.md"));
    docs
}

/// Returns the description of an entity's id type.
pub fn id(context: &Context<'_>, entity: &Entity) -> Docs<'static> {
    let title = &entity.title;
    let zh = format!("{}：ID", title.zh);
    let mut docs = Docs::said([zh, format!("{}: its ID", title.en)]);
    docs.paragraph(context.links(&entity.location, "reference/entities.md"));
    docs
}

/// Returns the description of an enum. `open` adds a paragraph about values that are not in the spec.
pub fn enumeration<'m>(
    context: &Context<'_>,
    ty: &'m TypeDef,
    open: impl FnOnce(&mut Docs<'m>),
) -> Docs<'m> {
    let mut docs = Docs::titled(&ty.title);
    docs.texts(ty.about.as_ref());
    open(&mut docs);
    docs.paragraph(facts::since(ty.since.as_ref()).unwrap_or_default());
    docs.paragraph(context.links(&ty.location, "reference/types.md"));
    docs
}

/// Returns the title of the method for a range of codes, or for codes that are not in the spec.
pub fn codes(range: Option<&CodeRange>) -> Docs<'_> {
    let Some(range) = range else {
        return Docs::said([
            "功能码不在规范中的指令。",
            "Commands with a code that is not in the spec.",
        ]);
    };
    let mut docs = Docs::titled(&range.text);
    let (first, last) = (&range.first_spelling, &range.last_spelling);
    docs.paragraph(format!(
        "Codes {first} to {last} without a separate method."
    ));
    docs
}

/// Returns the description of such a method with its default behaviour.
pub fn refused(range: Option<&CodeRange>) -> Docs<'_> {
    let mut docs = codes(range);
    docs.both([
        "不实现此方法时，按未知指令拒绝。",
        "Without this method, the robot refuses them as unknown commands.",
    ]);
    docs
}
