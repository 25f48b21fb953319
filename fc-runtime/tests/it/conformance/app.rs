//! Scripts against a whole client.

use super::peer::{Operation, Peer, Results, Wire, limits, milliseconds};
use super::script::{Action, Ends, Event, Failure, Given, Got, Open, defaults};
use crate::common::{Echo, Go, Toy};
use fc_runtime::{
    Backoff, CallError, CallOptions, ClientConfig, Connection, ConnectionState, ConnectionStates,
    RawReports,
};
use futures_util::FutureExt as _;
use std::io::ErrorKind;
use std::sync::Arc;
use std::time::Duration;
use tokio::io::DuplexStream;
use tokio::sync::{Mutex, mpsc};
use tokio::task::AbortHandle;

/// It dials at once, and gets a connection at a step of the script.
const AT_ONCE: Backoff = Backoff {
    first: Duration::ZERO,
    longest: Duration::ZERO,
    attempts: None,
};
/// No script advances the clock so far.
const PATIENT: Duration = Duration::from_secs(365 * 24 * 60 * 60);

pub struct App {
    connection: Connection<Toy>,
    wire: Wire,
    pipes: mpsc::UnboundedSender<DuplexStream>,
    states: ConnectionStates,
    receivers: Vec<RawReports<Toy>>,
    calls: Vec<AbortHandle>,
    /// By the calls' numbers.
    results: Results<(usize, &'static str)>,
    /// Reports of a receiver that have not been checked yet.
    taken: Option<Event>,
}

impl Peer for App {
    async fn start(given: &Given) -> Self {
        let (pipes, dialled) = mpsc::unbounded_channel();
        let dialled = Arc::new(Mutex::new(dialled));
        let dial = move || {
            let dialled = Arc::clone(&dialled);
            async move {
                let pipe = dialled.lock().await.recv().await;
                pipe.ok_or_else(|| ErrorKind::ConnectionRefused.into())
            }
        };
        let mut wire = Wire::default();
        pipes.send(wire.connect()).unwrap();
        let config = ClientConfig::new()
            .limits(limits(given))
            .call_timeout(milliseconds(given.call_timeout, defaults::CALL_TIMEOUT))
            .connect_timeout(PATIENT)
            .reconnect(AT_ONCE)
            .first_id(given.first_id);
        let app = Connection::connect_by(dial, config).await.unwrap();
        let mut states = app.states();
        states.recv().await;
        Self {
            wire,
            pipes,
            states,
            receivers: (0..given.receivers.unwrap_or(1))
                .map(|_| app.reports())
                .collect(),
            calls: Vec::new(),
            results: Results::new(),
            taken: None,
            connection: app,
        }
    }

    fn wire(&mut self) -> &mut Wire {
        &mut self.wire
    }

    async fn act(&mut self, action: Action<'_>) -> Result<(), Failure> {
        match action {
            Action::Call(open) => self.call(open)?,
            Action::Cancel(name) => self.calls[self.wire.number_of(name)?].abort(),
            Action::Lose(_) => self.wire.lose(),
            Action::Reconnect => self.pipes.send(self.wire.connect()).unwrap(),
            Action::Take => self.take()?,
            Action::Close => self.connection.close(),
            other => return Err(format!("an app cannot do that: {other:?}")),
        }
        Ok(())
    }

    fn look(&mut self, got: &mut Got) {
        while let Some((number, with)) = self.results.next() {
            let (name, with) = (self.wire.name_of(number), with.to_owned());
            got.push(Event::Ends(Ends { name, with }));
        }
        while let Some(Some(state)) = self.states.recv().now_or_never() {
            got.push(match state {
                ConnectionState::Connected { .. } => Event::Connected,
                ConnectionState::Connecting { .. } => Event::Connecting,
                ConnectionState::Closed { .. } => Event::Closed,
            });
        }
        if let Some(taken) = self.taken.take() {
            got.push(taken);
        }
    }

    fn in_flight(&self) -> Option<usize> {
        Some(self.connection.in_flight())
    }
}

impl App {
    fn call(&mut self, open: &Open) -> Result<(), Failure> {
        let number = self.wire.request(open);
        let options = CallOptions {
            timeout: open.timeout.map(Duration::from_millis),
            repeat: open.repeat,
        };
        let (app, results) = (self.connection.clone(), self.results.sender.clone());
        let reads = match Operation::of(open.code)? {
            Operation::Read => true,
            Operation::Motion => false,
            Operation::Report => return Err("a report is not called".to_owned()),
        };
        let call = tokio::spawn(async move {
            let result = if reads {
                let text = number.to_string();
                app.call(&Echo { text })
                    .with_options(options)
                    .await
                    .map(drop)
            } else {
                let metres = i32::try_from(number).unwrap();
                app.call(&Go { metres })
                    .with_options(options)
                    .await
                    .map(drop)
            };
            let with = result.as_ref().err().map_or("success", CallError::name);
            let _ = results.send((number, with));
        });
        self.calls.push(call.abort_handle());
        Ok(())
    }

    /// A receiver looks whether there is a report.
    fn take(&mut self) -> Result<(), Failure> {
        let receiver = self
            .receivers
            .first_mut()
            .ok_or("nobody receives reports")?;
        let Some(Some(report)) = receiver.recv().now_or_never() else {
            return Ok(());
        };
        let body = serde_json::from_slice(&report.text).map_err(|error| error.to_string())?;
        let name = self.wire.arrived(report.code, report.id, Some(&body));
        self.taken = Some(Event::HandsOn(name.ok_or("a report of nobody")?));
        Ok(())
    }
}
