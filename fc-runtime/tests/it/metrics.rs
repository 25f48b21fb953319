//! A recorder of metrics gets the values of the counters.

use crate::common::net::{Raw, Robot, app_of_raw, loopback, service};
use crate::common::{Echo, EchoReply, Go, Moved, Toy, command, until};
use fc_runtime::{
    Audience, CallError, CallOptions, ClientConfig, Command, Effect, Handling, Network, Request,
};
use metrics::LocalRecorderGuard;
use metrics_exporter_prometheus::{PrometheusBuilder, PrometheusHandle, PrometheusRecorder};
use std::fmt::Debug;
use std::net::Ipv4Addr;

/// A recorder for this thread.
struct Recorder {
    _recording: LocalRecorderGuard<'static>,
    handle: PrometheusHandle,
}

impl Recorder {
    fn new() -> Self {
        // The guard borrows it, and a test ends soon.
        let recorder: &'static PrometheusRecorder =
            Box::leak(Box::new(PrometheusBuilder::new().build_recorder()));
        Self {
            handle: recorder.handle(),
            _recording: metrics::set_default_local_recorder(recorder),
        }
    }

    /// Returns the value of a series, named as displayed: `name{label="value"}`.
    fn value(&self, series: &str) -> f64 {
        let shown = self.handle.render();
        let value = shown
            .lines()
            .find_map(|line| line.strip_prefix(series)?.strip_prefix(' '));
        value
            .unwrap_or_else(|| panic!("no {series} in\n{shown}"))
            .parse()
            .unwrap()
    }

    /// The sum of all series of a metric that have this in their labels.
    fn sum(&self, metric: &str, label: &str) -> f64 {
        let shown = self.handle.render();
        let values = shown
            .lines()
            .filter(|line| line.starts_with(&format!("{metric}{{")) && line.contains(label))
            .map(|line| line.rsplit_once(' ').unwrap().1.parse::<f64>().unwrap());
        values.sum()
    }
}

/// The names and values that counters show.
fn fields(counters: &impl Debug) -> Vec<(String, f64)> {
    let shown = format!("{counters:?}");
    let (_, inner) = shown.split_once(" { ").unwrap();
    inner
        .trim_end_matches(" }")
        .split(", ")
        .map(|field| {
            let (name, value) = field.split_once(": ").unwrap();
            (name.to_owned(), value.parse().unwrap())
        })
        .collect()
}

/// The counters of requests, and the result that the metric has for each.
const RESULTS: [(&str, &str); 6] = [
    ("calls_succeeded", "success"),
    ("calls_protocol", "protocol"),
    ("calls_timed_out", "timeout"),
    ("calls_invalid", "invalid"),
    ("calls_expired", "expired"),
    ("calls_refused", "refused"),
];

#[fc_test::test]
async fn metrics_are_the_counters() {
    let recorder = Recorder::new();
    let network = Network::from(std::net::IpAddr::V4(Ipv4Addr::LOCALHOST));
    let config = loopback()
        .allow(network, Effect::ALL)
        .allow("192.0.2.1".parse().unwrap(), [Effect::Read]);
    let robot = Robot::start(config, service).await;
    let app = robot.connect().await;
    let mut reports = app.reports();
    for _ in 0..3 {
        app.call(&Echo { text: "x".into() }).await.unwrap();
    }
    app.call(&Go { metres: 51 }).await.unwrap_err();
    let raw = app.call_raw(Echo::CODE, br#"{"text":"x"}"#);
    raw.await.unwrap();
    app.call_raw(Go::CODE, br#"{"metres":-1}"#).await.unwrap();
    app.call_raw(0x0998, b"{}").await.unwrap();
    app.call_raw(0x0999, b"{}").await.unwrap();
    let moved = Moved { metres: 1 };
    robot.handle.push(Audience::All, &moved).await.unwrap();
    reports.recv().await.unwrap();
    assert!(
        robot
            .handle
            .serve(tokio::io::empty(), ([203, 0, 113, 1], 1).into())
            .is_none()
    );
    let (reader, end) = tokio::io::duplex(10_000);
    robot.handle.serve(end, ([192, 0, 2, 1], 1).into()).unwrap();
    let mut reader = Raw::new(reader);
    reader.send_frame(command(Go::CODE, 1), "{}").await;
    reader.result().await;

    let counters = robot.handle.counters();
    assert_eq!(
        (counters.calls_forbidden, counters.connections_forbidden),
        (1, 1)
    );
    for (name, value) in fields(&counters) {
        let metric = match RESULTS.iter().find(|(counter, _)| *counter == name) {
            Some((_, result)) => {
                recorder.sum("fc_server_calls_total", &format!("result=\"{result}\""))
            }
            None => recorder.value(&format!("fc_server_{name}_total")),
        };
        assert_eq!(metric, value, "{name}");
    }
    let calls = |operation: &str, result: &str| {
        recorder.value(&format!(
            "fc_server_calls_total{{operation=\"{operation}\",result=\"{result}\"}}"
        ))
    };
    assert_eq!(calls("echo", "success"), 4.0);
    assert_eq!(calls("go", "refused"), 1.0);
    assert_eq!(calls("go", "invalid"), 1.0);
    assert_eq!(calls("go", "protocol"), 1.0);
    assert_eq!(
        calls("unknown", "protocol"),
        2.0,
        "one label for all of them"
    );
    let handled = "fc_server_handler_duration_seconds_count{operation=\"echo\"}";
    assert_eq!(recorder.value(handled), 4.0);

    // An app's driver records the counters when it is woken next.
    until(|| recorder.value("fc_client_reports_total") > 0.0).await;
    assert_eq!(recorder.value("fc_client_connects_total"), 1.0);
    for (name, value) in fields(&app.counters()) {
        let metric = recorder.value(&format!("fc_client_{name}_total"));
        assert_eq!(metric, value, "{name}");
    }
    let calls = |operation: &str, result: &str| {
        recorder.value(&format!(
            "fc_client_calls_total{{operation=\"{operation}\",result=\"{result}\"}}"
        ))
    };
    assert_eq!(calls("echo", "success"), 4.0);
    assert_eq!(calls("go", "refused"), 2.0);
    assert_eq!(calls("unknown", "refused"), 2.0);
    let took = "fc_client_call_duration_seconds_count{operation=\"echo\"}";
    assert_eq!(recorder.value(took), 4.0);
}

#[fc_test::test]
async fn gauges_rise_and_fall() {
    let recorder = Recorder::new();
    let robot = Robot::start(loopback(), service).await;
    let app = robot.connect().await;
    let data = app.data();
    let commands = || recorder.value("fc_server_open_connections{port=\"command\"}");
    let streams = || recorder.value("fc_server_open_connections{port=\"data\"}");
    let connected = || recorder.value("fc_client_connected");
    until(|| (commands(), streams(), connected()) == (1.0, 1.0, 1.0)).await;
    drop((app, data));
    until(|| (commands(), streams(), connected()) == (0.0, 0.0, 0.0)).await;
}

/// Answers only [`Echo`], and never.
fn never(request: Request<'_, Toy>) -> Handling {
    request.handle(|_, Echo { .. }| async {
        std::future::pending::<()>().await;
        Ok(EchoReply {
            text: String::new(),
        })
    })
}

#[fc_test::test(start_paused = true)]
async fn a_handler_that_is_given_up_is_timed_too() {
    let recorder = Recorder::new();
    let robot = Robot::start(loopback(), never).await;
    let app = robot.pipe(ClientConfig::new());
    let request = Echo { text: "x".into() };
    let waiting = || recorder.value("fc_server_handlers_waiting");
    let flying = || recorder.value("fc_client_calls_in_flight");
    let (called, ()) = tokio::join!(app.call(&request), async {
        until(|| (waiting(), flying()) == (1.0, 1.0)).await;
    });
    assert!(matches!(called, Err(CallError::Refused(_))));
    assert_eq!((waiting(), flying()), (0.0, 0.0));
    let seconds = recorder.value("fc_server_handler_duration_seconds_sum{operation=\"echo\"}");
    assert!((2.0..2.1).contains(&seconds), "{seconds}");
}

#[fc_test::test]
async fn a_call_that_is_dropped_is_counted_once() {
    let recorder = Recorder::new();
    let (app, mut robot) = app_of_raw(ClientConfig::new());
    let request = Echo { text: "x".into() };
    let options = CallOptions::default();
    tokio::select! {
        _ = app.call(&request).with_options(options) => panic!("answered"),
        _ = robot.recv() => {}
    }
    let dropped = "fc_client_calls_total{operation=\"echo\",result=\"dropped\"}";
    assert_eq!(recorder.value(dropped), 1.0);
    assert_eq!(recorder.sum("fc_client_calls_total", ""), 1.0);
}
