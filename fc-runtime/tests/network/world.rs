//! Robots and apps with their behaviour.

use super::common::net::loopback;
use super::common::{LIMITS, Toy};
use super::lane::{Old, Weather};
use super::model::{Call, Shared, lock};
use super::random::Random;
use super::rough::{Both, Rough};
use super::wire::Wire;
use fc_derive::{Command, Message, Report};
use fc_runtime::{
    AckOutcome, Audience, Backoff, CallError, CallOptions, ClientConfig, Command, Connection,
    ConnectionId, ConnectionState, Context, Handling, Limits, Protocol, Refusal, Request, Server,
    ServerConfig, ServerHandle,
};
use std::io::{Error, ErrorKind};
use std::net::SocketAddr;
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;
use tokio::net::TcpStream;
use tokio::task::AbortHandle;
use tokio::time::{Instant, sleep, timeout};

/// Asks for something.
#[derive(Clone, Debug, PartialEq, Message, Command)]
#[fc(code = 0x0201, name = "look", effect = "read", response = Seen)]
pub struct Look {
    pub number: u32,
}

/// Sets something.
#[derive(Clone, Debug, PartialEq, Message, Command)]
#[fc(code = 0x0202, name = "tune", effect = "config", response = Seen)]
pub struct Tune {
    pub number: u32,
}

/// Moves.
#[derive(Clone, Debug, PartialEq, Message, Command)]
#[fc(code = 0x0203, name = "drive", effect = "motion", response = Seen)]
pub struct Drive {
    pub number: u32,
}

#[derive(Clone, Debug, PartialEq, Message)]
pub struct Seen {
    pub number: u32,
}

/// Tells of something, and asks for an acknowledgement soon.
#[derive(Clone, Debug, PartialEq, Message, Report)]
#[fc(code = 0x0B02, name = "tick", ack(timeout_ms = 200, retries = 3))]
pub struct Tick {
    pub number: u32,
}

/// The course of a handler.
pub const HANDLER_TIMEOUT: Duration = Duration::from_millis(900);

/// A robot that serves until it is dropped.
pub struct Present {
    pub handle: ServerHandle<Toy>,
    address: SocketAddr,
    serving: AbortHandle,
    model: Shared,
    /// Handlers that have panicked.
    panics: Arc<AtomicU64>,
}

impl Drop for Present {
    fn drop(&mut self) {
        let mut model = lock(&self.model);
        model.cut_off(Instant::now());
        let (panics, counters) = (self.panics.load(Ordering::Relaxed), self.handle.counters());
        if counters.handlers_panicked != panics {
            let counted = counters.handlers_panicked;
            model.faults.push(format!(
                "{panics} handlers panicked, {counted} were counted"
            ));
        }
        self.serving.abort();
    }
}

/// The end of a handler.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Course {
    Never,
    Refuses,
    Later,
    AtOnce,
    Panics,
    PanicsLater,
}

impl Course {
    pub fn of(number: u32) -> Self {
        match number % 16 {
            0 => Self::Never,
            1 => Self::Refuses,
            2..6 => Self::Later,
            6 => Self::Panics,
            7 => Self::PanicsLater,
            _ => Self::AtOnce,
        }
    }
}

/// The course of such a number is [`Course::AtOnce`].
pub fn easy(n: usize) -> u32 {
    1_000_000 + 16 * u32::try_from(n).unwrap() + 8
}

/// The robot of the moment; `None` while it starts.
pub type Slot = Arc<Mutex<Option<Present>>>;

/// A robot whose handlers take the course of the number.
pub async fn robot(model: &Shared, first_id: u32) -> Present {
    let panics = Arc::new(AtomicU64::new(0));
    let serve = {
        let (model, panics) = (Arc::clone(model), Arc::clone(&panics));
        move |request: Request<'_, Toy>| -> Handling {
            let (model, panics) = (Arc::clone(&model), Arc::clone(&panics));
            let carry_out = move |context: Context<Toy>, number: u32| async move {
                lock(&model).begins(number, context.peer, context.id);
                let course = Course::of(number);
                if matches!(course, Course::Later | Course::PanicsLater) {
                    sleep(Duration::from_millis(u64::from(number % 700))).await;
                }
                match course {
                    Course::Never => std::future::pending().await,
                    Course::Refuses => Err(Refusal::new(500, "no")),
                    Course::Panics | Course::PanicsLater => {
                        panics.fetch_add(1, Ordering::Relaxed);
                        // Without a word on standard error.
                        resume_unwind(Box::new("on purpose"))
                    }
                    Course::Later | Course::AtOnce => Ok(Seen { number }),
                }
            };
            match request.code() {
                Look::CODE => request.handle(move |of, Look { number }| carry_out(of, number)),
                Tune::CODE => request.handle(move |of, Tune { number }| carry_out(of, number)),
                Drive::CODE => request.handle(move |of, Drive { number }| carry_out(of, number)),
                _ => request.unknown(),
            }
        }
    };
    let limits = Limits {
        in_flight: 6,
        queued_reports: 4,
        ..LIMITS
    };
    let config: ServerConfig = loopback()
        .limits(limits)
        .first_id(first_id)
        .handler_timeout(HANDLER_TIMEOUT)
        .idle_timeout(Some(Duration::from_secs(120)));
    let server = Server::bind(config, serve).await.unwrap();
    let (handle, address) = (server.handle(), server.command_addr());
    let serving = tokio::spawn(server.run()).abort_handle();
    Present {
        handle,
        address,
        serving,
        model: Arc::clone(model),
        panics,
    }
}

/// How an app reaches the robot of the moment.
pub struct Line {
    pub slot: Slot,
    pub model: Shared,
    pub random: Random,
    pub weather: Weather,
    pub breaks: bool,
    /// No more faults.
    pub calm: Arc<AtomicBool>,
    /// Over TCP, and not over a simulated wire.
    pub sockets: bool,
    pub old: Old,
}

impl Line {
    pub async fn dial(mut self, delay: Duration) -> Result<Rough, Error> {
        sleep(delay).await;
        if self.calm.load(Ordering::Relaxed) {
            (self.weather, self.breaks) = (Weather::CALM, false);
        }
        let refused = || Error::from(ErrorKind::ConnectionRefused);
        let stream: Box<dyn Both> = if self.sockets {
            let address = self
                .slot
                .lock()
                .unwrap()
                .as_ref()
                .map(|robot| robot.address);
            Box::new(TcpStream::connect(address.ok_or_else(refused)?).await?)
        } else {
            let slot = self.slot.lock().unwrap();
            let robot = slot.as_ref().ok_or_else(refused)?;
            let (wire, app, end) =
                Wire::new(&mut self.random, self.weather, self.breaks, &self.old);
            let mut model = lock(&self.model);
            let address = model.address_of_next();
            robot.handle.serve(end, address).ok_or_else(refused)?;
            model.wires.push(wire);
            Box::new(app)
        };
        let mut model = lock(&self.model);
        model.connects += 1;
        model.log.push("an app has connected".into());
        let left = self.sockets && self.breaks && self.random.one_in(2);
        let left = left.then(|| self.random.below(3000));
        Ok(Rough {
            stream,
            random: self.random.fork(),
            left,
        })
    }
}

pub fn app_config(random: &mut Random) -> ClientConfig {
    let limits = Limits {
        in_flight: 5,
        queued_reports: 3,
        ..LIMITS
    };
    let at_once = Backoff {
        first: Duration::ZERO,
        longest: Duration::ZERO,
        attempts: None,
    };
    let near_the_end = u32::MAX - u32::try_from(random.below(8)).unwrap();
    ClientConfig::new()
        .limits(limits)
        .reconnect(at_once)
        .first_id(random.pick(&[7, near_the_end, 92_345_678]))
        .call_timeout(Duration::from_millis(1500))
}

/// Makes one call and notes how it ended.
pub async fn call(app: Connection<Toy>, model: Shared, number: u32, mut random: Random) {
    let options = CallOptions {
        timeout: random.one_in(3).then(|| random.ms(2000)),
        repeat: random.pick(&[None, None, None, Some(true), Some(false)]),
    };
    let effect = random.pick(&["read", "config", "motion"]);
    let patience = if random.one_in(6) {
        random.ms(1000)
    } else {
        Duration::from_secs(100_000)
    };
    let known = Call {
        effect,
        repeat: options.repeat,
        ..Call::default()
    };
    lock(&model).calls.insert(number, known);
    let calling = async {
        match effect {
            "read" => app.call(&Look { number }).with_options(options).await,
            "config" => app.call(&Tune { number }).with_options(options).await,
            _ => app.call(&Drive { number }).with_options(options).await,
        }
    };
    let end = match timeout(patience, calling).await {
        Err(_) => "given up",
        Ok(Ok(seen)) => {
            assert_eq!(seen.number, number, "the answer of another call");
            "answered"
        }
        Ok(Err(CallError::Refused(refusal))) if refusal.code == Toy::RESULTS.timeout.code => {
            "handler timeout"
        }
        Ok(Err(CallError::Refused(refusal))) if refusal.code == Toy::RESULTS.protocol.code => {
            assert_eq!(refusal.text, "protocol: the handler panicked");
            "panicked"
        }
        Ok(Err(error)) => error.name(),
    };
    let mut model = lock(&model);
    model.log.push(format!("call {number} {effect}: {end}"));
    model.calls.get_mut(&number).expect("a call").ends.push(end);
}

/// Calls until there is a response, and returns the time it took, or `None` without a response.
pub async fn insist(
    app: Connection<Toy>,
    model: Shared,
    numbers: std::ops::Range<u32>,
) -> Option<Duration> {
    let start = Instant::now();
    for number in numbers.step_by(16) {
        let known = Call {
            effect: "read",
            ..Call::default()
        };
        lock(&model).calls.insert(number, known);
        let end = app.call(&Look { number }).await;
        let mut model = lock(&model);
        let call = model.calls.get_mut(&number).expect("a call");
        match end {
            Ok(_) => {
                call.ends.push("answered");
                return Some(start.elapsed());
            }
            Err(error) => {
                call.ends.push(error.name());
                model
                    .log
                    .push(format!("call {number} in the calm: {error}"));
            }
        }
    }
    None
}

/// Notes why an app loses its connections, until it has ended.
pub async fn watch(app: Connection<Toy>, model: Shared) {
    let mut states = app.states();
    drop(app);
    while let Some(state) = states.recv().await {
        if let ConnectionState::Connecting { why, .. } = state {
            *lock(&model).losses.entry(why.name()).or_default() += 1;
        }
    }
}

/// Pushes one report to one app and notes the outcome.
pub async fn push(handle: ServerHandle<Toy>, to: ConnectionId, model: Shared, number: u32) {
    let outcome = match handle.push(Audience::One(to), &Tick { number }).await {
        Err(error) => error.name(),
        Ok(acknowledged) => match acknowledged[0].outcome {
            AckOutcome::Acknowledged => "acknowledged",
            AckOutcome::TimedOut => "timed out",
            AckOutcome::Dropped => "dropped",
            AckOutcome::Closed => "closed",
            ref other => panic!("{other:?}"),
        },
    };
    let mut model = lock(&model);
    model.log.push(format!("report {number}: {outcome}"));
    let earlier = model.outcomes.insert(number, outcome);
    assert_eq!(earlier, None, "a report ended twice");
}

/// Takes an app's reports, now and then slowly, until the connection has ended.
pub async fn collect(
    app: &Connection<Toy>,
    model: Shared,
    mut random: Random,
) -> impl Future<Output = ()> + use<> {
    let mut reports = app.reports();
    async move {
        while let Some(report) = reports.recv().await {
            let number = report.read::<Toy, Tick>().expect("a tick").number;
            *lock(&model).handed_on.entry(number).or_default() += 1;
            if random.one_in(4) {
                sleep(random.ms(1500)).await;
            }
        }
    }
}
