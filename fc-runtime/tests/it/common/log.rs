//! The log of the runtime in readable form.

use std::fmt::{Debug, Write};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use tokio::time::Instant;
use tracing::field::{Field, Visit};
use tracing::span::{Attributes, Id, Record};
use tracing::subscriber::DefaultGuard;
use tracing::{Event, Level, Metadata, Subscriber};

static ALONE: Mutex<()> = Mutex::new(());

/// The only test that logs at this moment.
pub struct Alone(#[allow(dead_code, reason = "held")] MutexGuard<'static, ()>);

/// One test at a time: a callsite first reached while another test starts or stops listening may stay disabled for
/// both. Tests that do not listen call this if others of their file do.
///
/// Blocks its thread, which is the test's own: paused time has nothing to wait for.
pub fn alone() -> Alone {
    Alone(ALONE.lock().unwrap_or_else(PoisonError::into_inner))
}

/// A line of the log.
#[allow(dead_code, reason = "the program `restarts` reads all of it")]
pub struct Entry {
    pub at: Instant,
    /// The app's side has written it, and not the robot's.
    pub of_app: bool,
    /// `WARN message field=value`.
    pub line: String,
}

/// Records a line for each event until it is dropped.
pub struct Log {
    lines: Arc<Mutex<Vec<Entry>>>,
    _listening: DefaultGuard,
    _alone: Alone,
}

impl Log {
    /// Listens to events of the runtime up to a level, in this thread.
    pub fn listen(up_to: Level) -> Self {
        let alone = alone();
        let lines = Arc::default();
        let listener = Listener {
            up_to,
            lines: Arc::clone(&lines),
        };
        Self {
            lines,
            _listening: tracing::subscriber::set_default(listener),
            _alone: alone,
        }
    }

    /// The lines that have come since this was last asked.
    pub fn take(&self) -> Vec<String> {
        let entries = self.take_entries().into_iter();
        entries.map(|entry| entry.line).collect()
    }

    /// The same, with when and by whom they were written.
    pub fn take_entries(&self) -> Vec<Entry> {
        std::mem::take(&mut *self.lines.lock().unwrap())
    }

    /// These, once so many are there.
    pub async fn take_once(&self, count: usize) -> Vec<String> {
        for _ in 0..10_000 {
            if self.lines.lock().unwrap().len() >= count {
                break;
            }
            tokio::task::yield_now().await;
        }
        let lines = self.take();
        assert_eq!(lines.len(), count, "{lines:#?}");
        lines
    }

    /// The lines that have a word in them.
    pub fn with(&self, word: &str) -> Vec<String> {
        let lines = self.lines.lock().unwrap();
        let lines = lines.iter().map(|entry| &entry.line);
        lines.filter(|line| line.contains(word)).cloned().collect()
    }
}

struct Listener {
    up_to: Level,
    lines: Arc<Mutex<Vec<Entry>>>,
}

#[derive(Default)]
struct Line {
    message: String,
    fields: String,
}

impl Visit for Line {
    fn record_debug(&mut self, field: &Field, value: &dyn Debug) {
        if field.name() == "message" {
            self.message = format!("{value:?}");
        } else {
            write!(self.fields, " {field}={value:?}").unwrap();
        }
    }
}

impl Subscriber for Listener {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        *metadata.level() <= self.up_to && metadata.target().starts_with("fc_runtime")
    }

    fn new_span(&self, _: &Attributes<'_>) -> Id {
        Id::from_u64(1)
    }

    fn event(&self, event: &Event<'_>) {
        let mut line = Line::default();
        event.record(&mut line);
        let metadata = event.metadata();
        let entry = Entry {
            at: Instant::now(),
            of_app: metadata.target().starts_with("fc_runtime::client"),
            line: format!("{} {}{}", metadata.level(), line.message, line.fields),
        };
        self.lines.lock().unwrap().push(entry);
    }

    fn record(&self, _: &Id, _: &Record<'_>) {}
    fn record_follows_from(&self, _: &Id, _: &Id) {}
    fn enter(&self, _: &Id) {}
    fn exit(&self, _: &Id) {}
}
