//! Checks references to declared things, and things without a reference.

use super::iter::called;
use crate::diagnostic::{Diagnostic, FaultCode, Faults, nearest};
use crate::language::Occurrence;
use crate::language::grammar::{
    ACCEPTED, AnyOperation, Audience, Command, DECLARED, Declared, Entity, FILE, Home, Named,
    Report, STREAM,
};
use crate::load::draft::Draft;
use crate::model::{Kind, Text};
use crate::source::Span;
use crate::text;
use std::collections::HashSet;

/// The things that references of one kind may name.
struct Things<'d> {
    /// The parts of the language that can declare them.
    kinds: &'static [&'static str],
    /// The name of the kind in a sentence.
    what: Text,
    home: Home,
    declared: Vec<(&'d str, Span)>,
    unknown: FaultCode,
    /// The code of a thing without a reference, if it is an error.
    unused: Option<FaultCode>,
}

/// Checks that every referenced name is declared.
pub(super) fn check_declared(draft: &Draft<'_>, faults: &mut Faults) {
    for things in &things(draft) {
        if draft.invalid.contains(FILE.availability.name)
            && matches!(things.home, Home::Availability(_))
        {
            continue;
        }
        let known = things.names();
        for (occurrence, name) in draft.references_to(things.kinds) {
            if known.contains(name) {
                continue;
            }
            let fault = misfit(draft, occurrence, name).unwrap_or_else(|| {
                let message = things.unknown_message(name);
                Diagnostic::error(things.unknown, occurrence.node.span(), message)
            });
            let names = things.declared.iter().map(|(name, _)| *name);
            faults.push(fault.suggest(nearest(name, names), things.declare()));
        }
    }
}

/// Checks that every declared thing has a reference. Skips a thing that a misspelled reference may mean. One audience
/// may have no reference: it gets everything except the things limited to other audiences.
pub(super) fn check_unused(draft: &Draft<'_>, faults: &mut Faults) {
    for things in &things(draft) {
        let Some(code) = things.unused else {
            continue;
        };
        let known = things.names();
        let mut used: HashSet<&str> = draft
            .references_to(things.kinds)
            .map(|(_, name)| name)
            .collect();
        let slips: Vec<&str> = used.difference(&known).copied().collect();
        for slip in slips {
            let names = things.declared.iter().map(|(name, _)| *name);
            used.extend(nearest(slip, names));
        }
        let declared = things.declared.iter();
        let unused: Vec<_> = declared.filter(|(name, _)| !used.contains(name)).collect();
        let is_one_audience = things.kinds == Audience::KINDS && unused.len() == 1;
        if is_one_audience && things.declared.len() > 1 {
            continue;
        }
        for (name, span) in unused {
            let fault = Diagnostic::error(code, *span, things.unused_message(name));
            faults.push(fault.note(things.use_or_delete()));
        }
    }
}

impl<'d> Things<'d> {
    fn names(&self) -> HashSet<&'d str> {
        self.declared.iter().map(|(name, _)| *name).collect()
    }

    fn unknown_message(&self, name: &str) -> Text {
        let what = &self.what;
        match self.home {
            Home::Availability(_) => text!(
                "没有名为 `{name}` 的{what}",
                "there is no {what} `{name}`",
                what = what
            ),
            Home::Operations | Home::Section { .. } => text!(
                "没有{what} `{name}`",
                "there is no {what} `{name}`",
                what = what
            ),
        }
    }

    /// Returns the note for an unknown name without a similar one.
    fn declare(&self) -> Option<Text> {
        match self.home {
            Home::Operations => None,
            Home::Section { key, .. } => {
                Some(text!("在 `{key}:` 下声明", "declare it under `{key}:`"))
            }
            Home::Availability(key) => Some(text!(
                "在 `availability: {{ {key} }}` 下声明",
                "declare it under `availability: {{ {key} }}`"
            )),
        }
    }

    fn unused_message(&self, name: &str) -> Text {
        let what = &self.what;
        match self.home {
            Home::Availability(_) => text!(
                "没有 `available` 用到{what} `{name}`",
                "no `available` names the {what} `{name}`",
                what = what
            ),
            _ if self.kinds == Entity::KINDS => text!(
                "没有字段指向{what} `{name}`",
                "no field refers to the {what} `{name}`",
                what = what
            ),
            Home::Operations | Home::Section { .. } => text!(
                "{what} `{name}` 没有用到",
                "the {what} `{name}` is not used",
                what = what
            ),
        }
    }

    /// Returns the note for a thing without a reference.
    fn use_or_delete(&self) -> Text {
        match self.home {
            Home::Section { by, .. } if self.kinds == Entity::KINDS => text!(
                "在存放它的 ID 的字段上写 `{by}`，或将它删除",
                "write `{by}` on a field that holds its IDs, or delete it"
            ),
            Home::Section { by, .. } => text!(
                "在适用的地方写 `{by}`，或将它删除",
                "write `{by}` where it applies, or delete it"
            ),
            _ if self.kinds == Audience::KINDS => text!(
                "在只面向它的内容上写 `available: {{ for: … }}`，或将它删除",
                "write `available: {{ for: … }}` on the things that only it has, or delete it"
            ),
            Home::Availability(_) | Home::Operations => text!(
                "在某个 `available` 中用到它，或将它删除",
                "name it in an `available`, or delete it"
            ),
        }
    }
}

/// Returns the error for a reference to an operation of another kind.
fn misfit(draft: &Draft<'_>, occurrence: &Occurrence<'_>, name: &str) -> Option<Diagnostic> {
    let is_operation = [Command::KINDS, Report::KINDS].contains(&occurrence.names());
    let mut operations = draft.operations.iter();
    let other = operations.find(|it| is_operation && it.item.name == name)?;
    let kind = called(other.item.kind());
    let is = |key: &str| occurrence.key == Some(key);
    let (code, message) = if is(ACCEPTED.after.name) {
        let message = text!(
            "`after` 应为指令，而 `{name}` 是{kind}",
            "`after` needs a command, but `{name}` is a {kind}",
            kind = kind
        );
        (FaultCode::NotACommand, message)
    } else if is(STREAM.started_by.name) || is(STREAM.stopped_by.name) {
        let message = text!(
            "开始和停止数据流的应为指令，而 `{name}` 是{kind}",
            "a stream needs a command to start or stop it, but `{name}` is a {kind}",
            kind = kind
        );
        (FaultCode::NotACommand, message)
    } else {
        let message = text!(
            "`sets_off` 应为上报，而 `{name}` 是{kind}",
            "`sets_off` needs a report, but `{name}` is a {kind}",
            kind = kind
        );
        (FaultCode::NotAReport, message)
    };
    let fault = Diagnostic::error(code, occurrence.node.span(), message);
    Some(fault.also_declared(other.origin.name()))
}

/// Returns all things that references may name, except types.
fn things<'d>(draft: &'d Draft<'_>) -> Vec<Things<'d>> {
    let mut things = vec![
        operations::<Command>(draft, text!("指令", "command"), |kind| {
            kind == Kind::Command
        }),
        operations::<Report>(draft, text!("上报", "report"), |kind| {
            kind == Kind::Report
        }),
        operations::<AnyOperation>(draft, text!("接口", "operation"), |_| true),
    ];
    things.extend(DECLARED.iter().map(|of| declared(draft, of)));
    things
}

fn declared<'d>(draft: &'d Draft<'_>, of: &'static Declared) -> Things<'d> {
    let things = draft.declared.iter();
    let things = things.filter(|(table, _)| table.name == of.table.name);
    let names = things.map(|(_, it)| (it.key.as_str().unwrap_or_default(), it.name()));
    Things {
        kinds: std::slice::from_ref(&of.table.name),
        what: text!("{zh}", "{en}", zh = of.table.name_zh, en = of.table.name),
        home: of.home,
        declared: names.collect(),
        unknown: of.unknown,
        unused: Some(of.unused),
    }
}

fn operations<'d, T: Named>(
    draft: &'d Draft<'_>,
    what: Text,
    fits: fn(Kind) -> bool,
) -> Things<'d> {
    let operations = draft.operations.iter();
    let operations = operations.filter(|it| fits(it.item.kind()));
    let names = operations.map(|it| (it.item.name.as_str(), it.origin.name()));
    Things {
        kinds: T::KINDS,
        what,
        home: Home::Operations,
        declared: names.collect(),
        unknown: FaultCode::UnknownOperation,
        unused: None,
    }
}
