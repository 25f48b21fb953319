//! Checks references to declared things, and things without a reference.

use super::iter::called;
use crate::diagnostic::{Diagnostic, FaultCode, Faults, nearest};
use crate::language::Occurrence;
use crate::language::grammar::{
    ACCEPTED, AVAILABILITY, AnyOperation, Audience, COMMON, Command, CoordinateSystem, Entity,
    FIELD, FILE, Machine, Named, Report, STREAM, Series, Store,
};
use crate::load::draft::{Draft, Sourced};
use crate::model::{Declared, Kind, Text};
use crate::source::Span;
use crate::text;
use std::collections::HashSet;

/// The things that references of one kind may name.
struct Things<'d> {
    /// The kind of the references in the grammar.
    kinds: &'static [&'static str],
    /// The name of the kind in a sentence.
    what: Text,
    home: Home,
    declared: Vec<(&'d str, Span)>,
    unknown: FaultCode,
    /// The code of a thing without a reference, if it is an error.
    unused: Option<FaultCode>,
}

/// The part of a spec that declares things.
#[derive(Clone, Copy)]
enum Home {
    /// The sections of operations.
    Operations,
    /// A section; `by` is the key of the references.
    Section { key: &'static str, by: &'static str },
    /// A key of `availability`.
    Availability(&'static str),
}

/// Checks that every referenced name is declared.
pub(super) fn check_declared(draft: &Draft<'_>, faults: &mut Faults) {
    for things in &things(draft) {
        if draft.availability.is_broken && matches!(things.home, Home::Availability(_)) {
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
    Some(fault.also(other.origin.name(), text!("在这里声明", "declared here")))
}

/// Returns all things that references may name, except types.
fn things<'d>(draft: &'d Draft<'_>) -> Vec<Things<'d>> {
    let words = &draft.availability;
    let command = text!("指令", "command");
    let report = text!("上报", "report");
    let operation = text!("接口", "operation");
    let audience = text!("受众", "audience");
    let machine = text!("机型", "line of machines");
    let series = text!("版本系列", "series of releases");
    vec![
        operations::<Command>(draft, command, |kind| kind == Kind::Command),
        operations::<Report>(draft, report, |kind| kind == Kind::Report),
        operations::<AnyOperation>(draft, operation, |_| true),
        section::<Entity>(
            text!("实体", "entity"),
            [FILE.entities.name, FIELD.refers.name],
            names(&draft.entities, |it| &it.name),
            [FaultCode::UnknownEntity, FaultCode::UnusedEntity],
        ),
        section::<CoordinateSystem>(
            text!("坐标系", "coordinate system"),
            [FILE.coordinates.name, FIELD.coordinates.name],
            names(&draft.coordinates, |it| &it.name),
            [FaultCode::UnknownCoordinates, FaultCode::UnusedCoordinates],
        ),
        section::<Store>(
            text!("存储位置", "store"),
            [FILE.stores.name, COMMON.kept.name],
            names(&draft.stores, |it| &it.name),
            [FaultCode::UnknownStore, FaultCode::UnusedStore],
        ),
        available::<Audience>(audience, AVAILABILITY.audiences.name, &words.audiences),
        available::<Machine>(machine, AVAILABILITY.hardware.name, &words.hardware),
        available::<Series>(series, AVAILABILITY.releases.name, &words.releases),
    ]
}

/// Returns the things of a section: `key` declares them, and `by` refers to them.
fn section<'d, T: Named>(
    what: Text,
    [key, by]: [&'static str; 2],
    declared: Vec<(&'d str, Span)>,
    [unknown, unused]: [FaultCode; 2],
) -> Things<'d> {
    Things {
        kinds: T::KINDS,
        what,
        home: Home::Section { key, by },
        declared,
        unknown,
        unused: Some(unused),
    }
}

fn operations<'d, T: Named>(
    draft: &'d Draft<'_>,
    what: Text,
    fits: fn(Kind) -> bool,
) -> Things<'d> {
    let declared = draft.operations.iter();
    let declared = declared.filter(|it| fits(it.item.kind()));
    Things {
        kinds: T::KINDS,
        what,
        home: Home::Operations,
        declared: declared
            .map(|it| (it.item.name.as_str(), it.origin.name()))
            .collect(),
        unknown: FaultCode::UnknownOperation,
        unused: None,
    }
}

fn available<'d, T: Named>(
    what: Text,
    key: &'static str,
    declared: &'d [Sourced<'_, Declared>],
) -> Things<'d> {
    Things {
        kinds: T::KINDS,
        what,
        home: Home::Availability(key),
        declared: names(declared, |it| &it.name),
        unknown: FaultCode::UnknownAvailability,
        unused: Some(FaultCode::UnusedAvailability),
    }
}

fn names<'d, T>(sourced: &'d [Sourced<'_, T>], name: fn(&T) -> &String) -> Vec<(&'d str, Span)> {
    let sourced = sourced.iter();
    sourced
        .map(|it| (name(&it.item).as_str(), it.origin.name()))
        .collect()
}
