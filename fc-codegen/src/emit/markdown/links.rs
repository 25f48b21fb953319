//! The pages, their paths, and links between them.
//!
//! Anchors are explicit `<a id="…"></a>`. Slugs of headings differ between renderers, and headings differ between
//! languages.

use fc_spec::model::Lang;
use fc_spec::model::{Kind, Location, Operation};
use serde::Serialize;
use std::fmt::Write as _;

/// A page of the reference.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Page<'m> {
    Index,
    Wire,
    Codes,
    Types,
    Results,
    Tables,
    Entities,
    Places,
    Glossary,
    Changelog,
    OpenQuestions,
    Language,
    Errors,
    Operation(&'m Operation),
}

impl Page<'_> {
    /// The pages except those of operations, in the order of the overview.
    pub(super) const FIXED: [Page<'static>; 13] = [
        Page::Index,
        Page::Wire,
        Page::Codes,
        Page::Types,
        Page::Results,
        Page::Tables,
        Page::Entities,
        Page::Places,
        Page::Glossary,
        Page::Changelog,
        Page::OpenQuestions,
        Page::Language,
        Page::Errors,
    ];

    /// Returns the path below `reference/`.
    pub(super) fn path(self) -> String {
        match self {
            Self::Index => "index.md".to_owned(),
            Self::Wire => "wire.md".to_owned(),
            Self::Codes => "codes.md".to_owned(),
            Self::Types => "types.md".to_owned(),
            Self::Results => "results.md".to_owned(),
            Self::Tables => "tables.md".to_owned(),
            Self::Entities => "entities.md".to_owned(),
            Self::Places => "places.md".to_owned(),
            Self::Glossary => "glossary.md".to_owned(),
            Self::Changelog => "changelog.md".to_owned(),
            Self::OpenQuestions => "open-questions.md".to_owned(),
            Self::Language => "language.md".to_owned(),
            Self::Errors => "errors.md".to_owned(),
            Self::Operation(operation) => {
                let directory = match operation.kind() {
                    Kind::Command => "commands",
                    Kind::Report => "reports",
                    Kind::Stream => "streams",
                };
                format!("{directory}/{}.md", operation.name)
            }
        }
    }

    /// Returns the title that other pages use.
    pub(super) fn title(self, lang: Lang) -> &'static str {
        match self {
            Self::Index => lang.pick("协议总览", "Protocol overview"),
            Self::Wire => lang.pick("传输与帧", "Transport and frames"),
            Self::Codes => lang.pick("功能码", "Command codes"),
            Self::Types => lang.pick("公共类型", "Shared types"),
            Self::Results => lang.pick("结果码", "Result codes"),
            Self::Tables => lang.pick("常量表", "Tables"),
            Self::Entities => lang.pick("实体与 ID", "Entities and their IDs"),
            Self::Places => lang.pick("坐标系与存储位置", "Coordinates and storage"),
            Self::Glossary => lang.pick("术语", "Glossary"),
            Self::Changelog => lang.pick("变更记录", "Changelog"),
            Self::OpenQuestions => lang.pick("疑问与决定", "Open questions"),
            Self::Language => lang.pick("规范的写法", "The spec language"),
            Self::Errors => lang.pick("规范检查错误", "Errors in the spec"),
            Self::Operation(_) => lang.pick("接口", "Operation"),
        }
    }

    /// Returns the description for the overview.
    pub(super) fn purpose(self, lang: Lang) -> &'static str {
        match self {
            Self::Index | Self::Operation(_) => "",
            Self::Wire => lang.pick(
                "端口、包头的每个字节、数据类型、压缩、校验、公共字段、超时与限制",
                "Ports, every byte of the header, kinds, compression, digest, envelope, timeouts and limits",
            ),
            Self::Codes => lang.pick(
                "已用、未分配和退役的功能码，各号段的用途",
                "Codes in use, not assigned and retired; the ranges and their purpose",
            ),
            Self::Types => lang.pick("多个接口共用的结构与枚举", "Structs and enums shared by several operations"),
            Self::Results => lang.pick("响应和应答中结果码的取值", "Result codes of responses and acknowledgements"),
            Self::Tables => lang.pick("格口布局等随协议发布的常量", "Constants published with the protocol, such as cell layouts"),
            Self::Entities => lang.pick(
                "各种 ID 对应的实体，来自哪些消息，用在哪些消息中",
                "The entities that IDs identify, and the messages that provide or ask for them",
            ),
            Self::Places => lang.pick(
                "各坐标系和存储位置，以及使用它们的消息",
                "Coordinate systems of positions, and stores of settings and data",
            ),
            Self::Glossary => lang.pick(
                "协议用语的含义、英文说法和出现的地方",
                "Terms of the protocol, with their meaning, Chinese words and places",
            ),
            Self::Changelog => lang.pick("按日期排列的全部变更", "All changes by date"),
            Self::OpenQuestions => lang.pick(
                "源文档的每一处缺失与矛盾，以及本规范的答复",
                "Every gap and contradiction in the source document, and this spec's answer",
            ),
            Self::Language => lang.pick(
                "YAML 中可以写的每一个键：含义、取值、是否必填",
                "Every key of the YAML, with its meaning and values",
            ),
            Self::Errors => lang.pick(
                "检查 YAML 时可能报告的每一种错误，以及改法",
                "Every error of the checks, and how to fix it",
            ),
        }
    }

    /// Returns the relative path from this page to `reference/`.
    fn up(self) -> &'static str {
        match self {
            Self::Operation(_) => "../",
            _ => "",
        }
    }

    /// Returns a link to a place on this or another page.
    pub(super) fn link(self, (page, anchor): (Page<'_>, Anchor)) -> String {
        let (here, there) = (self.path(), page.path());
        if here == there && !anchor.0.is_empty() {
            return format!("#{}", anchor.0);
        }
        let hash = if anchor.0.is_empty() { "" } else { "#" };
        format!("{}{there}{hash}{}", self.up(), anchor.0)
    }

    /// Returns a link to this page in the other language.
    pub(super) fn link_to_other(self, lang: Lang) -> String {
        // `reference/` and `en/reference/` differ only in `en/`.
        let reference = lang.pick("../en/reference/", "../../reference/");
        format!("{}{reference}{}", self.up(), self.path())
    }

    /// Returns a link to a place of the spec by its name, which is the anchor on the site's page of the file. The
    /// reference is two directories below the root, and three in English.
    pub(super) fn link_to_spec(self, location: &Location, lang: Lang) -> String {
        let to_root = lang.pick("../../", "../../../");
        format!("{}{to_root}{}#{}", self.up(), location.file, location.name)
    }
}

/// A place on a page.
#[derive(Clone, Debug)]
pub(super) struct Anchor(String);

impl Anchor {
    /// The top of the page.
    pub(super) fn none() -> Self {
        Self(String::new())
    }

    /// A section.
    pub(super) fn named(name: &str) -> Self {
        Self(name.to_owned())
    }

    /// One of several similar places, such as `type-Station`.
    pub(super) fn of(kind: &str, name: &str) -> Self {
        Self(format!("{kind}-{name}"))
    }

    /// A place within another one, such as `request-data-name`. Characters that ids and links cannot contain are
    /// escaped.
    pub(super) fn step(&self, key: &str) -> Self {
        let mut id = format!("{}-", self.0);
        for character in key.chars() {
            if character.is_alphanumeric() || character == '_' {
                id.push(character);
            } else {
                // Writing to a String cannot fail.
                let _ = write!(id, ".{:X}.", u32::from(character));
            }
        }
        Self(id)
    }

    /// Returns the id for the page.
    pub(super) fn id(self) -> String {
        self.0
    }
}

/// A link of a page: its label in Markdown and its target.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Link {
    pub(super) text: String,
    pub(super) href: String,
}
