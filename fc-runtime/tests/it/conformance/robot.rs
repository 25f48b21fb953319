//! Scripts against a whole server.

use super::peer::{Operation, Peer, Results, Wire, limits, milliseconds, result_code};
use super::script::{Action, Ends, Event, Failure, Given, Got, Open, Outcome, defaults};
use crate::common::net::{self, loopback, nowhere};
use crate::common::{Done, Echo, EchoReply, Go, Moved, Toy};
use fc_runtime::{AckOutcome, Audience, Command as _, Handling, Refusal, Request, Service};
use std::collections::HashMap;
use std::time::Duration;
use tokio::sync::{mpsc, oneshot};

/// The result of a handler, or its panic.
type End = Result<Outcome, Panic>;

struct Panic;

/// A handler at work: the code and id of its command, and the sender that ends it.
type AtWork = (u16, u32, oneshot::Sender<End>);

pub struct Robot {
    server: net::Robot,
    wire: Wire,
    begun: Results<AtWork>,
    handlers: HashMap<String, oneshot::Sender<End>>,
    /// By the reports' numbers.
    results: Results<(usize, &'static str)>,
    over: Results<()>,
}

impl Peer for Robot {
    async fn start(given: &Given) -> Self {
        let begun = Results::new();
        let config = loopback()
            .limits(limits(given))
            .handler_timeout(milliseconds(
                given.handler_timeout,
                defaults::HANDLER_TIMEOUT,
            ))
            .first_id(given.first_id);
        let server = net::Robot::start(config, service(begun.sender.clone())).await;
        let mut wire = Wire::default();
        server.handle.serve(wire.connect(), nowhere()).unwrap();
        Self {
            server,
            wire,
            begun,
            handlers: HashMap::new(),
            results: Results::new(),
            over: Results::new(),
        }
    }

    fn wire(&mut self) -> &mut Wire {
        &mut self.wire
    }

    async fn act(&mut self, action: Action<'_>) -> Result<(), Failure> {
        match action {
            Action::Report(open) => self.push(open)?,
            Action::Lose(_) => self.wire.lose(),
            Action::Reconnect => {
                let served = self.server.handle.serve(self.wire.connect(), nowhere());
                served.ok_or("the robot does not take the connection")?;
            }
            Action::Finish(finish) => {
                let handler = self.handlers.remove(&finish.handler_of);
                let handler = handler.ok_or("there is no such handler")?;
                // It may have been dropped meanwhile.
                let end = match (finish.result, finish.fails) {
                    (Some(result), false) => Ok(result),
                    (None, true) => Err(Panic),
                    _ => return Err("a handler has a result or fails".to_owned()),
                };
                let _ = handler.send(end);
            }
            Action::Shutdown(shutdown) => {
                let (handle, over) = (self.server.handle.clone(), self.over.sender.clone());
                let grace = Duration::from_millis(shutdown.grace);
                tokio::spawn(async move {
                    handle.shutdown(grace).await;
                    let _ = over.send(());
                });
            }
            other => return Err(format!("a robot cannot do that: {other:?}")),
        }
        Ok(())
    }

    fn look(&mut self, got: &mut Got) {
        while let Some((code, id, handler)) = self.begun.next() {
            let name = self.wire.arrived(code, id, None).unwrap_or_default();
            self.handlers.insert(name.clone(), handler);
            got.push(Event::Handles(name));
        }
        while let Some((number, with)) = self.results.next() {
            let (name, with) = (self.wire.name_of(number), with.to_owned());
            got.push(Event::Ends(Ends { name, with }));
        }
        while let Some(()) = self.over.next() {
            got.push(Event::Over);
        }
    }

    fn in_flight(&self) -> Option<usize> {
        None
    }
}

/// Handles the commands of the scripts' protocol until a script ends them.
fn service(begun: mpsc::UnboundedSender<AtWork>) -> impl Service<Toy> {
    move |request: Request<'_, Toy>| -> Handling {
        let code = request.code();
        let (handler, ended) = oneshot::channel();
        let work = begun.clone();
        let handler_of = move |id| {
            let _ = work.send((code, id, handler));
            async move {
                match ended.await {
                    Ok(Ok(Outcome::Success)) => Ok(()),
                    Ok(Ok(other)) => Err(Refusal::new(result_code(other), "as the script says")),
                    Ok(Err(Panic)) => panic!("as the script says"),
                    Err(_) => std::future::pending().await,
                }
            }
        };
        match code {
            Echo::CODE => request.handle(move |context, Echo { text }| {
                let end = handler_of(context.id);
                async move { end.await.map(|()| EchoReply { text }) }
            }),
            Go::CODE => request.handle(move |context, Go { .. }| {
                let end = handler_of(context.id);
                async move { end.await.map(|()| Done {}) }
            }),
            _ => request.unknown(),
        }
    }
}

impl Robot {
    fn push(&mut self, open: &Open) -> Result<(), Failure> {
        if Operation::of(open.code)? != Operation::Report {
            return Err("a command is not reported".to_owned());
        }
        let number = self.wire.request(open);
        let (handle, results) = (self.server.handle.clone(), self.results.sender.clone());
        tokio::spawn(async move {
            let metres = i32::try_from(number).unwrap();
            let ended = handle.push(Audience::All, &Moved { metres }).await.unwrap();
            let first = ended.first().map(|ended| &ended.outcome);
            let _ = results.send((number, first.map_or("nobody", word)));
        });
        Ok(())
    }
}

fn word(outcome: &AckOutcome) -> &'static str {
    match outcome {
        AckOutcome::Acknowledged => "acknowledged",
        AckOutcome::Refused(_) => "refused",
        AckOutcome::Invalid(_) => "invalid",
        AckOutcome::TimedOut => "timed_out",
        AckOutcome::Dropped => "dropped",
        AckOutcome::Closed => "closed",
    }
}
