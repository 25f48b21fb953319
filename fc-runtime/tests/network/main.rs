//! Schedules of everything that can go wrong between apps and a robot, each from one seed, over a
//! simulated network on simulated time; the real client and server at both ends.
//!
//! `CHAOS_SCHEDULES=10000 cargo test -p fc-runtime --release --test network -- --nocapture` runs more
//! of them; `CHAOS_SEED=…` runs one again and prints what happened.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::indexing_slicing,
    clippy::print_stdout,
    clippy::print_stderr,
    clippy::cast_possible_truncation,
    reason = "a test may"
)]

#[path = "../common/mod.rs"]
mod common;
mod random;
mod wire;
mod world;

use common::Toy;
use fc_runtime::Connection;
use random::Random;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex};
use std::time::Duration;
use tokio::task::JoinSet;
use tokio::time::{advance, sleep, timeout};
use wire::{Old, Weather};
use world::{Line, Model, Shared, Slot, Tally, app_config, call, collect, lock, push, robot};

/// The seed of the first schedule; the others count on.
const FIRST_SEED: u64 = 1;
const SCHEDULES: u64 = 1000;
/// Most bytes one direction of a wire may hold: its window and one write.
const UNDER_WAY: usize = 64 * 1024;

fn number(name: &str) -> Option<u64> {
    let value = std::env::var(name).ok()?;
    Some(
        value
            .parse()
            .unwrap_or_else(|_| panic!("{name} is no number: {value}")),
    )
}

fn run(seed: u64, tally: &mut Tally) -> Vec<String> {
    let model = Shared::default();
    let result = catch_unwind(AssertUnwindSafe(|| {
        tokio::runtime::Builder::new_current_thread()
            .enable_all()
            .start_paused(true)
            .build()
            .unwrap()
            .block_on(play(seed, Arc::clone(&model)));
        lock(&model).check(tally);
    }));
    let log = std::mem::take(
        &mut model
            .lock()
            .unwrap_or_else(std::sync::PoisonError::into_inner)
            .log,
    );
    if let Err(cause) = result {
        eprintln!("the schedule of CHAOS_SEED={seed} has failed; the last of what happened:");
        for line in log.iter().rev().take(30).rev() {
            eprintln!("  {line}");
        }
        std::panic::resume_unwind(cause);
    }
    log
}

async fn play(seed: u64, model: Shared) {
    let mut random = Random::new(seed);
    let weather = Weather {
        delay: random.pick(&[1, 50, 400, 2500]),
        twice: random.pick(&[0, 4, 12]),
        swap: random.pick(&[0, 5, 15]),
    };
    let breaks = random.one_in(2);
    // A robot without a clock begins with the same id each time it starts.
    let robot_ids = random.pick(&[Some(7), Some(u32::MAX - 2), None]);
    let first_id = move |random: &mut Random| robot_ids.unwrap_or_else(|| random.next() as u32);
    let slot: Slot = Slot::default();
    let id = first_id(&mut random);
    *slot.lock().unwrap() = Some(robot(&model, id).await);

    let mut apps = Vec::new();
    let mut collectors = JoinSet::new();
    for _ in 0..1 + random.below(3) {
        let old = Old::default();
        let lines = Mutex::new(random.fork());
        let (slot, its_model) = (Arc::clone(&slot), Arc::clone(&model));
        let dial = move || {
            let mut random = lines.lock().unwrap().fork();
            let delay = Duration::from_millis(1) + random.ms(200);
            Line {
                slot: Arc::clone(&slot),
                model: Arc::clone(&its_model),
                random,
                weather,
                breaks,
                old: Arc::clone(&old),
            }
            .dial(delay)
        };
        let config = app_config(&mut random);
        let app = Connection::<Toy>::connect_by(dial, config)
            .await
            .expect("the robot is up");
        collectors.spawn(collect(&app, Arc::clone(&model), random.fork()).await);
        apps.push(app);
    }

    let mut calls = JoinSet::new();
    let mut pushes = JoinSet::new();
    let mut numbers = 0;
    for _ in 0..20 + random.below(60) {
        numbers += 1;
        match random.below(100) {
            0..50 => {
                let app = apps[random.below(apps.len())].clone();
                calls.spawn(call(app, Arc::clone(&model), numbers, random.fork()));
            }
            50..72 => {
                let server = slot.lock().unwrap().clone();
                let known = lock(&model).connections.clone();
                if let (Some(server), false) = (server, known.is_empty()) {
                    let to = known[known.len() - 1 - random.below(known.len().min(4))];
                    pushes.spawn(push(server, to, Arc::clone(&model), numbers));
                }
            }
            72..88 => {
                let longest = random.pick(&[2, 50, 50, 600, 3000]);
                sleep(random.ms(longest)).await;
            }
            88..92 => storm(&model, &mut random),
            92..96 => {
                lock(&model).log.push("the robot goes down".into());
                lock(&model).connections.clear();
                *slot.lock().unwrap() = None;
                sleep(random.ms(800)).await;
                let id = first_id(&mut random);
                *slot.lock().unwrap() = Some(robot(&model, id).await);
                lock(&model).log.push("the robot is back".into());
            }
            96..98 => {
                lock(&model).log.push("the clock jumps".into());
                advance(random.ms(3_600_000)).await;
            }
            _ => tokio::task::yield_now().await,
        }
        assert!(
            apps.iter().all(|app| app.in_flight() <= 5),
            "more in flight than may be"
        );
        let most = lock(&model).wires.iter().map(wire::Wire::under_way).max();
        assert!(most.unwrap_or(0) < UNDER_WAY, "{most:?} bytes under way");
    }

    // The last of it: every call and every report has to end by itself.
    let ending = async {
        while let Some(ended) = calls.join_next().await {
            ended.expect("no call panics");
        }
        while let Some(ended) = pushes.join_next().await {
            ended.expect("no push panics");
        }
    };
    timeout(Duration::from_secs(3600), ending)
        .await
        .expect("every call and every report ends");
    for app in &apps {
        assert_eq!(app.in_flight(), 0, "something is left in flight");
        app.close();
    }
    let collecting = async {
        while collectors
            .join_next()
            .await
            .transpose()
            .expect("no panic")
            .is_some()
        {}
    };
    timeout(Duration::from_secs(3600), collecting)
        .await
        .expect("reports end with the connection");
}

/// Breaks a wire, or makes it swallow what it is given.
fn storm(model: &Shared, random: &mut Random) {
    let mut model = lock(model);
    let Model { wires, log, .. } = &mut *model;
    let Some(wire) = wires
        .len()
        .checked_sub(1 + random.below(3))
        .and_then(|at| wires.get(at))
    else {
        return;
    };
    match random.below(5) {
        which @ 0..3 => {
            log.push(format!("a wire swallows {which}"));
            wire.swallow(which);
        }
        _ => {
            log.push("a wire breaks".into());
            wire.reset();
        }
    }
}

#[test]
fn calls_end_once_reports_are_handed_on_once_and_nothing_moves_twice() {
    if let Some(seed) = number("CHAOS_SEED") {
        let mut tally = Tally::new();
        for line in run(seed, &mut tally) {
            println!("{line}");
        }
        return;
    }
    let schedules = number("CHAOS_SCHEDULES").unwrap_or(SCHEDULES);
    let mut tally = Tally::new();
    for seed in FIRST_SEED..FIRST_SEED + schedules {
        run(seed, &mut tally);
    }
    println!(
        "{schedules} schedules, CHAOS_SEED {FIRST_SEED} to {}",
        FIRST_SEED + schedules - 1
    );
    for (what, count) in &tally {
        println!("{count:>9} {what}");
    }
    // A network in which nothing goes wrong proves nothing.
    for wanted in [
        "calls answered",
        "calls lost",
        "calls timed out",
        "calls repeated after a loss",
        "reports acknowledged",
        "reports cut off by a loss",
        "reports not acknowledged in time",
    ] {
        assert!(
            schedules < SCHEDULES || tally.contains_key(wanted),
            "no {wanted}"
        );
    }
}

#[test]
fn a_seed_is_always_the_same_schedule() {
    for seed in [3, 14, 159] {
        let mut tally = Tally::new();
        assert_eq!(run(seed, &mut tally), run(seed, &mut tally));
    }
}
