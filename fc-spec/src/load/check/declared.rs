//! References to declared things, and things without a reference.

use super::iter::called;
use crate::diagnostic::{Diagnostic, FaultCode, Faults, nearest};
use crate::language::Occurrence;
use crate::language::grammar::{
    ACCEPTED, AVAILABILITY, AnyOperation, Audience, COMMON, Command, CoordinateSystem, Entity,
    FIELD, FILE, Machine, Named, Report, STREAM, Series, Store,
};
use crate::load::draft::{Draft, Sourced};
use crate::model::{Kind, Text};
use crate::source::Span;
use crate::text;
use std::collections::HashSet;

/// The things that references of one kind may name, and how they are reported.
struct Things<'d> {
    /// The kind of the references in the grammar.
    kinds: &'static [&'static str],
    declared: Vec<(&'d str, Span)>,
    /// Returns `true` if all of them are known.
    is_complete: bool,
    unknown: FaultCode,
    /// The message about an unknown name.
    message: fn(&str) -> Text,
    /// The note on an unknown name without a similar one.
    note: Option<Text>,
    /// How a thing without a reference is reported, if it is an error.
    unused: Option<Unused>,
}

/// How a thing without a reference is reported.
struct Unused {
    code: FaultCode,
    message: fn(&str) -> Text,
    note: Text,
}

/// Every name of a thing is declared.
pub(super) fn check_declared(draft: &Draft<'_>, faults: &mut Faults) {
    for things in things(draft).iter().filter(|things| things.is_complete) {
        let known = things.names();
        for (occurrence, name) in draft.references_to(things.kinds) {
            if known.contains(name) {
                continue;
            }
            let fault = misfit(draft, occurrence, name).unwrap_or_else(|| {
                let message = (things.message)(name);
                Diagnostic::error(things.unknown, occurrence.node.span(), message)
            });
            let names = things.declared.iter().map(|(name, _)| *name);
            faults.push(fault.suggest(nearest(name, names), things.note.clone()));
        }
    }
}

/// Every thing has a reference. One whose name a reference misspells is not reported a second time. One audience may go
/// without: the things of other audiences are not for it.
pub(super) fn check_unused(draft: &Draft<'_>, faults: &mut Faults) {
    for things in &things(draft) {
        let Some(report) = &things.unused else {
            continue;
        };
        let known = things.names();
        let mut used: HashSet<&str> = draft
            .references_to(things.kinds)
            .map(|(_, name)| name)
            .collect();
        let slips: Vec<&str> = used.difference(&known).copied().collect();
        for slip in slips {
            used.extend(nearest(slip, known.iter().copied()));
        }
        let declared = things.declared.iter();
        let unused: Vec<_> = declared.filter(|(name, _)| !used.contains(name)).collect();
        let is_one_audience = things.kinds == Audience::KINDS && unused.len() == 1;
        if is_one_audience && things.declared.len() > 1 {
            continue;
        }
        for (name, span) in unused {
            let fault = Diagnostic::error(report.code, *span, (report.message)(name));
            faults.push(fault.note(report.note.clone()));
        }
    }
}

impl<'d> Things<'d> {
    fn names(&self) -> HashSet<&'d str> {
        self.declared.iter().map(|(name, _)| *name).collect()
    }
}

/// The error of a reference to an operation of another kind.
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

/// All things that references may name, other than types.
fn things<'d>(draft: &'d Draft<'_>) -> Vec<Things<'d>> {
    let command = Things {
        message: |name| text!("没有指令 `{name}`", "there is no command `{name}`"),
        ..operations::<Command>(draft, |kind| kind == Kind::Command)
    };
    let report = Things {
        message: |name| text!("没有上报 `{name}`", "there is no report `{name}`"),
        ..operations::<Report>(draft, |kind| kind == Kind::Report)
    };
    let operations = [command, report, operations::<AnyOperation>(draft, |_| true)];
    let others = sections(draft).into_iter().chain(availability(draft));
    operations.into_iter().chain(others).collect()
}

/// The things with a section of the spec.
fn sections<'d>(draft: &'d Draft<'_>) -> [Things<'d>; 3] {
    let in_section = |key| text!("在 `{key}:` 下声明", "declare it under `{key}:`");
    [
        Things {
            kinds: Entity::KINDS,
            declared: names(&draft.entities, |it| &it.name),
            is_complete: true,
            unknown: FaultCode::UnknownEntity,
            message: |name| text!("没有实体 `{name}`", "there is no entity `{name}`"),
            note: Some(in_section(FILE.entities.name)),
            unused: Some(Unused {
                code: FaultCode::UnusedEntity,
                message: |name| {
                    text!(
                        "没有字段指向实体 `{name}`",
                        "no field refers to the entity `{name}`"
                    )
                },
                note: text!(
                    "在存放它的 ID 的字段上写 `refers`，或将它删除",
                    "write `refers` on a field that holds its IDs, or delete it"
                ),
            }),
        },
        Things {
            kinds: CoordinateSystem::KINDS,
            declared: names(&draft.coordinates, |it| &it.name),
            is_complete: true,
            unknown: FaultCode::UnknownCoordinates,
            message: |name| {
                text!(
                    "没有坐标系 `{name}`",
                    "there is no coordinate system `{name}`"
                )
            },
            note: Some(in_section(FILE.coordinates.name)),
            unused: Some(Unused {
                code: FaultCode::UnusedCoordinates,
                message: |name| {
                    text!(
                        "坐标系 `{name}` 没有用到",
                        "the coordinate system `{name}` is not used"
                    )
                },
                note: write_or_delete(FIELD.coordinates.name),
            }),
        },
        Things {
            kinds: Store::KINDS,
            declared: names(&draft.stores, |it| &it.name),
            is_complete: true,
            unknown: FaultCode::UnknownStore,
            message: |name| text!("没有存储位置 `{name}`", "there is no store `{name}`"),
            note: Some(in_section(FILE.stores.name)),
            unused: Some(Unused {
                code: FaultCode::UnusedStore,
                message: |name| {
                    text!(
                        "存储位置 `{name}` 没有用到",
                        "the store `{name}` is not used"
                    )
                },
                note: write_or_delete(COMMON.kept.name),
            }),
        },
    ]
}

/// The words of `availability`.
fn availability<'d>(draft: &'d Draft<'_>) -> [Things<'d>; 3] {
    let words = &draft.availability;
    let in_availability = |key| {
        text!(
            "在 `availability: {{ {key} }}` 下声明",
            "declare it under `availability: {{ {key} }}`"
        )
    };
    [
        Things {
            kinds: Audience::KINDS,
            declared: names(&words.audiences, |it| &it.name),
            is_complete: !words.is_broken,
            unknown: FaultCode::UnknownAvailability,
            message: |name| text!("没有名为 `{name}` 的受众", "there is no audience `{name}`"),
            note: Some(in_availability(AVAILABILITY.audiences.name)),
            unused: Some(Unused {
                code: FaultCode::UnusedAvailability,
                message: |name| {
                    text!(
                        "没有 `available` 用到受众 `{name}`",
                        "no `available` names the audience `{name}`"
                    )
                },
                note: text!(
                    "在只面向它的内容上写 `available: {{ for: … }}`，或将它删除",
                    "write `available: {{ for: … }}` on the things that only it has, or delete it"
                ),
            }),
        },
        Things {
            kinds: Machine::KINDS,
            declared: names(&words.hardware, |it| &it.name),
            is_complete: !words.is_broken,
            unknown: FaultCode::UnknownAvailability,
            message: |name| {
                text!(
                    "没有名为 `{name}` 的机型",
                    "there is no line of machines `{name}`"
                )
            },
            note: Some(in_availability(AVAILABILITY.hardware.name)),
            unused: Some(Unused {
                code: FaultCode::UnusedAvailability,
                message: |name| {
                    text!(
                        "没有 `available` 用到机型 `{name}`",
                        "no `available` names the line of machines `{name}`"
                    )
                },
                note: name_or_delete(),
            }),
        },
        Things {
            kinds: Series::KINDS,
            declared: names(&words.releases, |it| &it.name),
            is_complete: !words.is_broken,
            unknown: FaultCode::UnknownAvailability,
            message: |name| {
                text!(
                    "没有名为 `{name}` 的版本系列",
                    "there is no series of releases `{name}`"
                )
            },
            note: Some(in_availability(AVAILABILITY.releases.name)),
            unused: Some(Unused {
                code: FaultCode::UnusedAvailability,
                message: |name| {
                    text!(
                        "没有 `available` 用到版本系列 `{name}`",
                        "no `available` names the series of releases `{name}`"
                    )
                },
                note: name_or_delete(),
            }),
        },
    ]
}

/// Operations of some kinds.
fn operations<'d, T: Named>(draft: &'d Draft<'_>, fits: fn(Kind) -> bool) -> Things<'d> {
    let declared = draft.operations.iter();
    let declared = declared.filter(|it| fits(it.item.kind()));
    Things {
        kinds: T::KINDS,
        declared: declared
            .map(|it| (it.item.name.as_str(), it.origin.name()))
            .collect(),
        is_complete: true,
        unknown: FaultCode::UnknownOperation,
        message: |name| text!("没有接口 `{name}`", "there is no operation `{name}`"),
        note: None,
        unused: None,
    }
}

fn names<'d, T>(placed: &'d [Sourced<'_, T>], name: fn(&T) -> &String) -> Vec<(&'d str, Span)> {
    let placed = placed.iter();
    placed
        .map(|it| (name(&it.item).as_str(), it.origin.name()))
        .collect()
}

fn write_or_delete(key: &str) -> Text {
    text!(
        "在适用的地方写 `{key}`，或将它删除",
        "write `{key}` where it applies, or delete it"
    )
}

fn name_or_delete() -> Text {
    text!(
        "在某个 `available` 中用到它，或将它删除",
        "name it in an `available`, or delete it"
    )
}
