//! The frames that a mock sends on its data port.

use super::Settings;
use fc_reflect::sample::STREAM_BYTES;
use fc_reflect::{Direction, FrameId, Packing, Reflector};
use fc_spec::model::{Kind, Operation, Side};
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The streams of a robot, and the bytes that follow single commands.
pub(super) struct Streams<'m> {
    reflector: &'m Reflector<'m>,
    pace: Duration,
    /// Names of commands that bytes follow.
    after: Vec<String>,
    running: Vec<Running<'m>>,
    /// The last frame after each command, by its code, for data connections that come later.
    latest: BTreeMap<u16, Arc<[u8]>>,
}

struct Running<'m> {
    stream: &'m Operation,
    /// The time of the next frame, or `None` while the stream is stopped.
    due: Option<Instant>,
    next_id: u32,
}

impl<'m> Streams<'m> {
    pub(super) fn new(reflector: &'m Reflector<'m>, settings: &Settings) -> Self {
        let now = Instant::now();
        let operations = reflector.model().operations.iter();
        let streams = operations.filter(|operation| {
            operation.kind() == Kind::Stream && operation.sender == Side::Robot
        });
        let running = streams.map(|stream| {
            let is_started = stream.stream().is_none_or(|it| it.started_by.is_none());
            Running {
                stream,
                due: is_started.then_some(now),
                next_id: 0,
            }
        });
        Self {
            reflector,
            pace: settings.pace,
            after: settings.stream_after.clone(),
            running: running.collect(),
            latest: BTreeMap::new(),
        }
    }

    /// Returns the time of the next frame.
    pub(super) fn next_due(&self) -> Option<Instant> {
        self.running.iter().filter_map(|running| running.due).min()
    }

    /// Returns the frames that are due.
    pub(super) fn due(&mut self, now: Instant) -> Vec<Arc<[u8]>> {
        let mut frames = Vec::new();
        for running in &mut self.running {
            if running.due.is_some_and(|due| due <= now) {
                running.due = now.checked_add(self.pace);
                let frame = self.reflector.sample(
                    running.stream,
                    Direction::Request,
                    running.next_id,
                    Packing::Plain,
                );
                running.next_id = running.next_id.wrapping_add(1);
                frames.extend(frame.and_then(Result::ok).map(Arc::from));
            }
        }
        frames
    }

    /// Starts and stops the streams of an accepted command. Returns the frame that follows it on the data port.
    pub(super) fn accept(&mut self, command: &Operation, id: FrameId) -> Option<Arc<[u8]>> {
        for running in &mut self.running {
            let Some(stream) = running.stream.stream() else {
                continue;
            };
            if stream.started_by.as_ref() == Some(&command.name) {
                running.due = Some(Instant::now());
            } else if stream.stopped_by.as_ref() == Some(&command.name) {
                running.due = None;
            }
        }
        if !self.after.contains(&command.name) {
            return None;
        }
        let id = FrameId {
            kind: self.reflector.model().frame.kinds.stream.value,
            ..id
        };
        let frame = self.reflector.seal(id, STREAM_BYTES, Packing::Plain);
        let frame: Arc<[u8]> = frame.ok()?.into();
        self.latest.insert(id.code, Arc::clone(&frame));
        Some(frame)
    }

    /// Returns the last frame after each command.
    pub(super) fn latest(&self) -> impl Iterator<Item = &Arc<[u8]>> {
        self.latest.values()
    }
}
