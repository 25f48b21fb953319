//! Programs that the derives must refuse, and how (`tests/ui`), and programs that they must take
//! (`tests/pass`).
//!
//! What an error looks like depends on the compiler. `tests/ui/*.stderr` was written by the one named
//! here and is compared by it alone, which CI has to have (`FC_CI`). With any other, unit tests still see
//! to it that each program is refused, and in the words written down; where the error points is not
//! compared then, and the test says so. To write the files anew: `TRYBUILD=overwrite cargo test -p
//! fc-derive --test ui -- --ignored`.

use std::io::Write as _;
use std::process::Command;

/// The compiler whose words `tests/ui/*.stderr` has.
const COMPILER: &str = "rustc 1.95.";

#[test]
#[ignore = "compiles programs of its own"]
fn programs() {
    let programs = trybuild::TestCases::new();
    programs.pass("tests/pass/*.rs");
    if is_pinned_compiler() {
        programs.compile_fail("tests/ui/*.rs");
    } else {
        let skipped = format!("tests/ui/*.stderr is not compared: it belongs to {COMPILER}x");
        assert!(std::env::var_os("FC_CI").is_none(), "{skipped}");
        // To the terminal itself, since what a test that passes prints is not shown.
        let _ = writeln!(std::io::stderr(), "warning: {skipped}");
    }
}

fn is_pinned_compiler() -> bool {
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let version = Command::new(rustc).arg("--version").output();
    version.is_ok_and(|version| version.stdout.starts_with(COMPILER.as_bytes()))
}
