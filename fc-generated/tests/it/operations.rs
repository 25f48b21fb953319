//! Tests the files of the operations guide with the real tools. Prometheus reads the robot's metrics, the alerts are
//! valid, and systemd accepts the unit.

use crate::support::programs::{Robot, examples};
use fc_generated::Fc;
use fc_generated::descriptors::OPERATIONS;
use fc_runtime::{ClientConfig, Connection, Effect, OperationInfo};
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};

/// Returns `true` if the machine has a tool. CI skips nothing, so there a missing tool fails the test.
fn has(tool: &str) -> bool {
    let there = Command::new(tool)
        .arg("--version")
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .is_ok();
    if !there {
        assert!(
            std::env::var_os("FC_CI").is_none(),
            "needs {tool}, and CI skips nothing"
        );
        // The test framework captures `eprintln!` while the test passes, so this writes to stderr directly.
        let line = format!("skipped: {tool} is not installed\n");
        std::io::stderr().write_all(line.as_bytes()).unwrap();
    }
    there
}

fn operations() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../operations")
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

/// Runs a tool in `operations/` and expects success.
fn succeeds(tool: &str, args: &[&str]) {
    let output = Command::new(tool)
        .args(args)
        .current_dir(operations())
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", said(&output));
}

/// Returns a command of the spec that the example robot answers with success.
fn operation() -> &'static OperationInfo {
    let is_command = |operation: &&OperationInfo| {
        operation.effect == Some(Effect::Read) && operation.code.is_some()
    };
    OPERATIONS
        .iter()
        .find(is_command)
        .expect("a command that only asks")
}

/// Starts a robot with a port of metrics and makes three calls. Returns the robot and the address of its metrics.
async fn monitored() -> (Robot, String) {
    let [robot] = examples(["monitored"], "metrics");
    let robot = Robot::start(&robot, &["--metrics-port", "0"]);
    let [port, _] = robot.ports;
    let config = ClientConfig::new().host("127.0.0.1").command_port(port);
    let app = Connection::<Fc>::connect(config).await.unwrap();
    let operation = operation();
    for _ in 0..3 {
        let code = operation.code.unwrap();
        app.call_raw(code, operation.request.example.as_bytes())
            .await
            .unwrap();
    }
    let address = format!("127.0.0.1:{}", robot.metrics.expect("a port of metrics"));
    (robot, address)
}

/// Returns the metrics as a plain HTTP client gets them.
fn page(address: &str) -> String {
    let mut stream = TcpStream::connect(address).unwrap();
    stream
        .write_all(b"GET /metrics HTTP/1.1\r\nHost: robot\r\n\r\n")
        .unwrap();
    let mut page = String::new();
    stream.read_to_string(&mut page).unwrap();
    let (head, body) = page.split_once("\r\n\r\n").unwrap();
    assert!(head.starts_with("HTTP/1.1 200 OK"), "{head}");
    body.to_owned()
}

#[tokio::test]
#[ignore = "compiles a program with more features"]
async fn the_metrics_keep_to_the_conventions() {
    let (_robot, address) = monitored().await;
    let page = page(&address);
    let calls = format!(
        "fc_server_calls_total{{operation=\"{}\",result=\"success\"}} 3\n",
        operation().name
    );
    assert!(page.contains(&calls), "{page}");
    if !has("promtool") {
        return;
    }
    let mut check = Command::new("promtool")
        .args(["check", "metrics"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut stdin = check.stdin.take().unwrap();
    stdin.write_all(page.as_bytes()).unwrap();
    drop(stdin);
    let output = check.wait_with_output().unwrap();
    assert!(output.status.success(), "{}", said(&output));
}

/// The robot exports every `fc_server_` metric that the alerts name.
#[tokio::test]
#[ignore = "compiles a program with more features"]
async fn the_alerts_name_metrics_that_there_are() {
    let (_robot, address) = monitored().await;
    let page = page(&address);
    let alerts = fs::read_to_string(operations().join("alerts.yml")).unwrap();
    let words = alerts.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_'));
    let mut names: Vec<_> = words
        .filter(|word| word.starts_with("fc_server_"))
        .collect();
    names.sort_unstable();
    names.dedup();
    assert!(names.len() > 5, "{names:?}");
    for name in names {
        let series = [format!("\n{name} "), format!("\n{name}{{")];
        assert!(
            series.iter().any(|series| page.contains(series)),
            "no {name} in\n{page}"
        );
    }
}

#[test]
fn the_alerts_are_sound() {
    if has("promtool") {
        succeeds("promtool", &["check", "rules", "alerts.yml"]);
        succeeds(
            "promtool",
            &["check", "config", "--syntax-only", "prometheus.yml"],
        );
        succeeds("promtool", &["test", "rules", "alerts.test.yml"]);
    }
}

/// systemd accepts the unit, and rates its exposure at 2.0 of 10 at most.
#[test]
fn systemd_takes_the_unit() {
    if !has("systemd-analyze") {
        return;
    }
    let unit = fs::read_to_string(operations().join("fc-robot.service")).unwrap();
    let [robot] = examples(["robot"], "");
    let here = unit.replace("/usr/local/bin/fc-robot", robot.to_str().unwrap());
    assert_ne!(unit, here);
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("fc-robot.service");
    fs::write(&file, here).unwrap();
    let file = file.to_str().unwrap();
    succeeds("systemd-analyze", &["verify", file]);
    let security = ["security", "--offline=yes", "--threshold=20", file];
    succeeds("systemd-analyze", &security);
}

/// A running Prometheus, which is killed at the end of the test.
struct Prometheus(Child);

impl Drop for Prometheus {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

#[tokio::test]
#[ignore = "compiles a program with more features"]
async fn prometheus_reads_the_metrics() {
    if !(has("prometheus") && has("promtool")) {
        return;
    }
    let (_robot, address) = monitored().await;
    let folder = tempfile::tempdir().unwrap();
    // The configuration of the guide, with another address, a shorter interval and the path of the alerts.
    let config = fs::read_to_string(operations().join("prometheus.yml")).unwrap();
    let alerts = operations().join("alerts.yml");
    let here = config
        .replace("robot.local:9656", &address)
        .replace("15s", "1s")
        .replace("alerts.yml", alerts.to_str().unwrap());
    assert!(here.contains(&address) && here.contains(" 1s"), "{here}");
    let file = folder.path().join("prometheus.yml");
    fs::write(&file, here).unwrap();
    let mut child = Command::new("prometheus")
        .arg(format!("--config.file={}", file.display()))
        .arg(format!(
            "--storage.tsdb.path={}",
            folder.path().join("data").display()
        ))
        .arg("--web.listen-address=127.0.0.1:0")
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut log = BufReader::new(child.stderr.take().unwrap()).lines();
    let _prometheus = Prometheus(child);
    let mut lines = Vec::new();
    let server = loop {
        let Some(Ok(line)) = log.next() else {
            panic!("{lines:#?}")
        };
        if let Some((_, address)) = line.split_once("\"Listening on\" address=") {
            break format!("http://{address}");
        }
        lines.push(line);
    };
    // A full pipe would block Prometheus.
    std::thread::spawn(move || log.for_each(drop));
    let query = format!(
        "fc_server_calls_total{{job=\"fc-robot\",operation=\"{}\",result=\"success\"}}",
        operation().name
    );
    let mut answer = String::new();
    for _ in 0..1000 {
        let asked = Command::new("promtool")
            .args(["query", "instant", &server, &query])
            .output()
            .unwrap();
        answer = said(&asked);
        if answer.contains("=> 3 @") {
            return;
        }
    }
    panic!("{answer}");
}
