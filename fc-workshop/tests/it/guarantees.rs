//! The guarantees of the runtime over a faulty link: a call ends once, and a report is delivered once.
//!
//! `FC_SEEDS` sets the number of seeds for each fault.

use crate::support::small;
use fc_derive::{Command, Envelope, Header, Message, OpenEnum, Report};
use fc_reflect::Reflector;
use fc_runtime::{
    AckOutcome, AckPolicy, Audience, ClientConfig, Connection, Defaults, Handling, Limits,
    OperationInfo, Protocol, RawReports, Request, ResultText, Results, Server, ServerConfig,
    ServerHandle, Service,
};
use fc_spec::model::Model;
use fc_workshop::capture::Flow;
use fc_workshop::fault::{Fault, FaultKind, When};
use fc_workshop::proxy::{Event, Settings, forward};
use std::collections::HashMap;
use std::net::{Ipv4Addr, SocketAddr};
use std::sync::{Arc, Mutex};
use std::time::Duration;
use tokio::task::JoinSet;
use tokio::time::{sleep, timeout};

/// Calls and reports in each run.
const CALLS: u8 = 6;
const REPORTS: u8 = 4;

/// The time after which a call or a report counts as hanging.
const HANGING: Duration = Duration::from_secs(120);

#[derive(Clone, Copy, Debug, PartialEq, Eq, Header)]
#[fc(byte_order = "little")]
struct LampHeader {
    #[fc(role = "head")]
    head: [u8; 3],
    #[fc(role = "total_length")]
    total: u32,
    #[fc(value = 513)]
    spare: u64,
    #[fc(role = "digest")]
    sum: [u8; 16],
    #[fc(value = 0)]
    pad: u16,
    #[fc(role = "encoding")]
    packing: u8,
    #[fc(role = "plain_length")]
    plain: u32,
    #[fc(role = "kind")]
    what: u8,
    #[fc(role = "code")]
    op: u16,
    #[fc(role = "id")]
    seq: u32,
}

#[derive(Clone, Debug, PartialEq, Message, Envelope)]
#[fc(envelope = "request")]
struct LampRequest {
    #[fc(role = "time")]
    at: Option<i64>,
}

#[derive(Clone, Debug, PartialEq, Message, Envelope)]
#[fc(envelope = "response")]
struct LampResponse {
    #[fc(role = "time")]
    at: Option<i64>,
    #[fc(key = "rc", role = "result_code")]
    result: i16,
    #[fc(key = "say", role = "result_text")]
    say: Option<String>,
}

#[derive(Clone, Debug, PartialEq, Message, Command)]
#[fc(example = r#"{"lvl":7}"#)]
#[fc(code = 0x0102, name = "set_light", effect = "config", response = SetLightResponse)]
struct SetLight {
    #[fc(key = "lvl")]
    level: u8,
    mood: Option<Mood>,
}

#[derive(Clone, Debug, PartialEq, Message)]
struct SetLightResponse {
    left: u64,
}

#[derive(Clone, Debug, PartialEq, Message, Report)]
#[fc(code = 0x0201, name = "dimmed")]
struct Dimmed {
    lux: f64,
}

#[derive(Clone, Debug, PartialEq, Eq, OpenEnum)]
#[fc(repr = str)]
enum Mood {
    #[fc(value = "calm")]
    Calm,
    #[fc(value = "b\"d")]
    Bad,
    #[fc(other)]
    Unknown(String),
}

/// The protocol of the small spec.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Lamp;

const fn result(code: i64, text: &'static str) -> ResultText {
    ResultText { code, text }
}

impl Protocol for Lamp {
    type Header = LampHeader;
    type Request = LampRequest;
    type Response = LampResponse;

    const NAME: &'static str = "lamp";
    const HOST: &'static str = "127.0.0.1";
    const COMMAND_PORT: u16 = 0;
    const DATA_PORT: u16 = 0;
    const REQUEST_HEAD: &'static [u8] = b"LA?";
    const RESPONSE_HEAD: &'static [u8] = b"LA!";
    const STREAM: u8 = 0x10;
    const COMMAND: u8 = 0x20;
    const REPORT: u8 = 0x30;
    const RESERVED_KINDS: &'static [u8] = &[0x40];
    const PLAIN: u8 = 8;
    const GZIP: Option<u8> = Some(9);
    const ZERO_PLAIN_LENGTH: bool = true;
    const RESULTS: Results = Results {
        success: result(0, "success"),
        protocol: result(1, "protocol error"),
        timeout: result(2, "timeout"),
        invalid: result(3, "invalid"),
        expired: result(4, "expired"),
    };
    const DEFAULTS: Defaults = Defaults {
        call_timeout: Duration::from_secs(3),
        handler_timeout: Duration::from_millis(2500),
        max_age: None,
        ack: AckPolicy {
            timeout: Duration::from_secs(2),
            retries: 3,
        },
        limits: Limits {
            frame_bytes: 4096,
            inflated_bytes: 8192,
            inflate_ratio: Limits::INFLATE_RATIO,
            json_depth: 12,
            json_values: Limits::JSON_VALUES,
            json_list_bytes: Limits::JSON_LIST_BYTES,
            in_flight: 4,
            queued_reports: 4,
            connections: 2,
        },
    };

    fn operations() -> &'static [OperationInfo] {
        &[]
    }
}

/// Each fault, with numbers that fit the timeouts of the protocol.
fn faults() -> Vec<FaultKind> {
    let mut faults = FaultKind::PLAIN.to_vec();
    faults.push(FaultKind::Delay(Duration::from_millis(1900)));
    faults.push(FaultKind::Slow(std::num::NonZeroU32::new(40).unwrap()));
    faults
}

/// The number of times that each value was counted.
#[derive(Clone, Default)]
struct Counts(Arc<Mutex<HashMap<u8, usize>>>);

impl Counts {
    fn add(&self, value: u8) {
        *self.0.lock().unwrap().entry(value).or_default() += 1;
    }

    fn of(&self, value: u8) -> usize {
        self.0.lock().unwrap().get(&value).copied().unwrap_or(0)
    }
}

/// Runs calls and reports over a link with this fault, and checks the end of each. Returns the number of faults.
async fn run(reflector: &Reflector<'_>, kind: FaultKind, seed: u64) -> usize {
    let what = format!("{}, seed {seed}", kind.name());
    let handled = Counts::default();
    let counts = handled.clone();
    let robot = serve(move |request: Request<'_, Lamp>| -> Handling {
        let counts = counts.clone();
        request.handle(move |_, SetLight { level, .. }| async move {
            counts.add(level);
            let left = u64::from(level);
            Ok(SetLightResponse { left })
        })
    })
    .await;
    let (near, far) = (tokio::io::duplex(1024), tokio::io::duplex(1024));
    robot.serve(far.1, nowhere()).unwrap();
    let when = When::Chance(30);
    let settings = Settings {
        commands: String::new(),
        data: String::new(),
        faults: vec![Fault {
            kind,
            code: None,
            when,
        }],
        seed,
    };
    let flow = Flow {
        from: nowhere(),
        to: nowhere(),
    };
    let mut struck = 0;
    let mut count = |event: Event<'_, '_>| {
        struck += usize::from(matches!(event, Event::Faults { .. }));
        Ok(())
    };
    let link = forward(reflector, &settings, (flow, 1), (near.1, far.0), &mut count);
    let talk = async {
        let app = Connection::<Lamp>::over(near.0, ClientConfig::new());
        let received = Counts::default();
        let mut delivery = tokio::spawn(receive(app.reports(), received.clone()));
        let reports = reports(&robot);
        tokio::join!(calls(&app, &handled, &what), async {
            let acknowledged = reports.await;
            for number in acknowledged {
                assert_eq!(
                    received.of(number),
                    1,
                    "{what}: acknowledged report {number}"
                );
            }
        });
        app.close();
        (&mut delivery).await.unwrap();
        for number in 1..=REPORTS {
            let times = received.of(number);
            assert!(
                times <= 1,
                "{what}: report {number} was delivered {times} times"
            );
        }
        robot.shutdown(Duration::ZERO).await;
        // The link still holds delayed frames.
        sleep(HANGING).await;
        assert_eq!(robot.memory(), 0, "{what}: memory is left");
    };
    let (forwarded, ()) = tokio::join!(link, talk);
    forwarded.unwrap();
    struck
}

/// Makes calls at the same time, and checks the end of each.
async fn calls(app: &Connection<Lamp>, handled: &Counts, what: &str) {
    let mut ends = JoinSet::new();
    for level in 1..=CALLS {
        let app = app.clone();
        ends.spawn(async move {
            let mood = Some(Mood::Calm);
            let call = SetLight { level, mood };
            let end = timeout(HANGING, app.call(&call)).await;
            (level, end.expect("a call hangs"))
        });
    }
    while let Some(end) = ends.join_next().await {
        let (level, end) = end.unwrap();
        let times = handled.of(level);
        assert!(times <= 1, "{what}: {level} was handled {times} times");
        match end {
            Ok(response) => {
                assert_eq!(response.left, u64::from(level), "{what}: another response");
                assert_eq!(times, 1, "{what}: {level} was answered and not handled");
            }
            Err(error) => assert_ne!(error.name(), "invalid_request", "{what}"),
        }
    }
    assert_eq!(app.in_flight(), 0, "{what}");
}

/// Sends reports at the same time. Returns those that were acknowledged.
async fn reports(robot: &ServerHandle<Lamp>) -> Vec<u8> {
    let mut pushes = JoinSet::new();
    for number in 1..=REPORTS {
        let robot = robot.clone();
        pushes.spawn(async move {
            let lux = f64::from(number);
            let end = timeout(HANGING, robot.push(Audience::All, &Dimmed { lux })).await;
            (number, end.expect("a report hangs").unwrap())
        });
    }
    let mut acknowledged = Vec::new();
    while let Some(end) = pushes.join_next().await {
        let (number, outcomes) = end.unwrap();
        let mut outcomes = outcomes.into_iter().map(|it| it.outcome);
        if outcomes.any(|outcome| matches!(outcome, AckOutcome::Acknowledged)) {
            acknowledged.push(number);
        }
    }
    acknowledged
}

/// Counts each received report until the connection ends.
async fn receive(mut reports: RawReports<Lamp>, received: Counts) {
    while let Some(raw) = reports.recv().await {
        let report = raw.read::<Lamp, Dimmed>().unwrap();
        let number = (1..=REPORTS).find(|number| f64::from(*number).total_cmp(&report.lux).is_eq());
        received.add(number.unwrap());
    }
}

async fn serve(service: impl Service<Lamp>) -> ServerHandle<Lamp> {
    let config = ServerConfig::new().address(Ipv4Addr::LOCALHOST);
    let server = Server::bind(config, service).await.unwrap();
    let handle = server.handle();
    tokio::spawn(server.run());
    handle
}

fn nowhere() -> SocketAddr {
    SocketAddr::from((Ipv4Addr::LOCALHOST, 9))
}

fn seeds() -> u64 {
    let seeds = std::env::var("FC_SEEDS").ok();
    seeds.map_or(50, |seeds| seeds.parse().unwrap())
}

#[test]
fn calls_and_reports_end_once_over_a_faulty_link() {
    let model: Model = small();
    let reflector = Reflector::new(&model);
    for kind in faults() {
        let mut struck = 0;
        for seed in 0..seeds() {
            let runtime = tokio::runtime::Builder::new_current_thread()
                .enable_all()
                .start_paused(true)
                .build()
                .unwrap();
            struck += runtime.block_on(run(&reflector, kind, seed));
        }
        assert!(struck > 0, "{} has never struck", kind.name());
    }
}
