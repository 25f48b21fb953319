//! The last frames of a proxy, with counts and latencies.

use crate::capture::Flow;
use crate::decode::{Record, clock};
use crate::fault::FaultKind;
use fc_reflect::FrameId;
use fc_spec::model::{Direction, KindRole, Lang};
use std::collections::VecDeque;
use std::time::Duration;

/// The most rows.
const ROWS: usize = 10_000;

/// The most bytes of all frames.
const BYTES: usize = 64 << 20;

/// The calls that latencies are taken from.
const CALLS: usize = 512;

/// A frame, or bytes that are none.
#[derive(Debug)]
pub(super) struct Row {
    /// The number of frames before it.
    pub(super) number: u64,
    pub(super) flow: Option<Flow>,
    pub(super) time: Option<Duration>,
    id: Option<FrameId>,
    pub(super) sender: Option<Sender>,
    /// The name of the operation.
    pub(super) name: String,
    pub(super) kind: &'static str,
    /// The length of the frame, or of the damaged bytes.
    pub(super) length: u64,
    /// The time since the request.
    pub(super) elapsed: Option<Duration>,
    pub(super) error: Option<&'static str>,
    pub(super) faults: Vec<&'static str>,
    /// The bytes of the frame. Of damaged bytes, only as many as a header has.
    pub(super) bytes: Vec<u8>,
}

/// A side of a connection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sender {
    App,
    Robot,
}

impl Row {
    /// Returns the code, as in the spec.
    pub(super) fn code(&self) -> String {
        self.id
            .map_or_else(String::new, |id| format!("0x{:04X}", id.code))
    }

    /// Returns the message id.
    pub(super) fn message_id(&self) -> String {
        self.id.map_or_else(String::new, |id| id.id.to_string())
    }

    /// Returns the time of the day.
    pub(super) fn clock(&self) -> String {
        self.time.map_or_else(String::new, clock)
    }

    /// Returns the error and the faults.
    pub(super) fn problems(&self) -> String {
        let all = self.error.iter().chain(&self.faults);
        let all: Vec<&str> = all.copied().collect();
        all.join(", ")
    }

    /// Returns the texts that a filter looks for.
    pub(super) fn texts(&self) -> [String; 4] {
        let name = self.name.clone();
        [name, self.code(), self.message_id(), self.problems()]
    }
}

/// The last frames.
#[derive(Debug, Default)]
pub(super) struct Traffic {
    rows: VecDeque<Row>,
    bytes: usize,
    count: u64,
    /// The latencies of the last calls.
    latencies: VecDeque<Duration>,
    pub(super) calls: u64,
    pub(super) reports: u64,
    pub(super) errors: u64,
}

impl Traffic {
    /// Adds a frame. The oldest ones go.
    pub(super) fn add(&mut self, record: &Record<'_>, lang: Lang) {
        let role = record.kind.map(|kind| kind.role);
        let direction = record.id.map(|id| id.direction);
        let (sender, kind) = side(role, direction, lang);
        let elapsed = record.request.and_then(|request| request.elapsed);
        let error = record.error.as_ref().map(fc_reflect::Error::name);
        match (role, direction) {
            (Some(KindRole::Command), Some(Direction::Response)) => {
                self.calls += 1;
                self.latencies.extend(elapsed);
            }
            (Some(KindRole::Report), Some(Direction::Request)) => self.reports += 1,
            _ => {}
        }
        self.errors += u64::from(error.is_some());
        self.bytes += record.bytes.len();
        self.rows.push_back(Row {
            number: self.count,
            flow: record.flow,
            time: record.time,
            id: record.id,
            sender,
            name: (record.operation).map_or_else(String::new, |operation| operation.name.clone()),
            kind,
            length: record.length,
            elapsed,
            error,
            faults: Vec::new(),
            bytes: record.bytes.clone(),
        });
        self.count += 1;
        while self.rows.len() > ROWS || self.bytes > BYTES {
            let Some(row) = self.rows.pop_front() else {
                break;
            };
            self.bytes -= row.bytes.len();
        }
        while self.latencies.len() > CALLS {
            self.latencies.pop_front();
        }
    }

    /// Adds the faults that the proxy has injected into a frame, which was added before.
    pub(super) fn add_faults(&mut self, flow: Flow, id: FrameId, kinds: &[FaultKind]) {
        let mut rows = self.rows.iter_mut().rev();
        let row = rows.find(|row| row.flow == Some(flow) && row.id == Some(id));
        if let Some(row) = row {
            row.faults.extend(kinds.iter().map(|kind| kind.name()));
        }
    }

    /// Returns the number of frames so far.
    pub(super) fn count(&self) -> u64 {
        self.count
    }

    /// Returns the rows, the oldest one first.
    pub(super) fn rows(&self) -> impl Iterator<Item = &Row> {
        self.rows.iter()
    }

    /// Returns the median and the 95th percentile of the last latencies.
    pub(super) fn latencies(&self) -> Option<[Duration; 2]> {
        let mut sorted: Vec<Duration> = self.latencies.iter().copied().collect();
        sorted.sort_unstable();
        let at = |percent: usize| sorted.get(sorted.len().saturating_sub(1) * percent / 100);
        Some([*at(50)?, *at(95)?])
    }
}

/// Returns the sender and the name of a frame's kind.
fn side(
    role: Option<KindRole>,
    direction: Option<Direction>,
    lang: Lang,
) -> (Option<Sender>, &'static str) {
    use Direction::{Request, Response};
    use KindRole::{Command, Report, Stream};
    match (role, direction) {
        (Some(Command), Some(Request)) => (Some(Sender::App), lang.pick("请求", "request")),
        (Some(Command), Some(Response)) => (Some(Sender::Robot), lang.pick("响应", "response")),
        (Some(Report), Some(Request)) => (Some(Sender::Robot), lang.pick("上报", "report")),
        (Some(Report), Some(Response)) => (Some(Sender::App), lang.pick("应答", "acknowledgement")),
        (Some(Stream), _) => (None, lang.pick("数据", "data")),
        _ => (None, lang.pick("无法识别", "not a frame")),
    }
}
