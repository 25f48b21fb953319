//! Random schedules of faults between apps and a robot, each from one seed. Network and time are simulated. Client and
//! server are the real ones.
//!
//! `CHAOS_SCHEDULES=10000 cargo test -p fc-runtime --release --test network -- --nocapture` runs more schedules.
//! `CHAOS_SEED=…` repeats one and prints its events. With `--ignored`, the test uses real sockets and real time.
//!
//! The test failed with each of these changes:
//!
//! - Reports: acknowledge without remembering, queue a report twice, or acknowledge invalid reports.
//! - Reports: identify them by id alone, or treat missing acknowledgements as received.
//! - Calls: repeat every command after a loss, or execute one twice.
//! - Calls: match responses without id, code or kind, or swap responses.
//! - Calls: never time out, lose a call, or have no limit of calls or reports.
//! - Robot: drop unsent data after the end of the app's direction, a wrong head or a stalled frame.
//! - Robot: forget running handlers in these cases, or never abort after the grace period.
//! - Robot: do not catch, answer or count a panic.
//! - App: drop responses before garbage or before the end, or wait without limit for a robot that does not read.
//! - Both: wait without limit for the rest of a frame.

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

#[allow(
    dead_code,
    clippy::expect_used,
    clippy::indexing_slicing,
    reason = "a part of it is used here"
)]
#[path = "../it/common/mod.rs"]
mod common;
mod garbage;
mod lane;
mod ledger;
mod model;
mod random;
mod rough;
mod storm;
mod wire;
mod world;

use common::Toy;
use fc_runtime::{Connection, ServerHandle};
use lane::{Old, Weather};
use model::{Shared, Tally, lock};
use random::Random;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;
use storm::storm;
use tokio::task::JoinSet;
use tokio::time::{Instant, advance, sleep, timeout};

use world::{
    HANDLER_TIMEOUT, Line, Slot, app_config, call, collect, easy, insist, push, robot, watch,
};

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
            .block_on(play(seed, Arc::clone(&model), false));
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

/// Everything there is while a schedule runs.
struct World {
    random: Random,
    model: Shared,
    slot: Slot,
    sockets: bool,
    robot_ids: Option<u32>,
    /// No more faults.
    calm: Arc<AtomicBool>,
    apps: Vec<Connection<Toy>>,
    /// Apps that have been closed.
    gone: Vec<Connection<Toy>>,
    calls: JoinSet<()>,
    pushes: JoinSet<()>,
    collectors: JoinSet<()>,
}

async fn play(seed: u64, model: Shared, sockets: bool) {
    let mut random = Random::new(seed);
    let weather = Weather {
        delay: random.pick(&[1, 50, 400, 2500]),
        twice: random.pick(&[0, 4, 12]),
        swap: random.pick(&[0, 5, 15]),
    };
    let mut world = World {
        // A robot without a clock begins with the same id each time it starts.
        robot_ids: random.pick(&[Some(7), Some(u32::MAX - 2), None]),
        random,
        model,
        slot: Slot::default(),
        sockets,
        calm: Arc::default(),
        apps: Vec::new(),
        gone: Vec::new(),
        calls: JoinSet::new(),
        pushes: JoinSet::new(),
        collectors: JoinSet::new(),
    };
    world.start_robot().await;
    let breaks = world.random.one_in(2);
    for _ in 0..=world.random.below(3) {
        world.start_app(weather, breaks).await;
    }
    for number in 1..=20 + world.random.below(60) as u32 {
        world.step(number, weather, breaks).await;
        let in_flight = world.apps.iter().map(Connection::in_flight).max();
        assert!(in_flight.unwrap_or(0) <= 5, "more in flight than may be");
        let most = lock(&world.model)
            .wires
            .iter()
            .map(wire::Wire::under_way)
            .max();
        assert!(most.unwrap_or(0) < UNDER_WAY, "{most:?} bytes under way");
    }
    world.end().await;
}

impl World {
    async fn start_robot(&mut self) {
        let chosen = self.random.next() as u32;
        let present = robot(&self.model, self.robot_ids.unwrap_or(chosen)).await;
        *self.slot.lock().unwrap() = Some(present);
    }

    async fn start_app(&mut self, weather: Weather, breaks: bool) {
        let old = Old::default();
        let lines = Mutex::new(self.random.fork());
        let (slot, model, sockets) = (
            Arc::clone(&self.slot),
            Arc::clone(&self.model),
            self.sockets,
        );
        let calm = Arc::clone(&self.calm);
        let dial = move || {
            let mut random = lines.lock().unwrap().fork();
            let delay = Duration::from_millis(1) + random.ms(200);
            Line {
                slot: Arc::clone(&slot),
                model: Arc::clone(&model),
                random,
                weather,
                breaks,
                calm: Arc::clone(&calm),
                sockets,
                old: Arc::clone(&old),
            }
            .dial(delay)
        };
        let config = app_config(&mut self.random);
        let app = Connection::<Toy>::connect_by(dial, config).await;
        let app = app.expect("the robot is up");
        let collector = collect(&app, Arc::clone(&self.model), self.random.fork()).await;
        self.collectors.spawn(collector);
        let watching = watch(app.clone(), Arc::clone(&self.model));
        self.collectors.spawn(watching);
        self.apps.push(app);
    }

    /// The current robot.
    fn handle(&self) -> Option<ServerHandle<Toy>> {
        let slot = self.slot.lock().unwrap();
        slot.as_ref().map(|robot| robot.handle.clone())
    }

    fn log(&self, what: &str) {
        lock(&self.model).log.push(what.to_owned());
    }

    async fn step(&mut self, number: u32, weather: Weather, breaks: bool) {
        match self.random.below(100) {
            0..50 => {
                let app = self.apps[self.random.below(self.apps.len())].clone();
                let random = self.random.fork();
                self.calls
                    .spawn(call(app, Arc::clone(&self.model), number, random));
            }
            50..72 => {
                let Some(handle) = self.handle() else { return };
                let connections = handle.connections();
                if !connections.is_empty() {
                    let (to, _) = connections[self.random.below(connections.len())];
                    self.pushes
                        .spawn(push(handle, to, Arc::clone(&self.model), number));
                }
            }
            72..84 => {
                let longest = self.random.pick(&[2, 50, 50, 600, 3000]);
                sleep(self.random.ms(longest)).await;
            }
            84..92 => storm(&self.model, &mut self.random),
            92..96 => {
                if self.random.one_in(2) {
                    self.shut_down().await;
                }
                self.log("the robot goes down");
                *self.slot.lock().unwrap() = None;
                sleep(self.random.ms(800)).await;
                self.start_robot().await;
                self.log("the robot is back");
            }
            96..98 if !self.sockets => {
                self.log("the clock jumps");
                advance(self.random.ms(3_600_000)).await;
            }
            98 => self.exchange_app(weather, breaks).await,
            _ => tokio::task::yield_now().await,
        }
    }

    /// Ends the robot while apps continue. It must end in time.
    async fn shut_down(&mut self) {
        let grace = self.random.pick(&[0, 300, 2000]);
        let grace = Duration::from_millis(grace);
        let Some(handle) = self.handle() else { return };
        self.log("the robot is shut down");
        let start = Instant::now();
        lock(&self.model).cut_off(start + grace);
        let ending = timeout(Duration::from_secs(3600), handle.shutdown(grace)).await;
        ending.expect("the robot ends");
        let late = start.elapsed().saturating_sub(grace);
        assert!(
            self.sockets || late <= Duration::from_millis(1),
            "{late:?} late"
        );
    }

    /// An app is closed, whatever it has in flight, and another one comes.
    async fn exchange_app(&mut self, weather: Weather, breaks: bool) {
        if self.slot.lock().unwrap().is_none() {
            return;
        }
        self.log("an app is closed");
        let at = self.random.below(self.apps.len());
        let app = self.apps.swap_remove(at);
        app.close();
        self.gone.push(app);
        self.start_app(weather, breaks).await;
    }

    /// Without further faults, every app gets responses again.
    async fn find_calm(&mut self) {
        self.log("all is calm");
        self.calm.store(true, Ordering::Relaxed);
        let mut waiting = JoinSet::new();
        for (n, app) in self.apps.iter().enumerate() {
            let numbers = easy(1000 * n)..easy(1000 * (n + 1));
            waiting.spawn(insist(app.clone(), Arc::clone(&self.model), numbers));
        }
        while let Some(wait) = waiting.join_next().await {
            let wait = wait.expect("nobody who insists panics");
            lock(&self.model).waits.push(wait);
        }
    }

    /// The end: every call and every report must have ended.
    async fn end(mut self) {
        let ending = async {
            while let Some(ended) = self.calls.join_next().await {
                ended.expect("no call panics");
            }
            while let Some(ended) = self.pushes.join_next().await {
                ended.expect("no push panics");
            }
        };
        timeout(Duration::from_secs(3600), ending)
            .await
            .expect("every call and every report ends");
        self.find_calm().await;
        for app in self.apps.iter().chain(&self.gone) {
            assert_eq!(app.in_flight(), 0, "something is left in flight");
            app.close();
        }
        let collecting = async {
            while let Some(ended) = self.collectors.join_next().await {
                ended.expect("no collector panics");
            }
        };
        timeout(Duration::from_secs(3600), collecting)
            .await
            .expect("reports end with the connection");
        if !self.sockets {
            // Running requests are answered if possible.
            sleep(2 * HANDLER_TIMEOUT).await;
        }
        *self.slot.lock().unwrap() = None;
    }
}

/// Number of schedules.
fn schedules() -> u64 {
    number("CHAOS_SCHEDULES").unwrap_or(SCHEDULES)
}

/// Many times their usual duration.
fn within() -> Duration {
    Duration::from_secs(120)
        + Duration::from_millis(200).saturating_mul(schedules().try_into().unwrap_or(u32::MAX))
}

#[fc_test::test(within = within())]
fn calls_end_once_and_nothing_moves_twice() {
    if let Some(seed) = number("CHAOS_SEED") {
        let mut tally = Tally::new();
        for line in run(seed, &mut tally) {
            println!("{line}");
        }
        return;
    }
    let schedules = schedules();
    let last = FIRST_SEED + schedules - 1;
    let mut tally = Tally::new();
    for seed in FIRST_SEED..=last {
        run(seed, &mut tally);
    }
    println!("{schedules} schedules, CHAOS_SEED {FIRST_SEED} to {last}");
    for (what, count) in &tally {
        println!("{count:>9} {what}");
    }
    // A network without faults proves nothing.
    for wanted in [
        "calls answered",
        "calls lost",
        "calls timed out",
        "calls refused as too many",
        "calls repeated after a loss",
        "reports acknowledged",
        "reports cut off by a loss",
        "reports dropped by a full queue",
        "reports not acknowledged in time",
        "requests answered after the app's half-close",
        "requests answered after garbage",
        "calls ended by a panic",
        "connections lost: a frame stalled",
        "connections lost: the robot does not read",
        "connections lost: no frame",
        "connections lost: ended inside a frame",
        "half-closes by the app",
        "half-closes by the robot",
        "garbage to the robot",
        "garbage to the app",
        "apps that stop inside a frame",
        "robots that stop inside a frame",
        "robots that say nothing for long",
        "robots that do not read",
    ] {
        assert!(
            schedules < SCHEDULES || tally.contains_key(wanted),
            "no {wanted}"
        );
    }
}

#[fc_test::test]
fn a_seed_is_always_the_same_schedule() {
    for seed in [3, 14, 159] {
        let mut tally = Tally::new();
        assert_eq!(run(seed, &mut tally), run(seed, &mut tally));
    }
}

/// Not the same each time: the machine's own timing has its part.
#[fc_test::test]
#[ignore = "takes some seconds of real time"]
fn the_same_over_real_sockets() {
    let schedules = number("CHAOS_SCHEDULES").unwrap_or(100);
    let mut tally = Tally::new();
    tokio::runtime::Builder::new_multi_thread()
        .worker_threads(2)
        .enable_all()
        .build()
        .unwrap()
        .block_on(async {
            let mut running = JoinSet::new();
            for seed in FIRST_SEED..=schedules {
                running.spawn(async move {
                    let model = Shared::default();
                    play(seed, Arc::clone(&model), true).await;
                    model
                });
            }
            while let Some(model) = running.join_next().await {
                lock(&model.expect("no schedule fails")).check(&mut tally);
            }
        });
    println!("{schedules} schedules over real sockets");
    for (what, count) in &tally {
        println!("{count:>9} {what}");
    }
}
