//! The facts of a model in the form that a session takes.

use fc_reflect::sample::Samples;
use fc_reflect::{Direction, Frame, Packing, Reflector};
use fc_runtime::{AckPolicy, Allowance, Limits, SessionRules};
use fc_spec::model::{
    self, EnvelopeRole, HeaderRole, Model, Number, ResultCode, ResultRole, Value,
};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// Returns the rules of a session.
#[must_use]
pub fn rules(model: &Model) -> SessionRules {
    let kinds = &model.frame.kinds;
    let width = model.frame.field(HeaderRole::Id);
    let width = width.map_or(4, |field| field.ty.size());
    SessionRules {
        id_max: if width < 4 { u16::MAX.into() } else { u32::MAX },
        in_flight: count(model.limits.in_flight),
        report: kinds.report.value,
        stream: kinds.stream.value,
    }
}

/// Returns the limits of a connection.
#[must_use]
pub fn limits(model: &Model) -> Limits {
    let limits = &model.limits;
    Limits {
        frame_bytes: limits.frame_bytes,
        inflated_bytes: limits.inflated_bytes,
        inflate_ratio: Limits::INFLATE_RATIO,
        json_depth: count(limits.json_depth),
        json_values: Allowance::DEFAULT.values,
        json_list_bytes: Allowance::DEFAULT.list_bytes,
        in_flight: count(limits.in_flight),
        queued_reports: count(limits.queued_reports),
        connections: count(limits.connections),
    }
}

fn count(number: u32) -> usize {
    usize::try_from(number).unwrap_or(usize::MAX)
}

/// Returns the acknowledgement policy.
#[must_use]
pub fn ack(ack: model::Ack) -> AckPolicy {
    AckPolicy {
        timeout: Duration::from_millis(ack.timeout_ms.into()),
        retries: ack.retries,
    }
}

/// Returns the time a call waits for its response.
#[must_use]
pub fn call_timeout(model: &Model) -> Duration {
    Duration::from_millis(model.calls.timeout_ms.into())
}

/// Returns the result code with this role. A checked model has each role.
#[must_use]
pub fn result(model: &Model, role: ResultRole) -> Option<&ResultCode> {
    let mut results = model.results.iter();
    results.find(|result| result.role == Some(role))
}

/// Returns the time in milliseconds since 1970-01-01T00:00:00Z.
fn now_ms() -> i128 {
    let now = SystemTime::now().duration_since(UNIX_EPOCH);
    now.map_or(0, |now| i128::try_from(now.as_millis()).unwrap_or(0))
}

/// Returns the first message id of a connection: the milliseconds of the day. A connection that is made again then does
/// not begin with ids that are in use.
#[must_use]
pub fn first_id() -> u32 {
    u32::try_from(now_ms() % 86_400_000).unwrap_or(0)
}

/// Sets the time keys of the envelope to the current time.
pub fn stamp(model: &Model, direction: Direction, message: &mut Value) {
    let fields = Samples::new(model).envelope(direction).iter();
    for field in fields.filter(|field| field.role == EnvelopeRole::Time) {
        if let Some(time) = message.get_mut(&field.wire) {
            *time = Value::Number(Number::Int(now_ms()));
        }
    }
}

/// Returns the frame that answers a command, or acknowledges a report, with success and the current time.
pub(crate) fn success(reflector: &Reflector<'_>, request: &Frame<'_>) -> Option<Vec<u8>> {
    let model = reflector.model();
    let success = result(model, ResultRole::Success)?;
    let mut message = reflector.samples().response(request.operation, success);
    stamp(model, Direction::Response, &mut message);
    let data = message.to_string();
    let sealed = reflector.seal(request.id.answer(), data.as_bytes(), Packing::Plain);
    sealed.ok()
}
