//! What the conformance table is told: how many of the shared cases have held. A test includes this file as a module.

use std::env;
use std::fs::OpenOptions;
use std::io::Write as _;
use std::thread;

/// Counts the cases of a kind that have held, and says so at its end, also where that is a panic: a line `KIND NUMBER` behind
/// what is in the file that `FC_CONFORMANCE` names. Without one, nobody is told.
pub struct Tally {
    kind: &'static str,
    held: usize,
}

impl Tally {
    /// Of a kind of `conformance/README.md`.
    pub fn of(kind: &'static str) -> Self {
        Self { kind, held: 0 }
    }

    /// Once all that was asked of so many cases has held.
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
        // At once, so that lines of tests that run beside each other do not mix.
        let mut file = OpenOptions::new().create(true).append(true).open(path);
        let written = (file.as_mut()).is_ok_and(|file| file.write_all(line.as_bytes()).is_ok());
        // A panic within a panic would hide the first one.
        assert!(written || thread::panicking(), "{line}");
    }
}
