//! Adds a new operation to the file of its group, as YAML with placeholders.

use crate::diagnostic::Faults;
use crate::format::edited;
use crate::language::Cursor;
use crate::language::grammar::FILE;
use crate::load::{TO_BE_WRITTEN_EN, TO_BE_WRITTEN_ZH, is_operation_name};
use crate::model::{Kind, Lang, Languages, Location, Model, Operation, RangeUse, Text};
use crate::source::{Edits, FileId, SourceFile, Sources, Span};
use crate::syntax::{Entry, Node, parse};
use crate::{text, text_error};

/// The description of a new operation.
#[derive(Clone, Copy, Debug)]
pub struct NewOperation<'a> {
    /// The name, in `snake_case`.
    pub name: &'a str,
    /// The id of its group.
    pub group: &'a str,
    /// The kind of operation.
    pub kind: Kind,
    /// The code. `None` selects the next free one. For a stream, it selects the code of the command that starts it.
    pub code: Option<u16>,
    /// For a stream, the command that starts it.
    pub started_by: Option<&'a str>,
    /// The language of its comments.
    pub lang: Lang,
    /// The languages of its texts.
    pub texts: Languages,
}

/// The file of a group with a new operation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Scaffold {
    /// The path of the file from the project root.
    pub path: String,
    /// The new text of the file.
    pub text: String,
    /// The line on which the operation begins, counted from 1.
    pub line: usize,
    /// The code. `None` for a stream without a code.
    pub code: Option<u16>,
}

/// The reason why an operation cannot be added.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ScaffoldError {
    /// The name is not in `snake_case`.
    Name(String),
    /// The spec has no such group.
    Group {
        /// The requested id.
        wanted: String,
        /// The ids of all groups.
        known: Vec<String>,
    },
    /// Another operation has the name.
    Taken {
        /// The name.
        name: String,
        /// The file and line of the other operation.
        place: String,
    },
    /// The operation that is to start the stream is not a command.
    NotACommand(String),
    /// The operation cannot have the code.
    Code {
        /// The code.
        code: u16,
        /// The reason, as the end of a sentence.
        why: Text,
        /// The next free code.
        next: Option<u16>,
    },
    /// The code ranges of the group have no free code.
    Codes {
        /// The group.
        group: String,
    },
    /// The section of the operation is not in block style.
    Layout {
        /// The path of the file.
        path: String,
        /// The name of the section.
        section: &'static str,
    },
}

impl ScaffoldError {
    /// Returns the message for the user.
    #[must_use]
    pub fn text(&self) -> Text {
        match self {
            Self::Name(name) => text!(
                "`{name}` 不是 snake_case 名称，例如 `get_battery`",
                "`{name}` is not a snake_case name such as `get_battery`"
            ),
            Self::Group { wanted, known } => text!(
                "没有分组 `{wanted}`；分组有：{known}",
                "there is no group `{wanted}`; the groups are {known}",
                known = Text::listed(known)
            ),
            Self::Taken { name, place } => text!(
                "已经有 `{name}`，在 {place}",
                "`{name}` already exists, in {place}"
            ),
            Self::NotACommand(name) => text!("没有指令 `{name}`", "there is no command `{name}`"),
            Self::Code {
                code,
                why,
                next: Some(next),
            } => text!(
                "0x{code:04X} {why}；下一个空闲的功能码是 0x{next:04X}",
                "0x{code:04X} {why}; the next free code is 0x{next:04X}",
                why = why
            ),
            Self::Code {
                code,
                why,
                next: None,
            } => text!("0x{code:04X} {why}", "0x{code:04X} {why}", why = why),
            Self::Codes { group } => text!(
                "分组 `{group}` 的号段中没有空闲的功能码；在 `codes.ranges` 中加一个号段，或用 --code 指定功能码",
                "no code is free in the ranges of the group `{group}`; add a range to `codes.ranges`, or pass a code with --code"
            ),
            Self::Layout { path, section } => text!(
                "{path} 中的 `{section}` 写在大括号中；改成逐行书写，或手工加上接口",
                "`{section}` in {path} is written in braces; write it in block style, or add the operation by hand"
            ),
        }
    }
}

text_error!(ScaffoldError);

/// Adds the YAML of a new operation after the last one of its kind in the file of its group.
///
/// [`load`](crate::load::load) reports other errors of the result, such as a name that is not usable in code.
///
/// # Errors
/// [`ScaffoldError`] if the operation cannot be added.
pub fn scaffold(
    model: &Model,
    sources: &Sources,
    new: &NewOperation<'_>,
) -> Result<Scaffold, ScaffoldError> {
    if !is_operation_name(new.name) {
        return Err(ScaffoldError::Name(new.name.to_owned()));
    }
    let group = model.groups.iter().find(|group| group.id == new.group);
    let group = group.ok_or_else(|| ScaffoldError::Group {
        wanted: new.group.to_owned(),
        known: model.groups.iter().map(|group| group.id.clone()).collect(),
    })?;
    let (section, usage) = match new.kind {
        Kind::Command => (FILE.commands.name, Some(RangeUse::Commands)),
        Kind::Report => (FILE.reports.name, Some(RangeUse::Reports)),
        Kind::Stream => (FILE.streams.name, None),
    };
    if let Some(other) = model.operation(new.name) {
        return Err(ScaffoldError::Taken {
            name: new.name.to_owned(),
            place: place(&other.location),
        });
    }
    let starter = new.started_by.map(|name| {
        let starter = model.operation(name);
        let starter = starter.filter(|it| it.kind() == Kind::Command);
        starter.ok_or_else(|| ScaffoldError::NotACommand(name.to_owned()))
    });
    let starter = starter.transpose()?;
    let next = usage.and_then(|usage| model.next_code(usage, Some(new.group)));
    let shared = starter.and_then(|starter| starter.code.value);
    let code = new.code.or(shared).or(next);
    if code.is_none() && usage.is_some() {
        return Err(ScaffoldError::Codes {
            group: new.group.to_owned(),
        });
    }
    if let Some(code) = code
        && let Some(why) = objection(model, code, new)
    {
        return Err(ScaffoldError::Code { code, why, next });
    }

    let path = &group.location.file;
    let files = sources.iter().find(|(_, source)| source.path == *path);
    let layout = || ScaffoldError::Layout {
        path: path.clone(),
        section,
    };
    let (file, source) = files.ok_or_else(layout)?;
    let tree = parse(file, &source.text, &mut Faults::new()).ok_or_else(layout)?;
    let insertion = match tree.root().entry(section) {
        Some(entry) => inside(source, entry).ok_or_else(layout)?,
        None => Insertion::of_section(source, tree.root(), section),
    };
    let heading = insertion.heading.then(|| format!("{section}:\n"));
    let heading = heading.unwrap_or_default();
    let block = insertion.indented(&beginning(new, code));
    let before = source.text.get(..insertion.at).ok_or_else(layout)?;
    let mut lines = before
        .split('\n')
        .rev()
        .map(|line| line.trim_end_matches('\r'));
    let gap = match (lines.next(), lines.next()) {
        (Some(""), Some("")) => "",
        (Some(""), _) => "\n",
        _ => "\n\n",
    };
    let below = if insertion.is_above { "\n" } else { "" };
    let mut edits = Edits::default();
    let at = Span::point(file, insertion.at);
    edits.replace(at, format!("{gap}{heading}{block}{below}"));
    let text = edited(source, &edits).text;
    let line = line_of(&SourceFile::new(path, &text), section, new.name);
    Ok(Scaffold {
        path: path.clone(),
        line: line.ok_or_else(layout)?,
        text,
        code,
    })
}

/// Returns the line on which an operation begins.
fn line_of(source: &SourceFile, section: &str, name: &str) -> Option<usize> {
    let tree = parse(FileId(0), &source.text, &mut Faults::new())?;
    let entry = tree.root().entry(section)?.value.entry(name)?;
    Some(source.line(entry.key.span().start))
}

fn place(location: &Location) -> String {
    format!("{}:{}", location.file, location.line)
}

/// Returns the reason why a new operation cannot have this code, or `None` if it can.
fn objection(model: &Model, code: u16, new: &NewOperation<'_>) -> Option<Text> {
    let mut operations = model.operations.iter();
    let is_shared = |operation: &Operation| new.started_by == Some(operation.name.as_str());
    let other = operations.find(|it| it.code.value == Some(code) && !is_shared(it));
    if let Some(other) = other {
        let at = place(&other.location);
        return Some(text!(
            "是 `{name}` 的功能码，在 {at}",
            "is the code of `{name}`, in {at}",
            name = other.name
        ));
    }
    if model.retired.iter().any(|retired| retired.code == code) {
        return Some(text!(
            "已退役，不能再用",
            "is retired and must not be used again"
        ));
    }
    let mut ranges = model.ranges.iter();
    let Some(range) = ranges.find(|range| range.has(code)) else {
        return Some(text!("不在任何号段内", "is outside all code ranges"));
    };
    let why = match (range.usage, new.kind) {
        (RangeUse::Historic, Kind::Command | Kind::Report) => {
            text!("不再接受新接口", "is closed for new operations")
        }
        (RangeUse::Reserved, _) => text!("是预留的", "is reserved"),
        (RangeUse::Commands, Kind::Report) => text!(
            "用于指令，而这是上报",
            "is for commands, and this is a report"
        ),
        (RangeUse::Reports, Kind::Command) => text!(
            "用于上报，而这是指令",
            "is for reports, and this is a command"
        ),
        (RangeUse::PassThrough, Kind::Report | Kind::Stream) => {
            text!(
                "透传给上装，只能有指令",
                "is passed through to the upper body and contains only commands"
            )
        }
        _ if !range.groups.is_empty() && !range.groups.iter().any(|it| it == new.group) => text!(
            "用于分组 {groups}",
            "is for {groups}",
            groups = Text::listed(&range.groups)
        ),
        _ => return None,
    };
    let (first, last) = (&range.first_spelling, &range.last_spelling);
    Some(text!(
        "在号段 {first} 到 {last} 内，这个号段{why}",
        "is in the range {first} to {last}, which {why}",
        why = why
    ))
}

/// The position of a new operation.
struct Insertion {
    /// A byte offset, at the start of a line or at the end of the file.
    at: usize,
    /// The indentation of the name of the operation.
    indent: usize,
    /// `true` if the key of the section is missing and must be added.
    heading: bool,
    /// `true` if another section follows.
    is_above: bool,
}

impl Insertion {
    /// Returns the position of a section that a file lacks.
    ///
    /// It is above the first section that comes later in the grammar, and above the comments of that section.
    fn of_section(source: &SourceFile, root: Node<'_>, section: &str) -> Self {
        let order = Cursor::file(root);
        let rank = order.rank(section);
        let next = root.entries().find(|entry| order.rank(entry.name()) > rank);
        let at = next.map(|next| {
            let comments = next.key.comments().map(|span| span.start);
            comments.fold(next.key.span().start, usize::min)
        });
        Self {
            at: at.unwrap_or(source.text.len()),
            indent: 2,
            heading: true,
            is_above: at.is_some(),
        }
    }

    fn indented(&self, lines: &str) -> String {
        let indent = " ".repeat(self.indent);
        let lines = lines.lines().flat_map(|line| [&indent, line, "\n"]);
        lines.collect()
    }
}

/// Returns the position after the last operation of a section. `None` if the section is not in block style.
fn inside(source: &SourceFile, section: Entry<'_>) -> Option<Insertion> {
    let value = section.value.span();
    let first = section.value.entries().next()?;
    let key = source.line_col(first.key.span().start);
    if key.line == source.line_col(section.key.span().start).line {
        return None;
    }
    Some(Insertion {
        at: source.next_line(source.line(value.end)),
        indent: key.column - 1,
        heading: false,
        is_above: false,
    })
}

/// Returns the YAML of an operation with placeholders. It is valid, and a comment marks each part to write.
fn beginning(new: &NewOperation<'_>, code: Option<u16>) -> String {
    let name = new.name;
    let code = code.map_or_else(|| "unassigned".to_owned(), |code| format!("0x{code:04X}"));
    let (zh, en) = (TO_BE_WRITTEN_ZH, TO_BE_WRITTEN_EN);
    let mut field = vec!["type: i32".to_owned(), "example: 1".to_owned()];
    let mut head = vec![format!("{name}:"), format!("code: {code}")];
    if new.texts.include(Lang::Zh) {
        field.push(format!("zh: {zh}）"));
        head.push(format!("zh: {zh}：做什么）"));
    }
    if new.texts.include(Lang::En) {
        field.push(format!("en: {en})"));
        head.push(format!("en: {en}, what it does)"));
    }
    let field = format!("value: {{ {} }}", field.join(", "));
    let head = head.join("\n  ") + "\n";
    let rest = match new.kind {
        Kind::Report => {
            format!("  source: {{ sections: [] }}\n  body:\n    data:\n      {field}\n")
        }
        Kind::Stream => {
            let started_by = new.started_by.map(|by| format!("  started_by: {by}\n"));
            let or_app = new.lang.pick("或 app", "or app");
            let bytes = new.lang.pick(
                "原始字节改写 content: 和媒体类型",
                "for raw bytes, write content: and their media type instead",
            );
            format!(
                "  from: robot # {or_app}\n{}  source: {{ sections: [] }}\n  \
                   body: # {bytes}\n    {field}\n",
                started_by.unwrap_or_default()
            )
        }
        Kind::Command => {
            let effects = new.lang.pick(
                "或 config、motion、unknown；客户端只重发 read 指令",
                "or config, motion, unknown: clients resend only read commands",
            );
            let [request, response] =
                [("请求", "request"), ("响应", "response")].map(|(zh, en)| {
                    let note = text!("{zh}没有键时删去", "delete it if the {en} has no keys");
                    new.lang.text(&note).to_owned()
                });
            format!(
                "  effect: read # {effects}\n  \
                   source: {{ sections: [] }}\n  \
                   request: # {request}\n    data:\n      {field}\n  \
                   response: # {response}\n    data:\n      {field}\n"
            )
        }
    };
    head + &rest
}
