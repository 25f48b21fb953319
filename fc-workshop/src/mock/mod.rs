//! A robot that is played from a spec, on all its ports.
//!
//! [`Mock::start`] runs one in a thread, for tests. [`serve`] runs one in the caller's task.

mod apps;
mod memory;
mod process;
mod robot;
mod streams;

use crate::connection::{Connection, Event, until};
use crate::facts;
use crate::listen::{self, ListenError, Listeners};
use crate::run;
use crate::scenario::{Scenario, Verdict};
use apps::{Apps, Report};
use fc_reflect::Reflector;
use fc_spec::model::Model;
use futures_util::FutureExt as _;
use futures_util::future::join_all;
use futures_util::stream::{FuturesUnordered, StreamExt as _};
use robot::{Answer, Robot};
use std::cell::RefCell;
use std::net::SocketAddr;
use std::pin::pin;
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};
use streams::Streams;
use tokio::net::TcpStream;
use tokio::sync::{Notify, oneshot};

/// Time between the last expected event of a scenario and its end.
const CALM: Duration = Duration::from_millis(300);

/// The settings of a mock.
#[derive(Clone, Debug)]
pub struct Settings {
    /// The time between two reports of a process whose interval the spec does not specify.
    pub pace: Duration,
    /// Names of commands after which bytes with their code and message id are sent on the data port.
    pub stream_after: Vec<String>,
    /// `true` if commands are accepted although their preconditions are not met.
    pub ignores_preconditions: bool,
    /// The scenario to play.
    pub scenario: Option<Scenario>,
    /// `true` if the mock ends with the scenario: when its expectations are met or broken, or its time is over.
    pub expect: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            pace: Duration::from_millis(500),
            stream_after: Vec::new(),
            ignores_preconditions: false,
            scenario: None,
            expect: false,
        }
    }
}

/// Plays a robot of the model on each pair of ports until `end` is ready, or until their scenarios end. Returns the verdict
/// of a scenario: the first that is not met, or that all are met.
pub async fn serve(
    model: &Model,
    settings: &Settings,
    robots: Vec<Listeners>,
    end: impl Future<Output = ()>,
) -> Option<Verdict> {
    let reflector = &Reflector::new(model);
    let end = end.shared();
    let robots = robots.into_iter();
    let verdicts =
        join_all(robots.map(|listeners| one(reflector, settings, listeners, end.clone())));
    let mut verdicts: Vec<_> = verdicts.await.into_iter().flatten().collect();
    let missed = verdicts.iter().position(|verdict| *verdict != Verdict::Met);
    let shown = missed.unwrap_or(0);
    (shown < verdicts.len()).then(|| verdicts.swap_remove(shown))
}

/// Plays one robot.
async fn one(
    reflector: &Reflector<'_>,
    settings: &Settings,
    listeners: Listeners,
    end: impl Future<Output = ()>,
) -> Option<Verdict> {
    let limits = facts::limits(reflector.model());
    let stage = &Stage {
        reflector,
        robot: RefCell::new(Robot::new(reflector, settings)),
        apps: Apps::new(limits.queued_reports),
        streams: RefCell::new(Streams::new(reflector, settings)),
        data: Apps::new(limits.queued_reports),
        planned: Notify::new(),
    };
    let mut talks = FuturesUnordered::new();
    let mut data = FuturesUnordered::new();
    let mut end = pin!(end);
    let scenario = settings.scenario.as_ref().filter(|_| settings.expect);
    let mut over = scenario.and_then(|it| Instant::now().checked_add(it.within));
    let mut is_met = false;
    loop {
        let due = stage.next_due();
        let verdict = stage.robot.borrow().verdict();
        match &verdict {
            Some(Verdict::Forbidden(_)) if settings.expect => return verdict,
            Some(Verdict::Met) if settings.expect && !is_met => {
                // The app still receives its last response, and may still send what it must not send.
                is_met = true;
                over = Instant::now().checked_add(CALM);
            }
            _ => {}
        }
        tokio::select! {
            () = &mut end => return verdict,
            () = until(over) => return verdict,
            app = listen::accept(&listeners.commands), if talks.len() < limits.connections => {
                talks.push(stage.talk(app));
            }
            app = listen::accept(&listeners.data), if data.len() < limits.connections => {
                data.push(stage.stream(app));
            }
            Some(()) = talks.next(), if !talks.is_empty() => {}
            Some(()) = data.next(), if !data.is_empty() => {}
            () = until(due) => stage.send_due(),
            // The next report may now be an earlier one.
            () = stage.planned.notified() => {}
        }
    }
}

/// The parts of a mock that its connections share.
struct Stage<'m> {
    reflector: &'m Reflector<'m>,
    robot: RefCell<Robot<'m>>,
    /// Connections of the command port.
    apps: Apps<Report>,
    streams: RefCell<Streams<'m>>,
    /// Connections of the data port.
    data: Apps<Arc<[u8]>>,
    /// Notified after a command, which may have planned reports.
    planned: Notify,
}

impl<'m> Stage<'m> {
    fn next_due(&self) -> Option<Instant> {
        let report = self.robot.borrow().next_due();
        let stream = self.streams.borrow().next_due();
        report.into_iter().chain(stream).min()
    }

    fn send_due(&self) {
        let now = Instant::now();
        while let Some(report) = self.robot.borrow_mut().due(now) {
            self.apps.send(&report);
        }
        for frame in self.streams.borrow_mut().due(now) {
            self.data.send(&frame);
        }
    }

    /// Talks with one app until it ends the connection.
    async fn talk(&self, stream: TcpStream) {
        let mut connection: Connection<'m, _, ()> =
            Connection::new(self.reflector, stream, facts::first_id());
        let mut reports = self.apps.join();
        let mut is_greeted = false;
        loop {
            tokio::select! {
                event = connection.next() => {
                    let Some(answer) = (match event {
                        Event::Ended(_) => break,
                        other => self.answer(other),
                    }) else {
                        continue;
                    };
                    if !answer.delay.is_zero() {
                        // Responses keep their order, and the next request waits in the socket.
                        tokio::time::sleep(answer.delay).await;
                    }
                    connection.send(&answer.bytes);
                    if answer.disconnect {
                        break;
                    }
                    if answer.accepted.is_some() && !std::mem::replace(&mut is_greeted, true) {
                        for report in self.robot.borrow().greeting() {
                            self.push(&mut connection, &report);
                        }
                    }
                }
                Some(report) = reports.recv() => self.push(&mut connection, &report),
            }
        }
        // The app may have closed only its sending side.
        let _ = connection.finish().await;
    }

    /// Returns the answer to a request of an app.
    fn answer(&self, event: Event<'m, ()>) -> Option<Answer<'m>> {
        let mut robot = self.robot.borrow_mut();
        match event {
            Event::Command(frame) | Event::Report(frame) | Event::Stream(frame) => {
                let answer = robot.answer(&frame)?;
                self.planned.notify_one();
                if let Some(command) = answer.accepted {
                    let mut streams = self.streams.borrow_mut();
                    if let Some(bytes) = streams.accept(command, frame.id) {
                        self.data.send(&bytes);
                    }
                }
                Some(answer)
            }
            Event::Invalid(id, error) => robot.answer_invalid(id, &error),
            Event::Answer((), frame) => {
                robot.acknowledged(&frame);
                self.planned.notify_one();
                None
            }
            Event::Expired(()) | Event::Late(_) | Event::Ended(_) => None,
        }
    }

    fn push(&self, connection: &mut Connection<'m, TcpStream, ()>, report: &Report) {
        let kind = self.reflector.model().frame.kinds.report.value;
        // An app with too many unacknowledged reports misses this one.
        let _ = connection.request(kind, report.code, &report.data, report.ack, ());
    }

    /// Sends streams to one app until it ends the connection.
    async fn stream(&self, stream: TcpStream) {
        let mut connection: Connection<'m, _, ()> =
            Connection::new(self.reflector, stream, facts::first_id());
        let mut frames = self.data.join();
        for frame in self.streams.borrow().latest() {
            connection.send(frame);
        }
        loop {
            tokio::select! {
                event = connection.next() => if let Event::Ended(_) = event { break },
                Some(frame) = frames.recv(), if !connection.is_full() => connection.send(&frame),
            }
        }
        // The app may have closed only its sending side.
        let _ = connection.finish().await;
    }
}

/// A mock in its own thread. It stops when it is dropped.
#[derive(Debug)]
pub struct Mock {
    commands: SocketAddr,
    data: SocketAddr,
    stop: Option<oneshot::Sender<()>>,
    thread: Option<JoinHandle<Option<Verdict>>>,
}

impl Mock {
    /// Starts a mock on any free ports of loopback.
    ///
    /// # Errors
    /// [`ListenError`] if it cannot listen.
    pub fn start(model: Model, settings: Settings) -> Result<Self, ListenError> {
        let runtime = run::runtime().map_err(ListenError::System)?;
        let listeners = runtime.block_on(Listeners::bind("127.0.0.1", 0, 0))?;
        let (commands, data) = listeners.addresses()?;
        let (stop, stopped) = oneshot::channel::<()>();
        let play = move || {
            runtime.block_on(serve(&model, &settings, vec![listeners], async {
                // A dropped sender stops the mock, too.
                let _ = stopped.await;
            }))
        };
        let thread = std::thread::Builder::new().name("mock".to_owned());
        let thread = thread.spawn(play).map_err(ListenError::System)?;
        Ok(Self {
            commands,
            data,
            stop: Some(stop),
            thread: Some(thread),
        })
    }

    /// Waits for the end of a scenario with `expect`, and returns its verdict.
    #[must_use]
    pub fn verdict(mut self) -> Option<Verdict> {
        self.thread.take().and_then(|thread| thread.join().ok())?
    }

    /// Returns the address of the command port.
    #[must_use]
    pub fn commands(&self) -> SocketAddr {
        self.commands
    }

    /// Returns the address of the data port.
    #[must_use]
    pub fn data(&self) -> SocketAddr {
        self.data
    }
}

impl Drop for Mock {
    fn drop(&mut self) {
        drop(self.stop.take());
        if let Some(thread) = self.thread.take() {
            // A panic of the thread was printed already.
            let _ = thread.join();
        }
    }
}
