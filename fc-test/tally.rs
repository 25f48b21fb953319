//! Counts how many of the shared cases have held, for the conformance table. A test includes this file as a module.

use std::env;
use std::fs::OpenOptions;
use std::io::Write as _;
use std::thread;

/// Counts the cases of one kind that have held. When dropped, even by a panic, it appends a line `KIND NUMBER` to the
/// file in `FC_CONFORMANCE`. Without that variable, it writes nothing.
pub struct Tally {
    kind: &'static str,
    held: usize,
}

impl Tally {
    /// Starts a count for a kind of `conformance/README.md`.
    pub fn of(kind: &'static str) -> Self {
        Self { kind, held: 0 }
    }

    /// Adds cases that have passed all of their checks.
    pub fn held(&mut self, cases: usize) {
        self.held += cases;
    }
}

impl Drop for Tally {
    fn drop(&mut self) {
        let Some(path) = env::var_os("FC_CONFORMANCE") else {
            return;
        };
        let line = format!("{} {}\n", self.kind, self.held);
        // A single write, so that lines of parallel tests do not mix.
        let mut file = OpenOptions::new().create(true).append(true).open(path);
        let written = (file.as_mut()).is_ok_and(|file| file.write_all(line.as_bytes()).is_ok());
        // A second panic would hide the first one.
        assert!(written || thread::panicking(), "{line}");
    }
}
