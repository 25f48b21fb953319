//! The order of states and the cadence of reports.

use super::{DeviationKind, Found, Moment, Place, place};
use crate::capture::Flow;
use crate::decode::Record;
use fc_reflect::{About, Node, Value};
use fc_spec::model::{Cadence, EnumType, Exchange, Kind, Model, Operation, StateOrder, Step};
use std::collections::{BTreeSet, HashMap};
use std::time::Duration;

/// Processes that are followed at the same time.
const KEPT: usize = 4096;

/// Separates a state from the next one in a [`Place`].
pub(super) const ARROW: &str = " → ";

/// A report may come this much later than its interval, as a share of it: one half.
const LATE: u32 = 2;

/// The reports of a process: their flow, their operation, and the values of the keys that tie them to a command.
type Process = (Option<Flow>, String, BTreeSet<String>);

/// The last report of a process.
#[derive(Clone, Debug, Default)]
struct Last {
    time: Option<Duration>,
    state: Option<String>,
    trigger: Option<String>,
}

/// The processes of all connections.
#[derive(Default)]
pub(super) struct Processes<'m> {
    last: HashMap<Process, Last>,
    /// The time of the last command that sets off each report, by flow of the report.
    commands: HashMap<(Option<Flow>, &'m str), Duration>,
}

impl<'m> Processes<'m> {
    /// Follows a valid record that repeats no earlier one.
    pub(super) fn follow(&mut self, model: &'m Model, record: &Record<'m>, found: &mut Found<'m>) {
        let (Some(operation), Some(id)) = (record.operation, record.id) else {
            return;
        };
        if id.direction == fc_spec::model::Direction::Response {
            return;
        }
        if operation.kind() == Kind::Command {
            return self.start(operation, record);
        }
        let Exchange::Report { state, cadence, .. } = &operation.exchange else {
            return;
        };
        let body = record.message.as_ref().map(|message| &message.body);
        let Some(Ok(body)) = body else {
            return;
        };
        let process = (
            record.flow,
            operation.name.clone(),
            ties(model, operation, body),
        );
        let earlier = self.last.get(&process).cloned();
        let path = state.as_deref();
        let named = path.and_then(|path| match at(body, path)?.value {
            Value::Enum { named, .. } => named,
            _ => None,
        });
        let trigger = cadence.as_ref().and_then(Cadence::field);
        let now = Last {
            time: record.time,
            state: named.map(|value| value.name.clone()),
            trigger: trigger.and_then(|path| {
                let keys: Vec<_> = path.split('.').map(str::to_owned).collect();
                at(body, &keys).map(text)
            }),
        };
        if let Some(earlier) = &earlier {
            let shape = path.and_then(|path| {
                let messages = operation.messages()?;
                model.enum_at(&messages.request.ty, path)
            });
            if let (Some((_, shape)), Some(path)) = (shape, path) {
                compare_states(record, shape, path, earlier, &now, found);
            }
        }
        if let Some(cadence) = cadence {
            let commanded = self.commands.get(&(record.flow, operation.name.as_str()));
            compare_times(record, cadence, earlier.as_ref(), &now, commanded, found);
        }
        if self.last.len() < KEPT || self.last.contains_key(&process) {
            self.last.insert(process, now);
        }
    }

    /// Notes the time of a command for the reports that it sets off.
    fn start(&mut self, command: &'m Operation, record: &Record<'m>) {
        let Some(time) = record.time else {
            return;
        };
        for set_off in command.sets_off() {
            let key = (record.flow.map(Flow::reversed), set_off.report.as_str());
            if self.commands.len() < KEPT || self.commands.contains_key(&key) {
                self.commands.insert(key, time);
            }
        }
    }
}

/// Finds a state that cannot follow the earlier one.
fn compare_states<'m>(
    record: &Record<'m>,
    shape: &EnumType,
    path: &[String],
    earlier: &Last,
    now: &Last,
    found: &mut Found<'m>,
) {
    let (Some(before), Some(after)) = (&earlier.state, &now.state) else {
        return;
    };
    if shape.order != Some(StateOrder::Complete) || before == after {
        return;
    }
    let named = |name: &str| shape.values.iter().find(|value| value.name == name);
    let (Some(from), Some(to)) = (named(before), named(after)) else {
        return;
    };
    // After the end of a process, another one may start.
    let is_new = from.is_final && to.start;
    if !is_new && !from.then.contains(after) {
        let place = Place {
            path: path.join("."),
            value: format!("{before}{ARROW}{after}"),
            ..place(record, DeviationKind::StateOrder)
        };
        let moment = Moment::of(record);
        found.add_at(&moment, place, || (String::new(), from.then.join(", ")));
    }
}

/// Finds a report at another time than its cadence allows.
fn compare_times<'m>(
    record: &Record<'m>,
    cadence: &Cadence,
    earlier: Option<&Last>,
    now: &Last,
    commanded: Option<&Duration>,
    found: &mut Found<'m>,
) {
    let place = Place {
        path: cadence.field().unwrap_or_default().to_owned(),
        ..place(record, DeviationKind::Cadence)
    };
    let since = |from: Option<Duration>| {
        now.time
            .zip(from)
            .and_then(|(to, from)| to.checked_sub(from))
    };
    let ms = |time: Duration| format!("{} ms", time.as_millis());
    match cadence {
        Cadence::EveryMs(interval) => {
            let Some(elapsed) = earlier.and_then(|earlier| since(earlier.time)) else {
                return;
            };
            let interval = Duration::from_millis((*interval).into());
            let slack = interval / LATE;
            if elapsed > interval + slack || elapsed + slack < interval {
                found.add(record, place, || ms(elapsed));
            }
        }
        Cadence::WithinMs(limit) => {
            if earlier.is_some_and(|earlier| earlier.time >= commanded.copied()) {
                return;
            }
            let Some(elapsed) = since(commanded.copied()) else {
                return;
            };
            if elapsed > Duration::from_millis((*limit).into()) {
                found.add(record, place, || ms(elapsed));
            }
        }
        Cadence::OnChange(_) => {
            let before = earlier.and_then(|earlier| earlier.trigger.as_ref());
            if before.is_some() && before == now.trigger.as_ref() {
                found.add(record, place, || now.trigger.clone().unwrap_or_default());
            }
        }
        Cadence::Step(Step { by, .. }) => {
            let number = |text: &Option<String>| text.as_ref()?.parse::<f64>().ok();
            let before = earlier.and_then(|earlier| number(&earlier.trigger));
            let (Some(before), Some(after)) = (before, number(&now.trigger)) else {
                return;
            };
            // A smaller number begins another process.
            if after > before && after - before < by.to_f64() {
                found.add(record, place, || format!("{before} → {after}"));
            }
        }
    }
}

/// Returns the values of the keys that tie a report to a command.
fn ties(model: &Model, report: &Operation, body: &[Node<'_>]) -> BTreeSet<String> {
    let set_offs = model
        .commands_that_set_off(report)
        .flat_map(Operation::sets_off);
    let set_offs = set_offs.filter(|set_off| set_off.report == report.name);
    let ties = set_offs.flat_map(|set_off| &set_off.tied);
    ties.filter_map(|tie| at(body, &tie.report).map(text))
        .collect()
}

/// Returns the value at a path of wire keys.
fn at<'n, 'm>(nodes: &'n [Node<'m>], path: &[String]) -> Option<&'n Node<'m>> {
    let (key, rest) = path.split_first()?;
    let is_named = |node: &&Node<'m>| !matches!(node.about, About::Unknown) && node.wire() == key;
    let node = nodes.iter().find(is_named)?;
    if rest.is_empty() {
        Some(node)
    } else {
        at(node.children(), rest)
    }
}

/// Returns a value as text, to compare it with others of the same field.
fn text(node: &Node<'_>) -> String {
    match &node.value {
        Value::Int(value) => value.to_string(),
        Value::Float(value) => value.to_string(),
        Value::Text(text) => text.clone(),
        Value::Enum { wire, .. } => format!("{wire:?}"),
        other => format!("{other:?}"),
    }
}
