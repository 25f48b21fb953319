//! Work whose instructions are counted.
//!
//! `counted CASE N` runs a case `N` times, so that `valgrind --tool=callgrind` can count its instructions.
//! `counted gate [--accept]` does this for all cases and compares the counts with `bench/budget.json`.

mod gate;
mod work;

use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let done = match words.as_slice() {
        ["gate"] => gate::run(false),
        ["gate", "--accept"] => gate::run(true),
        [case, times] => match times.parse() {
            Ok(times) => work::run(case, times).map(|()| true),
            Err(_) => Err(format!("`{times}` is no number")),
        },
        _ => Err("usage: counted gate [--accept] | counted CASE N".to_owned()),
    };
    match done {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::from(2)
        }
    }
}
