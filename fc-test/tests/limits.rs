//! A test that does not end fails with a message. Every test of the runtime has a time limit.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may")]

use std::fs;
use std::future::pending;
use std::path::Path;
use std::thread::park;
use std::time::Duration;

const SHORT: Duration = Duration::from_millis(10);

#[fc_test::test(within = SHORT)]
#[should_panic(expected = "not over after 10ms")]
fn blocking_test_is_stopped() {
    loop {
        park();
    }
}

#[fc_test::test(within = SHORT)]
#[should_panic(expected = "not over after 10ms")]
async fn test_that_never_wakes_is_stopped() {
    pending::<()>().await;
}

#[fc_test::test(within = SHORT)]
#[should_panic(expected = "not over after 10ms")]
async fn a_task_that_never_yields_fails() {
    loop {
        park();
    }
}

#[fc_test::test(start_paused = true)]
#[should_panic(expected = "waits for what never comes")]
async fn paused_time_runs_out_at_once() {
    pending::<()>().await;
}

#[fc_test::test]
#[should_panic(expected = "by itself")]
async fn a_panic_is_the_tests_own() {
    panic!("by itself");
}

#[fc_test::test(start_paused = true)]
async fn days_pass() {
    tokio::time::sleep(Duration::from_secs(6 * 24 * 60 * 60)).await;
}

#[fc_test::test]
fn every_test_of_the_runtime_has_a_limit() {
    let runtime = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fc-runtime");
    let mut sources = vec![runtime.join("src"), runtime.join("tests")];
    let mut tests = 0;
    while let Some(source) = sources.pop() {
        if source.is_dir() {
            sources.extend(
                fs::read_dir(source)
                    .unwrap()
                    .map(|entry| entry.unwrap().path()),
            );
            continue;
        }
        let text = fs::read_to_string(&source).unwrap();
        for line in text.lines().map(str::trim_start) {
            let is_without = line.starts_with("#[test]") || line.starts_with("#[tokio::test");
            assert!(!is_without, "{}: use #[fc_test::test]", source.display());
            tests += usize::from(line.starts_with("#[fc_test::test"));
        }
    }
    assert!(tests > 100, "{tests}");
}
