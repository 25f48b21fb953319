//! Measures the runtime under load and under attack.
//!
//! ```text
//! cargo run --release -- all            everything below, one after the other
//! cargo run --release -- connections    10,000 connections open at once; memory of an idle one
//! cargo run --release -- calls          1,000,000 calls; memory before and after
//! cargo run --release -- shutdown       the end of a robot under load
//! cargo run --release -- hostile        an app's latency while other peers misbehave
//! ```
//!
//! The robot, the apps and the attackers are separate processes on loopback. `FC_CONNECTIONS`, `FC_CALLS` and
//! `FC_ROUNDS` change the numbers. `FC_ATTACK` chooses one attack: bombs, keys, lengths, slow, held, codes, deaf,
//! frames, panics, reports, connections or silent.

mod apps;
mod attacks;
mod environment;
mod fault;
mod hostile;
mod measure;
mod robot;

use environment::number;
use fault::Fault;
use std::process::ExitCode;

async fn run(words: &[&str]) -> Result<(), Fault> {
    match *words {
        ["robot", total, address] => {
            let (total, address) = (total.parse()?, address.parse()?);
            robot::serve(robot::Places { total, address }).await
        }
        ["attack", kind, port, data] => attacks::attack(kind, port.parse()?, data.parse()?).await,
        ["connections"] => apps::connections(number("FC_CONNECTIONS", 10_000)?).await,
        ["calls"] => apps::calls(number("FC_CALLS", 1_000_000)?).await,
        ["shutdown"] => apps::shutdown().await,
        ["hostile"] => hostile::compare().await,
        ["all"] => {
            apps::connections(number("FC_CONNECTIONS", 10_000)?).await?;
            apps::calls(number("FC_CALLS", 1_000_000)?).await?;
            apps::shutdown().await?;
            hostile::compare().await
        }
        _ => Err("say what to measure: all, connections, calls, shutdown or hostile".into()),
    }
}

#[tokio::main]
async fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    match run(&words).await {
        Ok(()) => ExitCode::SUCCESS,
        Err(fault) => {
            eprintln!("{fault}");
            ExitCode::FAILURE
        }
    }
}
