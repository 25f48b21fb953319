//! An app for trying out a connection under trouble that somebody else makes: reads on while the
//! connection is cut, gives calls up, and calls on while the robot ends.
//!
//! ```text
//! cargo run --example drill -- --command-port PORT
//! ```
//!
//! It prints a line when a part begins, for the one who makes the trouble, and one when it has ended.

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

/// Calls in flight at a time.
const AT_ONCE: usize = 64;
/// Reads that are to be answered though the connection is cut.
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

    // Another one, which does not come back: that the robot has ended ends its calls.
    let client = Client::connect(args.client().reconnect(None)).await?;
    println!("calling");
    let answered = call_to_the_end(&client).await?;
    println!("ended: {answered} answered, {AT_ONCE} lost");
    Ok(())
}

/// Each call is a read, so it is sent again after a loss, and every single one is answered.
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

/// Sends calls and drops them before an answer can have come; the connection serves on.
async fn give_up(client: &Client) -> Result<(), CallError> {
    let request = GetRobotSnRequest::example();
    let mut calls: Vec<_> = (0..AT_ONCE)
        .map(|_| Box::pin(client.get_robot_sn(&request).into_future()))
        .collect();
    std::future::poll_fn(|context| {
        for call in &mut calls {
            // Whatever has come of it, nobody is interested any more.
            let _ = call.as_mut().poll(context);
        }
        Poll::Ready(())
    })
    .await;
    drop(calls);
    client.get_robot_sn(&request).await.map(drop)
}

/// Calls until the robot has gone, and tells how many were answered. Every call has an end, and the end of the last ones says that
/// the connection was lost.
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
