//! Programs that the derives must refuse, and how (`tests/ui`), and programs that they must take
//! (`tests/pass`).
//!
//! What an error looks like depends on the compiler. `tests/ui/*.stderr` was written by the one named
//! here and is compared by it alone; with any other, the unit test `refuses_every_program` still sees
//! to it that each program is refused. To write the files anew: `TRYBUILD=overwrite cargo test -p
//! fc-derive --test ui`.

use std::process::Command;

/// The compiler whose words `tests/ui/*.stderr` has.
const COMPILER: &str = "rustc 1.95.";

#[test]
fn programs() {
    let programs = trybuild::TestCases::new();
    programs.pass("tests/pass/*.rs");
    if is_pinned_compiler() {
        programs.compile_fail("tests/ui/*.rs");
    } else {
        println!("tests/ui/*.stderr not compared: it belongs to {COMPILER}x");
    }
}

fn is_pinned_compiler() -> bool {
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let version = Command::new(rustc).arg("--version").output();
    version.is_ok_and(|version| version.stdout.starts_with(COMPILER.as_bytes()))
}
