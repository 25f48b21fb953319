//! Shows the events, durations and counters of the runtime. An app and a robot run with the user's
//! `tracing` subscriber.
//!
//! ```text
//! cargo run --example observe
//! ```
//!
//! It prints one line per event of a call that fails, then the durations of calls and handlers by
//! name, then every counter. Bodies are never part of spans, events or `Debug` forms.

mod support;

use fc_generated::{Client, ExampleRobot, GetRobotSnRequest, ObstacleAnnouncement, RobotService};
use fc_runtime::{Audience, ClientConfig, Message, Server, ServerConfig};
use std::collections::BTreeMap;
use std::fmt::Debug;
use std::net::Ipv4Addr;
use std::process::ExitCode;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};
use support::{Fault, Table};
use tracing::field::{Field, Visit};
use tracing::span::{Attributes, Id};
use tracing::{Event, Level, Subscriber};
use tracing_subscriber::layer::{Context, Layer, SubscriberExt};
use tracing_subscriber::registry::LookupSpan;

#[tokio::main]
async fn main() -> ExitCode {
    let latencies = Latencies::default();
    let subscriber = tracing_subscriber::registry().with(latencies.clone());
    let installed = tracing::subscriber::set_global_default(subscriber);
    let result = match installed {
        Ok(()) => run(&latencies).await,
        Err(error) => Err(error.into()),
    };
    support::exit(result)
}

async fn run(latencies: &Latencies) -> Result<(), Fault> {
    let config = ServerConfig::new()
        .address(Ipv4Addr::LOCALHOST)
        .command_port(0)
        .data_port(0);
    let server = Server::bind(config, RobotService::new(ExampleRobot::default())).await?;
    let port = server.command_addr().port();
    let robot = server.handle();
    tokio::spawn(server.run());

    let config = ClientConfig::new().host("127.0.0.1").command_port(port);
    let app = Client::connect(config).await?;
    let mut reports = app.reports();
    for _ in 0..1000 {
        app.get_robot_sn(&GetRobotSnRequest::default()).await?;
    }
    // An unknown code is refused and counted.
    app.connection().call_raw(0xFFFF, b"{}").await?;
    robot
        .push(Audience::All, &ObstacleAnnouncement::example())
        .await?;
    reports.recv().await;

    print!("{}", latencies.table());
    println!(
        "\napp:   {:#?}\nrobot: {:#?}",
        app.connection().counters(),
        robot.counters()
    );
    robot.shutdown(Duration::from_secs(1)).await;
    Ok(())
}

/// Durations of the spans of one kind and name.
#[derive(Default)]
struct Taken {
    count: u32,
    total: Duration,
    longest: Duration,
}

/// A layer that times the runtime's spans: `call` at an app, `handle` at a robot.
#[derive(Clone, Default)]
struct Latencies(Arc<Mutex<BTreeMap<(&'static str, String), Taken>>>);

/// The data of a span: its start and the name of its operation.
struct Begun(Instant, String);

impl<S: Subscriber + for<'a> LookupSpan<'a>> Layer<S> for Latencies {
    fn on_new_span(&self, attributes: &Attributes<'_>, id: &Id, context: Context<'_, S>) {
        let mut name = FieldNamed("name", String::new());
        attributes.record(&mut name);
        if let Some(span) = context.span(id) {
            span.extensions_mut().insert(Begun(Instant::now(), name.1));
        }
    }

    fn on_event(&self, event: &Event<'_>, _: Context<'_, S>) {
        let mut message = FieldNamed("message", String::new());
        event.record(&mut message);
        if *event.metadata().level() <= Level::WARN || message.1 == "refused" {
            println!("{} {}", event.metadata().level(), message.1);
        }
    }

    fn on_close(&self, id: Id, context: Context<'_, S>) {
        let Some(span) = context.span(&id) else {
            return;
        };
        let extensions = span.extensions();
        let Some(Begun(since, name)) = extensions.get::<Begun>() else {
            return;
        };
        let took = since.elapsed();
        let mut all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let taken = all.entry((span.name(), name.clone())).or_default();
        taken.count += 1;
        taken.total += took;
        taken.longest = taken.longest.max(took);
    }
}

impl Latencies {
    fn table(&self) -> Table {
        let mut table = Table::default();
        table.row(["span", "operation", "count", "mean", "longest"]);
        let all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        for ((span, name), taken) in &*all {
            let mean = taken.total / taken.count.max(1);
            table.row([
                (*span).to_owned(),
                name.clone(),
                taken.count.to_string(),
                format!("{mean:.0?}"),
                format!("{:.0?}", taken.longest),
            ]);
        }
        table
    }
}

/// The name of a field, and its value as a string.
struct FieldNamed(&'static str, String);

impl Visit for FieldNamed {
    fn record_str(&mut self, field: &Field, value: &str) {
        if field.name() == self.0 {
            value.clone_into(&mut self.1);
        }
    }

    fn record_debug(&mut self, field: &Field, value: &dyn Debug) {
        if field.name() == self.0 {
            self.1 = format!("{value:?}");
        }
    }
}
