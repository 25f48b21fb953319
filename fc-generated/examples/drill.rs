//! An app that tests its connection while someone else disturbs it. It reads while the connection
//! is cut, gives calls up, and keeps calling while the robot ends.
//!
//! ```text
//! cargo run --example drill -- --command-port PORT
//! ```
//!
//! It prints a line when each part begins, so that the disturbance can start, and one when it ends.

#![allow(clippy::print_stdout, reason = "an example talks to its reader")]

mod support;

use fc_generated::{Client, GetRobotSnRequest};
use fc_runtime::{CallError, Message};
use futures_util::future::join_all;
use std::cell::Cell;
use std::process::ExitCode;
use std::task::Poll;
use support::{Args, Fault};

const USAGE: &str = "\
Tries out the connection to a robot: reads while it is cut, gives calls up, calls while the robot ends.

Usage: drill [--host 127.0.0.1] [--command-port PORT] [--gzip-from BYTES]

From `reading` on the connection may be cut; `calling` asks for the robot to be ended.";

/// Number of calls in flight at a time.
const AT_ONCE: usize = 64;
/// Number of reads. All must be answered although the connection is cut.
const READS: usize = 1000;

#[tokio::main(flavor = "current_thread")]
async fn main() -> ExitCode {
    support::main(USAGE, run).await
}

async fn run(args: Args) -> Result<(), Fault> {
    let client = Client::connect(args.client()).await?;
    println!("reading");
    read(&client).await?;
    println!("read: {READS} answered");

    give_up(&client).await?;
    println!("given up: {AT_ONCE}, and the next one answered");

    // This client does not reconnect, so its calls end when the robot ends.
    let client = Client::connect(args.client().reconnect(None)).await?;
    println!("calling");
    let answered = call_to_the_end(&client).await?;
    println!("ended: {answered} answered, {AT_ONCE} lost");
    Ok(())
}

/// Each call is a read. It is resent after a loss, so every call is answered.
async fn read(client: &Client) -> Result<(), CallError> {
    let left = Cell::new(READS);
    let one_after_another = async || {
        while let Some(less) = left.get().checked_sub(1) {
            left.set(less);
            client.get_robot_sn(&GetRobotSnRequest::example()).await?;
        }
        Ok(())
    };
    let ends = join_all((0..AT_ONCE).map(|_| one_after_another())).await;
    ends.into_iter().collect()
}

/// Sends calls and drops them before a response can arrive. The connection keeps working.
async fn give_up(client: &Client) -> Result<(), CallError> {
    let request = GetRobotSnRequest::example();
    let mut calls: Vec<_> = (0..AT_ONCE)
        .map(|_| Box::pin(client.get_robot_sn(&request).into_future()))
        .collect();
    std::future::poll_fn(|context| {
        for call in &mut calls {
            // The call is given up, so its result does not matter.
            let _ = call.as_mut().poll(context);
        }
        Poll::Ready(())
    })
    .await;
    drop(calls);
    client.get_robot_sn(&request).await.map(drop)
}

/// Calls until the robot has gone, and returns the number of answered calls. Every call ends, and
/// the last ones report that the connection was lost.
async fn call_to_the_end(client: &Client) -> Result<usize, CallError> {
    let answered = Cell::new(0);
    let until_it_ends = async || loop {
        match client.get_robot_sn(&GetRobotSnRequest::example()).await {
            Ok(_) => answered.set(answered.get() + 1),
            Err(CallError::Lost(_) | CallError::Closed(_) | CallError::NotConnected(_)) => {
                return Ok(());
            }
            Err(other) => return Err(other),
        }
    };
    let ends: Result<Vec<()>, CallError> = join_all((0..AT_ONCE).map(|_| until_it_ends()))
        .await
        .into_iter()
        .collect();
    ends.map(|_| answered.get())
}
