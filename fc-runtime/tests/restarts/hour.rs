//! The robot, the app and the network between them.

use super::ALLOCATOR;
use super::cable::{Cable, End};
use super::common::log::{Entry, Log};
use super::common::net::{Raw, loopback};
use super::common::{Toy, command};
use super::log::Line;
use super::traffic::{self, Known, Look, SECOND, Shared, call_on, note_states, push_on, take_on};
use fc_runtime::{
    AckOutcome, Audience, Backoff, ClientConfig, Command, Connection, Report, Server, ServerConfig,
    ServerHandle,
};
use std::future::pending;
use std::io::{self, ErrorKind};
use std::net::{Ipv4Addr, SocketAddr};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;
use tokio::io::{DuplexStream, duplex};
use tokio::sync::mpsc;
use tokio::task::{AbortHandle, JoinSet, yield_now};
use tokio::time::{Instant, sleep, sleep_until};
use tracing::Level;

/// The state of the machine at the robot's address.
enum Answering {
    /// The machine is there, and no program.
    Refuses,
    Nobody,
    Robot(ServerHandle<Toy>),
    /// A test.
    Raw(mpsc::UnboundedSender<End>),
}

struct Network {
    answering: Answering,
    /// The app's current connection.
    cable: Option<Cable>,
    /// The state after the network is back.
    away: Option<Answering>,
}

struct Robot {
    handle: ServerHandle<Toy>,
    serving: AbortHandle,
    pushing: AbortHandle,
}

impl Drop for Robot {
    fn drop(&mut self) {
        self.pushing.abort();
        self.serving.abort();
    }
}

struct App {
    connection: Connection<Toy>,
    tasks: JoinSet<()>,
}

pub struct Hour {
    begin: Instant,
    log: Log,
    lines: Vec<Line>,
    events: usize,
    /// Number of starts of robot and app.
    starts: u32,
    network: Arc<Mutex<Network>>,
    known: Shared,
    slow: Arc<AtomicBool>,
    robot: Option<Robot>,
    app: Option<App>,
}

fn nowhere() -> SocketAddr {
    SocketAddr::from((Ipv4Addr::LOCALHOST, 9))
}

async fn dial(network: Arc<Mutex<Network>>) -> io::Result<End> {
    let (cable, app, robot) = Cable::new();
    let nobody = {
        let mut network = network.lock().unwrap();
        match &network.answering {
            Answering::Refuses => return Err(ErrorKind::ConnectionRefused.into()),
            Answering::Nobody => true,
            Answering::Robot(handle) => {
                // One that is not served is closed, as after `accept`.
                let _ = handle.serve(robot, nowhere());
                network.cable = Some(cable);
                false
            }
            Answering::Raw(dialled) => {
                let _ = dialled.send(robot);
                network.cable = Some(cable);
                false
            }
        }
    };
    if nobody {
        pending::<()>().await;
    }
    Ok(app)
}

/// An event.
impl Hour {
    pub fn begin() -> Self {
        Self {
            begin: Instant::now(),
            log: Log::listen(Level::INFO),
            lines: Vec::new(),
            events: 0,
            starts: 0,
            network: Arc::new(Mutex::new(Network {
                answering: Answering::Refuses,
                cable: None,
                away: None,
            })),
            known: Arc::new(Mutex::new(Known::new())),
            slow: Arc::default(),
            robot: None,
            app: None,
        }
    }

    /// Writes the current event to the log.
    pub fn event(&mut self, what: &str) {
        self.take_lines();
        self.events += 1;
        self.lines.push(Line {
            at: self.begin.elapsed(),
            who: "",
            text: what.to_owned(),
        });
    }

    fn take_lines(&mut self) {
        for Entry { at, of_app, line } in self.log.take_entries() {
            self.lines.push(Line {
                at: at.duration_since(self.begin),
                who: if of_app { "app" } else { "robot" },
                text: line,
            });
        }
    }

    pub async fn until(&self, minutes: u64, seconds: u64) {
        let at = self.begin + Duration::from_secs(60 * minutes + seconds);
        assert!(at >= Instant::now(), "it is later than {minutes}:{seconds}");
        sleep_until(at).await;
    }

    fn answer(&self, answering: Answering) {
        self.network.lock().unwrap().answering = answering;
    }

    async fn bind(&mut self, config: ServerConfig) -> ServerHandle<Toy> {
        let service = traffic::service(&self.known);
        // Ids of one start do not come again, as with a clock.
        self.starts += 1;
        self.known.lock().unwrap().is_moving = false;
        let config = config.first_id(100_000 * self.starts);
        let server = Server::bind(config, service).await.unwrap();
        let handle = server.handle();
        let serving = tokio::spawn(server.run()).abort_handle();
        let pushing = push_on(handle.clone(), Arc::clone(&self.known));
        self.robot = Some(Robot {
            handle: handle.clone(),
            serving,
            pushing: tokio::spawn(pushing).abort_handle(),
        });
        handle
    }

    pub async fn start_robot(&mut self) {
        let handle = self.bind(loopback()).await;
        self.answer(Answering::Robot(handle));
    }

    /// A robot that others have connected to first, and as many of them as it takes.
    pub async fn start_crowded(&mut self, places: usize) -> Vec<Raw<DuplexStream>> {
        let limits = fc_runtime::Limits {
            connections: places,
            ..super::common::LIMITS
        };
        let handle = self.bind(loopback().limits(limits)).await;
        let mut crowd = Vec::new();
        for _ in 0..places {
            let (end, robot) = duplex(1024);
            handle.serve(robot, nowhere()).unwrap();
            let mut end = Raw::new(end);
            let look = command(Look::CODE, 1);
            end.send_frame(look, r#"{"number":0}"#).await;
            while end.recv().await.expect("an answer").0 != look.answer() {}
            crowd.push(end);
        }
        self.answer(Answering::Robot(handle));
        crowd
    }

    /// As SIGTERM does.
    pub async fn stop_robot(&mut self) {
        self.answer(Answering::Refuses);
        let robot = self.robot.take().expect("a robot");
        robot.handle.shutdown(5 * SECOND).await;
    }

    /// As SIGKILL does.
    pub fn kill_robot(&mut self) {
        self.answer(Answering::Refuses);
        self.robot = None;
    }

    /// The robot and its machine are gone without a word.
    pub fn cut_power(&mut self) {
        self.answer(Answering::Nobody);
        self.each_cable(Cable::fall_silent);
        self.robot = None;
    }

    /// The machine is there again.
    pub fn boot(&mut self) {
        self.answer(Answering::Refuses);
        self.each_cable(Cable::forget);
    }

    pub fn lose_network(&mut self) {
        let mut network = self.network.lock().unwrap();
        let there = std::mem::replace(&mut network.answering, Answering::Nobody);
        network.away = Some(there);
        drop(network);
        self.each_cable(Cable::fall_silent);
    }

    pub fn find_network(&mut self) {
        let mut network = self.network.lock().unwrap();
        network.answering = network.away.take().expect("a network");
        drop(network);
        self.each_cable(Cable::go_on);
    }

    /// The network is there again; the app's machine has started again and knows nothing of before.
    pub fn forget_app(&mut self) {
        let cable = self.network.lock().unwrap().cable.take();
        self.find_network();
        drop(cable);
    }

    fn each_cable(&self, change: impl Fn(&Cable)) {
        self.network.lock().unwrap().cable.iter().for_each(change);
    }

    /// In the robot's place is a test from now on.
    pub fn replace_robot(&mut self) -> mpsc::UnboundedReceiver<End> {
        let (dialled, connections) = mpsc::unbounded_channel();
        self.answer(Answering::Raw(dialled));
        connections
    }

    /// The robot sends no further reports.
    pub fn hush(&self) {
        self.robot.as_ref().expect("a robot").pushing.abort();
    }

    /// Pushes a report and waits for its outcome.
    pub async fn push(&self, report: &impl Report) -> AckOutcome {
        let robot = self.robot.as_ref().expect("a robot");
        let mut pushed = robot.handle.push(Audience::All, report).await.unwrap();
        assert_eq!(pushed.len(), 1);
        pushed.remove(0).outcome
    }

    pub fn start_app(&mut self) {
        self.starts += 1;
        self.known.lock().unwrap().is_moving = false;
        let config = ClientConfig::new()
            .host("robot-7")
            .command_port(9000)
            .first_id(10_000_000 * self.starts)
            .reconnect(Backoff {
                attempts: Some(63),
                ..Backoff::default()
            });
        let network = Arc::clone(&self.network);
        let connection = Connection::connect_lazy_by(move || dial(Arc::clone(&network)), config);
        let mut tasks = JoinSet::new();
        tasks.spawn(note_states(connection.clone(), Arc::clone(&self.known)));
        tasks.spawn(call_on(connection.clone(), Arc::clone(&self.known)));
        let (known, slow) = (Arc::clone(&self.known), Arc::clone(&self.slow));
        tasks.spawn(take_on(connection.clone(), known, slow));
        self.app = Some(App { connection, tasks });
    }

    pub async fn stop_app(&mut self) {
        let mut app = self.app.take().expect("an app");
        app.connection.close();
        // Its last state is told.
        while self.known.lock().unwrap().states.is_empty() {
            yield_now().await;
        }
        app.tasks.abort_all();
    }

    /// `true` if the app takes no reports.
    pub fn be_slow(&self, slow: bool) {
        self.slow.store(slow, Ordering::Relaxed);
    }
}

/// Observations.
impl Hour {
    /// The app has an answer again within so many seconds.
    pub async fn is_served(&self, within: u32) {
        let start = Instant::now();
        while self.known.lock().unwrap().answered < Some(start) {
            sleep(SECOND / 100).await;
            assert!(
                start.elapsed() <= SECOND * within,
                "no answer after {within} seconds"
            );
        }
    }

    /// The robot has begun with a motion.
    pub async fn is_moving(&self) {
        while !self.known.lock().unwrap().is_moving {
            sleep(SECOND / 100).await;
        }
    }

    /// The states that the app has been told since this was last asked.
    pub fn states(&self) -> Vec<String> {
        std::mem::take(&mut self.known.lock().unwrap().states)
    }

    /// Connections of the robot, calls in flight, and what the robot holds in memory for apps.
    pub fn left(&self) -> (usize, usize) {
        let robot = self.robot.as_ref().expect("a robot");
        let app = self.app.as_ref().expect("an app");
        (robot.handle.connections().len(), app.connection.in_flight())
    }

    /// Memory held in bytes, without the notes of the test.
    pub fn held(&mut self) -> usize {
        self.take_lines();
        let texts: usize = self.lines.iter().map(|line| line.text.capacity()).sum();
        let own = texts + self.lines.capacity() * size_of::<Line>();
        ALLOCATOR.current_usage() - own
    }

    /// Results of calls and reports.
    pub fn counts(&self) -> String {
        let known = self.known.lock().unwrap();
        let (calls, reports) = (&known.ends, &known.outcomes);
        format!("calls: {calls:?}; reports: {reports:?}")
    }

    /// Checks that no command was executed twice and no report delivered twice. Returns the number of events and all
    /// lines.
    pub fn end(mut self) -> (usize, Vec<Line>) {
        self.take_lines();
        let known = self.known.lock().unwrap();
        for number in 1..=known.calls as usize {
            // A read may be sent again after a loss.
            let most = if number.is_multiple_of(2) { 2 } else { 1 };
            assert!(known.carried_out[number] <= most, "call {number}");
        }
        assert!(known.handed_on.iter().all(|times| *times <= 1));
        drop(known);
        (self.events, self.lines)
    }
}
