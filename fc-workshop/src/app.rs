//! An app that is played from a spec. It sends the commands that a scenario expects, acknowledges all reports, and compares
//! the responses of the robot with the rules of the scenario.

use crate::answer::Outcome;
use crate::arguments::json;
use crate::client::{Client, ClientError};
use crate::facts;
use crate::scenario::{Action, Expected, Play, Scenario, difference, merge};
use fc_reflect::sample::Profile;
use fc_reflect::{Direction, Frame, Reflector};
use fc_spec::model::{Operation, ResultRole, Text, Value};
use fc_spec::text;
use std::cell::RefCell;
use std::io;
use std::time::Duration;
use tokio::sync::mpsc::Receiver;
use tokio::sync::mpsc::error::TryRecvError;
use tokio::time::{Instant, sleep};

/// The time between two looks for a step.
const STEP: Duration = Duration::from_millis(50);

/// The settings of an app.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Address of the robot's command port.
    pub commands: String,
    /// Address of the robot's data port.
    pub data: String,
    /// The time before each command.
    pub pace: Duration,
    /// The time that a command waits for its response.
    pub timeout: Duration,
    /// `true` if the app ends with the scenario.
    pub expect: bool,
}

/// An observation of an app.
#[derive(Debug)]
pub enum Event<'e, 'm> {
    /// The next command, which waits for a step.
    Waits(&'e str),
    /// A response, with its time after the request.
    Response(&'m Operation, &'e Frame<'m>, Duration),
    /// A report, or a frame on the data port.
    Pushed(&'e Frame<'m>),
    /// The robot did not do what the scenario describes.
    Deviation(&'e str, Text),
}

/// Receives the observations of an app.
pub type Sink<'o, 'm> = dyn FnMut(Event<'_, 'm>) -> io::Result<()> + 'o;

/// An app with connections to both ports of a robot.
pub struct App<'r, 'm> {
    reflector: &'m Reflector<'m>,
    settings: &'r Settings,
    client: Client<'m>,
    data: Client<'m>,
}

impl<'r, 'm> App<'r, 'm> {
    /// Connects to both ports.
    ///
    /// # Errors
    /// [`ClientError::Connect`].
    pub async fn connect(
        reflector: &'m Reflector<'m>,
        settings: &'r Settings,
    ) -> Result<Self, ClientError> {
        let wait = settings.timeout;
        Ok(Self {
            reflector,
            settings,
            client: Client::connect(reflector, &settings.commands, wait).await?,
            data: Client::connect(reflector, &settings.data, wait).await?,
        })
    }

    /// Plays the app that a scenario expects, until `end` is ready or, with [`Settings::expect`], until it is over.
    /// Returns the number of deviations of the robot.
    ///
    /// With `steps`, each command waits for a step. After the last step, the commands go on by themselves.
    ///
    /// # Errors
    /// The error of `sink`.
    pub async fn run(
        self,
        scenario: &Scenario,
        steps: Option<Receiver<()>>,
        sink: &mut Sink<'_, 'm>,
        end: impl Future<Output = ()>,
    ) -> io::Result<usize> {
        let (reflector, settings) = (self.reflector, self.settings);
        let sink = &RefCell::new(sink);
        let mut player = Player {
            reflector,
            settings,
            client: Some(self.client),
            steps,
            sink,
            deviations: 0,
        };
        let ended = tokio::select! {
            () = end => Ok(()),
            ended = player.play(scenario) => ended,
            ended = receive(reflector, settings, self.data, sink) => ended,
        };
        ended.map(|()| player.deviations)
    }
}

/// Shows the frames on the data port. It connects again when the connection ends.
async fn receive<'m>(
    reflector: &'m Reflector<'m>,
    settings: &Settings,
    mut data: Client<'m>,
    sink: &RefCell<&mut Sink<'_, 'm>>,
) -> io::Result<()> {
    loop {
        match data.stream_frame(settings.timeout).await {
            Ok(frame) => sink.borrow_mut()(Event::Pushed(&frame))?,
            Err(ClientError::Silence(_)) => {}
            Err(_) => {
                sleep(settings.pace).await;
                let connected = Client::connect(reflector, &settings.data, settings.timeout);
                if let Ok(client) = connected.await {
                    data = client;
                }
            }
        }
    }
}

/// The command port of an app.
struct Player<'r, 's, 'o, 'm> {
    reflector: &'m Reflector<'m>,
    settings: &'r Settings,
    /// The connection; `None` after its end.
    client: Option<Client<'m>>,
    steps: Option<Receiver<()>>,
    sink: &'s RefCell<&'s mut Sink<'o, 'm>>,
    deviations: usize,
}

impl<'m> Player<'_, '_, '_, 'm> {
    async fn play(&mut self, scenario: &Scenario) -> io::Result<()> {
        let mut play = Play::new(scenario.clone());
        for expected in &scenario.expect {
            match expected {
                Expected::Request(name, with) => {
                    self.idle(self.settings.pace).await?;
                    self.step(name).await?;
                    if let Some(command) = self.reflector.model().operation(name) {
                        self.call(command, with, &mut play).await?;
                    }
                }
                Expected::Acknowledgement(name) => self.report(name, scenario.within).await?,
            }
        }
        while !self.settings.expect {
            self.idle(self.settings.timeout).await?;
        }
        // The last acknowledgement may not be written yet.
        if let Some(client) = self.client.take()
            && let Err(error) = client.close().await
        {
            self.deviates("", error.text())?;
        }
        Ok(())
    }

    /// Receives reports until the next step.
    async fn step(&mut self, name: &str) -> io::Result<()> {
        if self.steps.is_some() {
            self.show(Event::Waits(name))?;
        }
        while let Some(steps) = &mut self.steps {
            match steps.try_recv() {
                Ok(()) => return Ok(()),
                Err(TryRecvError::Empty) => self.idle(STEP).await?,
                Err(TryRecvError::Disconnected) => self.steps = None,
            }
        }
        Ok(())
    }

    /// Receives reports for this time.
    async fn idle(&mut self, time: Duration) -> io::Result<()> {
        let end = Instant::now() + time;
        loop {
            let left = end.saturating_duration_since(Instant::now());
            match self.next_report(left).await {
                Ok(frame) => self.show(Event::Pushed(&frame))?,
                Err(ClientError::Silence(_)) => return Ok(()),
                Err(_) => {
                    sleep(left).await;
                    return Ok(());
                }
            }
        }
    }

    /// Sends a command with its example and these values, and compares the response with the scenario.
    async fn call(
        &mut self,
        command: &'m Operation,
        with: &Value,
        play: &mut Play,
    ) -> io::Result<()> {
        let Some(id) = self.reflector.id(command, Direction::Request, 0) else {
            let missing = text!(
                "还没有功能码，没有发送",
                "it has no code yet and was not sent"
            );
            return self.deviates(&command.name, missing);
        };
        let samples = self.reflector.samples();
        let mut message = samples.message(command, Direction::Request, Profile::Example);
        if *with != Value::Null {
            merge(&mut message, with);
        }
        facts::stamp(self.reflector.model(), Direction::Request, &mut message);
        let action = play.request(&command.name, &message).unwrap_or_default();
        let data = message.to_string().into_bytes().into();
        let wait = self.settings.timeout.saturating_add(action.delay);
        let begun = Instant::now();
        let answer = match self.client().await {
            Ok(client) => client.call(id.kind, id.code, data, wait).await,
            Err(error) => Err(error),
        };
        if let Ok(frame) = &answer {
            self.show(Event::Response(command, frame, begun.elapsed()))?;
        }
        let is_lost = answer.as_ref().is_err_and(ClientError::is_lost);
        if is_lost || action.disconnect {
            self.client = None;
        }
        match deviation(self.reflector, command, &action, answer) {
            Some(deviation) => self.deviates(&command.name, deviation),
            None => Ok(()),
        }
    }

    /// Waits for a report.
    async fn report(&mut self, name: &str, within: Duration) -> io::Result<()> {
        let end = Instant::now() + within;
        loop {
            let left = end.saturating_duration_since(Instant::now());
            match self.next_report(left).await {
                Ok(frame) => {
                    self.show(Event::Pushed(&frame))?;
                    if frame.operation.is_some_and(|report| report.name == name) {
                        return Ok(());
                    }
                }
                Err(error) => return self.deviates(name, error.text()),
            }
        }
    }

    async fn next_report(&mut self, wait: Duration) -> Result<Frame<'m>, ClientError> {
        let report = self.client().await?.report(wait).await;
        if report.as_ref().is_err_and(ClientError::is_lost) {
            self.client = None;
        }
        report
    }

    /// Returns the connection, which is made again after its end.
    async fn client(&mut self) -> Result<&mut Client<'m>, ClientError> {
        let Settings {
            commands, timeout, ..
        } = self.settings;
        let client = if let Some(client) = self.client.take() {
            client
        } else {
            Client::connect(self.reflector, commands, *timeout).await?
        };
        Ok(self.client.insert(client))
    }

    fn show(&self, event: Event<'_, 'm>) -> io::Result<()> {
        self.sink.borrow_mut()(event)
    }

    fn deviates(&mut self, name: &str, deviation: Text) -> io::Result<()> {
        self.deviations += 1;
        self.show(Event::Deviation(name, deviation))
    }
}

/// Returns the difference between an answer and the action of the scenario, or `None`.
fn deviation(
    reflector: &Reflector<'_>,
    command: &Operation,
    action: &Action,
    answer: Result<Frame<'_>, ClientError>,
) -> Option<Text> {
    let frame = match answer {
        Ok(_) if action.silent || action.bad_digest => {
            return Some(text!(
                "有响应，场景中没有",
                "a response, and the scenario has none"
            ));
        }
        Err(_) if action.silent || action.bad_digest => return None,
        Ok(frame) => frame,
        Err(error) => return Some(error.text()),
    };
    let model = reflector.model();
    let invalid = |error: &dyn std::fmt::Display| {
        text!(
            "响应不合规范：{error}",
            "the response breaks the spec: {error}"
        )
    };
    let message = match reflector.message(Some(command), Direction::Response, &frame.data) {
        Ok(message) => message,
        Err(error) => return Some(invalid(&error)),
    };
    let outcome = Outcome::of(model, &message);
    let success = facts::result(model, ResultRole::Success).map(|result| result.code);
    let expected = action.refuse.or(success);
    if outcome.code.is_some() && outcome.code != expected {
        let result = |code: Option<i64>| code.map_or_else(String::new, |code| code.to_string());
        let (expected, found) = (result(expected), result(outcome.code));
        let reason = &outcome.text;
        return Some(text!(
            "结果应为 {expected}，实际为 {found}：{reason}",
            "expected result {expected}, found {found}: {reason}"
        ));
    }
    if action.refuse.is_some() {
        return None;
    }
    if let (Err(error), true) = (&message.body, action.omit.is_empty()) {
        return Some(invalid(error));
    }
    let values = action.answer.as_ref()?;
    let found = std::str::from_utf8(&frame.data).ok().and_then(json);
    let (path, expected, found) = difference(values, found.as_ref(), "")?;
    let found = found.map_or_else(|| text!("没有", "nothing"), |it| text!("{it}", "{it}"));
    Some(text!(
        "`{path}` 应为 {expected}，实际为 {found}",
        "`{path}`: expected {expected}, found {found}",
        path = path,
        expected = expected.to_string(),
        found = found
    ))
}
