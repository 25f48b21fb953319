//! The reports that a command sets off, from the first state of their process to the last.

use crate::paths::{self, at};
use fc_reflect::sample::Profile;
use fc_reflect::{Direction, Reflector};
use fc_spec::model::{
    Cadence, EnumType, EnumValue, Exchange, Field, Number, Operation, SetOff, Step, Type, Value,
};
use std::iter::successors;
use std::time::Duration;

/// The largest number of reports of one process.
const MOST_STEPS: usize = 64;

/// A report of a process.
#[derive(Clone, Debug)]
pub(super) struct ProcessStep {
    /// The time after the response to the command.
    pub(super) after: Duration,
    /// The report with its envelope.
    pub(super) message: Value,
}

/// Returns the reports that a call sets off, in order.
pub(super) fn steps(
    reflector: &Reflector<'_>,
    set_off: &SetOff,
    report: &Operation,
    request: &Value,
    response: &Value,
    pace: Duration,
) -> Vec<ProcessStep> {
    let samples = reflector.samples();
    let mut base = samples.message(report, Direction::Request, Profile::Example);
    for tie in &set_off.tied {
        let message = match tie.side {
            Direction::Request => request,
            Direction::Response => response,
        };
        if let Some(value) = at(message, &tie.command) {
            paths::set(&mut base, &keys(&tie.report), value);
        }
    }
    let pace = match report.cadence() {
        Some(Cadence::EveryMs(interval)) => Duration::from_millis((*interval).into()),
        Some(Cadence::WithinMs(most)) => pace.min(Duration::from_millis((*most).into())),
        Some(Cadence::OnChange(_) | Cadence::Step(_)) | None => pace,
    };
    let Some((path, values)) = changes(reflector, report) else {
        let (after, message) = (pace, base);
        return vec![ProcessStep { after, message }];
    };
    let mut after = Duration::ZERO;
    let steps = values.into_iter().take(MOST_STEPS).map(|value| {
        after += pace;
        let mut message = base.clone();
        paths::set(&mut message, &path, &value);
        ProcessStep { after, message }
    });
    steps.collect()
}

/// The path of wire keys to the state or number that changes from one report to the next, and its values.
type Changes<'m> = (Vec<&'m str>, Vec<Value>);

/// Returns what changes from one report to the next, or `None` if there is one report.
fn changes<'m>(reflector: &Reflector<'m>, report: &'m Operation) -> Option<Changes<'m>> {
    let model = reflector.model();
    let body = &report.body(Direction::Request)?.ty;
    if let Exchange::Report { state, .. } = &report.exchange
        && let Some(path) = state
        && let Some((_, shape)) = model.enum_at(body, path)
    {
        let states = states(shape).into_iter();
        let values = states.map(|state| Value::from(&state.wire));
        return Some((keys(path), values.collect()));
    }
    let Some(Cadence::Step(step)) = report.cadence() else {
        return None;
    };
    let field = paths::field(model, body, &step.field);
    let numbers = field.map_or_else(Vec::new, |field| numbers(reflector, field, step));
    Some((step.field.split('.').collect(), numbers))
}

/// Returns the states of a process without an error, from its start to its end.
fn states(shape: &EnumType) -> Vec<&EnumValue> {
    let mut values = shape.values.iter();
    let start = values.find(|value| value.start);
    let Some(start) = start.filter(|_| shape.order.is_some()) else {
        let fine = shape.values.iter().filter(|value| !value.is_error);
        return fine.collect();
    };
    let mut states = vec![start];
    while let Some(last) = states.last().filter(|last| !last.is_final) {
        let next = shape.values.iter().find(|value| {
            let is_new = !states.iter().any(|state| state.name == value.name);
            last.then.contains(&value.name) && !value.is_error && is_new
        });
        match next {
            Some(next) => states.push(next),
            None => break,
        }
    }
    states
}

/// Returns the numbers of a report that is sent at each step of a number: from its least to its largest value. Without a
/// largest value, or if the steps are many, there are fewer.
fn numbers(reflector: &Reflector<'_>, field: &Field, step: &Step) -> Vec<Value> {
    let constraints = &field.details().constraints;
    let least = constraints.min.as_ref().map_or(0.0, Number::to_f64);
    let Some(most) = constraints.max.as_ref().map(Number::to_f64) else {
        return vec![reflector.samples().value_of(field)];
    };
    let by = step.by.to_f64().max((most - least) / 63.0);
    let numbers = successors(Some(least), |number| Some(number + by));
    let numbers = numbers.take_while(|number| *number < most);
    let is_int = matches!(field.ty.item(), Type::Int(_));
    let numbers = numbers.take(MOST_STEPS - 1).chain([most]).map(|number| {
        #[allow(
            clippy::cast_possible_truncation,
            reason = "it is within the range of its type"
        )]
        let whole = number as i128;
        Value::Number(if is_int {
            Number::Int(whole)
        } else {
            Number::Float(number)
        })
    });
    numbers.collect()
}

fn keys(path: &[String]) -> Vec<&str> {
    path.iter().map(String::as_str).collect()
}
