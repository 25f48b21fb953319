//! Programs that the derives must refuse, and how (`tests/ui`), and programs that they must take
//! (`tests/pass`).
//!
//! The form of an error depends on the compiler. `tests/ui/*.stderr` was written by the compiler named here, and only
//! that compiler compares it; CI must have it (`FC_CI`). With any other compiler, unit tests check that each program is
//! rejected with the written text, but not the position of the error, and the test prints this. To write the files
//! again: `TRYBUILD=overwrite cargo test -p fc-derive --test ui -- --ignored`.

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
