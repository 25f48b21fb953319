//! Robots, apps and what is known of every call and report.

use super::common::net::loopback;
use super::common::{LIMITS, Toy};
use super::random::Random;
use super::rough::{Both, Rough};
use super::wire::{Old, Weather, Wire};
use fc_derive::{Command, Message, Report};
use fc_runtime::{
    AckOutcome, Audience, Backoff, CallError, CallOptions, ClientConfig, Command, Connection,
    ConnectionId, Handling, Limits, Refusal, Request, Server, ServerConfig, ServerHandle,
};
use std::collections::{BTreeMap, HashMap};
use std::io::{Error, ErrorKind};
use std::net::{Ipv4Addr, SocketAddr};
use std::sync::{Arc, Mutex, MutexGuard};
use std::time::Duration;
use tokio::net::TcpStream;
use tokio::task::AbortHandle;
use tokio::time::{sleep, timeout};

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

/// What a call was and how it ended.
#[derive(Debug, Default)]
pub struct Call {
    pub effect: &'static str,
    pub repeat: Option<bool>,
    /// How often the robot has begun to carry it out.
    pub carried_out: u32,
    pub ends: Vec<&'static str>,
}

/// What is known of everything that happened.
#[derive(Default)]
pub struct Model {
    pub calls: HashMap<u32, Call>,
    /// How often each report was handed on.
    pub handed_on: HashMap<u32, u32>,
    pub outcomes: HashMap<u32, &'static str>,
    pub wires: Vec<Wire>,
    pub connects: u64,
    /// All that happened, in order.
    pub log: Vec<String>,
}

pub type Shared = Arc<Mutex<Model>>;

pub fn lock(model: &Shared) -> MutexGuard<'_, Model> {
    model.lock().unwrap()
}

/// A robot that serves until it is dropped.
pub struct Present {
    pub handle: ServerHandle<Toy>,
    address: SocketAddr,
    serving: AbortHandle,
}

impl Drop for Present {
    fn drop(&mut self) {
        self.serving.abort();
    }
}

/// The robot of the moment; `None` while it starts.
pub type Slot = Arc<Mutex<Option<Present>>>;

/// A robot whose handlers answer at once, later, with a refusal or never, as the number says.
pub async fn robot(model: &Shared, first_id: u32) -> Present {
    let model = Arc::clone(model);
    let serve = move |request: Request<'_, Toy>| -> Handling {
        let model = Arc::clone(&model);
        let carry_out = move |number: u32| async move {
            lock(&model)
                .calls
                .get_mut(&number)
                .expect("a call")
                .carried_out += 1;
            match number % 16 {
                0 => std::future::pending().await,
                1 => return Err(Refusal::new(500, "no")),
                2..6 => sleep(Duration::from_millis(u64::from(number % 700))).await,
                _ => {}
            }
            Ok(Seen { number })
        };
        match request.code() {
            Look::CODE => request.handle(move |_, Look { number }| carry_out(number)),
            Tune::CODE => request.handle(move |_, Tune { number }| carry_out(number)),
            Drive::CODE => request.handle(move |_, Drive { number }| carry_out(number)),
            _ => request.unknown(),
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
        .handler_timeout(Duration::from_millis(900))
        .idle_timeout(Some(Duration::from_secs(120)));
    let server = Server::bind(config, serve).await.unwrap();
    let (handle, address) = (server.handle(), server.command_addr());
    let serving = tokio::spawn(server.run()).abort_handle();
    Present {
        handle,
        address,
        serving,
    }
}

/// How an app reaches the robot of the moment.
pub struct Line {
    pub slot: Slot,
    pub model: Shared,
    pub random: Random,
    pub weather: Weather,
    pub breaks: bool,
    /// Over TCP, and not over a simulated wire.
    pub sockets: bool,
    pub old: Old,
}

impl Line {
    pub async fn dial(mut self, delay: Duration) -> Result<Rough, Error> {
        sleep(delay).await;
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
            let address = SocketAddr::from((Ipv4Addr::LOCALHOST, 9));
            robot.handle.serve(end, address).ok_or_else(refused)?;
            lock(&self.model).wires.push(wire);
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
            "read" => app.call_with(&Look { number }, options).await,
            "config" => app.call_with(&Tune { number }, options).await,
            _ => app.call_with(&Drive { number }, options).await,
        }
    };
    let end = match timeout(patience, calling).await {
        Err(_) => "given up",
        Ok(Ok(seen)) => {
            assert_eq!(seen.number, number, "the answer of another call");
            "answered"
        }
        Ok(Err(CallError::Refused(refusal))) if refusal.code == 72 => "handler timeout",
        Ok(Err(error)) => error.name(),
    };
    let mut model = lock(&model);
    model.log.push(format!("call {number} {effect}: {end}"));
    model.calls.get_mut(&number).expect("a call").ends.push(end);
}

/// Pushes one report to one app and notes what became of it.
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

/// What came of a run, in numbers.
pub type Tally = BTreeMap<&'static str, u64>;

impl Model {
    /// Checks all promises at the end of a run.
    pub fn check(&self, tally: &mut Tally) {
        for (number, call) in &self.calls {
            assert_eq!(
                call.ends.len(),
                1,
                "call {number} has ended {:?}",
                call.ends
            );
            let end = call.ends[0];
            *tally
                .entry(match end {
                    "answered" => "calls answered",
                    "refused" => "calls refused",
                    "handler timeout" => "calls ended by the handler timeout",
                    "timeout" => "calls timed out",
                    "lost" => "calls lost",
                    "busy" => "calls refused as too many",
                    "closed" | "not_connected" => "calls not sent",
                    "given up" => "calls given up by the caller",
                    other => panic!("call {number}: {other}"),
                })
                .or_default() += 1;
            let once =
                call.effect != "read" && call.repeat != Some(true) || call.repeat == Some(false);
            if once {
                assert!(
                    call.carried_out <= 1,
                    "{} {number} was carried out {} times",
                    call.effect,
                    call.carried_out
                );
            } else if call.carried_out > 1 {
                *tally.entry("calls repeated after a loss").or_default() += 1;
            }
            match end {
                "answered" | "refused" | "handler timeout" => {
                    assert!(call.carried_out >= 1, "call {number}");
                }
                "busy" | "closed" | "not_connected" => {
                    assert_eq!(call.carried_out, 0, "call {number} was sent");
                }
                _ => {}
            }
        }
        for (number, outcome) in &self.outcomes {
            let handed_on = self.handed_on.get(number).copied().unwrap_or(0);
            assert!(
                handed_on <= 1,
                "report {number} was handed on {handed_on} times"
            );
            *tally
                .entry(match *outcome {
                    "acknowledged" => {
                        assert_eq!(
                            handed_on, 1,
                            "report {number} was acknowledged and not handed on"
                        );
                        "reports acknowledged"
                    }
                    "dropped" => {
                        assert_eq!(handed_on, 0, "report {number} was dropped and handed on");
                        "reports dropped by a full queue"
                    }
                    "timed out" => "reports not acknowledged in time",
                    "closed" => "reports cut off by a loss",
                    "no_connection" => "reports to nobody",
                    other => panic!("report {number}: {other}"),
                })
                .or_default() += 1;
        }
        assert!(
            self.handed_on
                .keys()
                .all(|number| self.outcomes.contains_key(number))
        );
        *tally.entry("connections").or_default() += self.connects;
        *tally
            .entry("frames said twice, swapped, replayed or forged")
            .or_default() += self.wires.iter().map(Wire::odd).sum::<u64>();
    }
}
