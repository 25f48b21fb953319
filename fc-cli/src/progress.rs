//! What is being done, for a person who waits for longer than a second.
//!
//! One line on the error stream, and only where that is a terminal that a person reads: not in a pipe, not in CI, not with
//! `--quiet`. It is gone before anything else is printed.

use std::io::{IsTerminal as _, Write as _, stderr};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// How long nothing is said.
const PATIENCE: Duration = Duration::from_secs(1);

/// How often the line is written again.
const PACE: Duration = Duration::from_millis(200);

/// Takes the line away, on every terminal.
const ERASE: &[u8] = b"\r\x1b[K";

struct Line {
    /// What is being done, and since when.
    doing: Option<(&'static str, Instant)>,
    is_shown: bool,
    /// Whether the thread is there that shows it.
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

/// Says what is being done from here on, if that takes long.
pub fn doing(what: &'static str) {
    let unread = ["CI", "FC_CI"]
        .iter()
        .any(|it| std::env::var_os(it).is_some());
    let is_dumb = std::env::var_os("TERM").is_none_or(|term| term == "dumb");
    if crate::print::is_quiet() || unread || is_dumb || !stderr().is_terminal() {
        return;
    }
    let mut line = line();
    line.doing = Some((what, Instant::now()));
    if !line.is_running {
        line.is_running = true;
        // It ends with the program.
        std::thread::spawn(show);
    }
    CHANGED.notify_one();
}

/// Takes the line away, since something else is printed or all is done.
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
