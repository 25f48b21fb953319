//! A progress line for work that takes longer than a second.
//!
//! The line appears only if standard error is a terminal, and neither in CI nor with `--quiet`. It is erased before any
//! other output.

use std::io::{IsTerminal as _, Write as _, stderr};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// The delay before the line appears.
const PATIENCE: Duration = Duration::from_secs(1);

/// The interval between updates of the line.
const PACE: Duration = Duration::from_millis(200);

/// Erases the line on every terminal.
const ERASE: &[u8] = b"\r\x1b[K";

/// `true` with `--quiet`.
static QUIET: AtomicBool = AtomicBool::new(false);

/// Hides the line, and success messages.
pub fn quiet(quiet: bool) {
    QUIET.store(quiet, Ordering::Relaxed);
}

/// Returns `true` if the run shows neither progress nor success.
pub fn is_quiet() -> bool {
    QUIET.load(Ordering::Relaxed)
}

struct Line {
    /// The current work and its start time.
    doing: Option<(&'static str, Instant)>,
    is_shown: bool,
    /// `true` if the thread that shows the line has started.
    is_running: bool,
}

static LINE: Mutex<Line> = Mutex::new(Line {
    doing: None,
    is_shown: false,
    is_running: false,
});
static CHANGED: Condvar = Condvar::new();

fn line() -> MutexGuard<'static, Line> {
    LINE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Sets the current work. The line shows it if it takes long.
pub fn doing(what: &'static str) {
    let unread = ["CI", "FC_CI"]
        .iter()
        .any(|it| std::env::var_os(it).is_some());
    let is_dumb = std::env::var_os("TERM").is_none_or(|term| term == "dumb");
    if is_quiet() || unread || is_dumb || !stderr().is_terminal() {
        return;
    }
    let mut line = line();
    line.doing = Some((what, Instant::now()));
    if !line.is_running {
        line.is_running = true;
        // The thread ends with the program.
        std::thread::spawn(show);
    }
    CHANGED.notify_one();
}

/// Erases the line before other output or at the end.
pub fn done() {
    let mut line = line();
    line.doing = None;
    erase(&mut line);
}

fn erase(line: &mut Line) {
    if std::mem::take(&mut line.is_shown) {
        let _ = stderr().write_all(ERASE);
    }
}

fn show() {
    let mut line = line();
    loop {
        let Some((what, since)) = line.doing else {
            line = CHANGED.wait(line).unwrap_or_else(PoisonError::into_inner);
            continue;
        };
        let long = since.elapsed();
        if long >= PATIENCE {
            let text = format!("{what} … {} s", long.as_secs());
            let mut stderr = stderr();
            let written = stderr.write_all(ERASE);
            let _ = written.and_then(|()| stderr.write_all(text.as_bytes()));
            line.is_shown = true;
        }
        let wait = PATIENCE.saturating_sub(long).max(PACE);
        let waited = CHANGED.wait_timeout(line, wait);
        line = waited.unwrap_or_else(PoisonError::into_inner).0;
    }
}
