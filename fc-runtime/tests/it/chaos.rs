//! A connection to a robot with random behaviour: every call ends exactly once, with its response or an error, and no
//! resources are left behind.

use crate::common::net::{Raw, app_of_raw};
use crate::common::{self, Echo, LIMITS, Moved, answer_to, frame, report, result};
use fc_runtime::{
    CallError, CallOptions, ClientConfig, Command, Connection, FrameId, Limits, Report,
};
use proptest::collection::vec;
use proptest::prelude::{ProptestConfig, Strategy, any, prop_oneof, proptest};
use std::collections::HashMap;
use std::time::Duration;
use tokio::io::DuplexStream;
use tokio::task::JoinSet;
use tokio::time::{sleep, timeout};

#[derive(Clone, Copy, Debug)]
enum Step {
    /// Call, wait at most so long, and drop the call after so long.
    Call {
        timeout: u64,
        patience: u64,
    },
    /// Answer one of the requests that have come, whether it is still waited for or not.
    Answer {
        which: usize,
        how: Answer,
    },
    /// Report, perhaps not for the first time.
    Report(u32),
    Wait(u64),
}

#[derive(Clone, Copy, Debug)]
enum Answer {
    Right,
    Refusal,
    OtherCode,
    OtherId,
    NoJson,
    BadDigest,
}

fn steps() -> impl Strategy<Value = Vec<Step>> {
    let how = prop_oneof![
        6 => proptest::strategy::Just(Answer::Right),
        1 => proptest::strategy::Just(Answer::Refusal),
        1 => proptest::strategy::Just(Answer::OtherCode),
        1 => proptest::strategy::Just(Answer::OtherId),
        1 => proptest::strategy::Just(Answer::NoJson),
        1 => proptest::strategy::Just(Answer::BadDigest),
    ];
    let step = prop_oneof![
        4 => (1_u64..40, 1_u64..80).prop_map(|(timeout, patience)| Step::Call { timeout, patience }),
        4 => (any::<usize>(), how).prop_map(|(which, how)| Step::Answer { which, how }),
        2 => (0_u32..20).prop_map(Step::Report),
        1 => (1_u64..30).prop_map(Step::Wait),
    ];
    vec(step, 1..150)
}

fn answer(id: FrameId, body: &str, how: Answer) -> Vec<u8> {
    let right = answer_to(id);
    let echoed = body.replacen('{', r#"{"result":7,"#, 1);
    match how {
        Answer::Right => frame(right, echoed.as_bytes()),
        Answer::Refusal => frame(right, result(500).as_bytes()),
        Answer::OtherCode => frame(FrameId { code: 1, ..right }, echoed.as_bytes()),
        Answer::OtherId => frame(
            FrameId {
                id: !id.id,
                ..right
            },
            echoed.as_bytes(),
        ),
        Answer::NoJson => frame(right, b"no"),
        Answer::BadDigest => {
            let mut bytes = frame(right, echoed.as_bytes());
            *bytes.last_mut().unwrap() ^= 1;
            bytes
        }
    }
}

/// One call; gives the name of how it ended.
async fn call(
    app: Connection<common::Toy>,
    number: usize,
    wait: u64,
    patience: u64,
) -> &'static str {
    let request = Echo {
        text: format!("call {number}"),
    };
    let options = CallOptions {
        timeout: Some(Duration::from_millis(wait)),
        repeat: None,
    };
    match timeout(
        Duration::from_millis(patience),
        app.call(&request).with_options(options),
    )
    .await
    {
        Err(_) => "dropped",
        Ok(Ok(reply)) => {
            assert_eq!(reply.text, request.text, "the answer of another call");
            "answered"
        }
        Ok(Err(error)) => error.name(),
    }
}

struct Robot {
    raw: Raw<DuplexStream>,
    requests: Vec<(FrameId, String)>,
    acknowledged: HashMap<u32, usize>,
}

impl Robot {
    /// Receives everything that has arrived.
    async fn listen(&mut self) {
        while let Ok(received) = timeout(Duration::from_millis(1), self.raw.recv()).await {
            let (id, body) = received.expect("the app does not close");
            if id.response {
                *self.acknowledged.entry(id.id).or_default() += 1;
            } else {
                let same = self.requests.iter().any(|(other, _)| *other == id);
                assert!(!same, "an id was used twice");
                self.requests.push((id, body));
            }
        }
    }
}

async fn play(steps: Vec<Step>, lose: bool) {
    let limits = Limits {
        in_flight: 8,
        queued_reports: 6,
        ..LIMITS
    };
    let (app, raw) = app_of_raw(ClientConfig::new().limits(limits));
    let mut reports = app.reports();
    let mut robot = Robot {
        raw,
        requests: Vec::new(),
        acknowledged: HashMap::new(),
    };
    let mut calls = JoinSet::new();
    let (mut made, mut ends) = (0, Vec::new());
    let mut sent = HashMap::<u32, usize>::new();
    for step in steps {
        match step {
            Step::Call { timeout, patience } => {
                calls.spawn(call(app.clone(), made, timeout, patience));
                made += 1;
            }
            Step::Answer { which, how } => {
                if let Some(index) = which.checked_rem(robot.requests.len()) {
                    let (id, body) = robot.requests[index].clone();
                    robot.raw.send(&answer(id, &body, how)).await;
                }
            }
            Step::Report(id) => {
                *sent.entry(id).or_default() += 1;
                robot
                    .raw
                    .send_frame(report(Moved::CODE, id), r#"{"metres":1}"#)
                    .await;
            }
            Step::Wait(milliseconds) => sleep(Duration::from_millis(milliseconds)).await,
        }
        robot.listen().await;
        assert!(app.in_flight() <= 8);
    }
    assert!(robot.requests.iter().all(|(id, _)| id.code == Echo::CODE));
    if lose {
        drop(robot.raw);
    }
    while let Some(end) = calls.join_next().await {
        ends.push(end.unwrap());
    }
    assert_eq!(ends.len(), made);
    assert_eq!(app.in_flight(), 0);
    let known = [
        "answered",
        "dropped",
        "refused",
        "timeout",
        "busy",
        "invalid_response",
        "frame",
        "lost",
        "closed",
        "not_connected",
    ];
    assert!(ends.iter().all(|end| known.contains(end)), "{ends:?}");
    // All resources are free: the full number of calls can be made again.
    if !lose {
        let again = Echo {
            text: "again".into(),
        };
        let once = CallOptions {
            timeout: Some(Duration::from_millis(1)),
            repeat: None,
        };
        for _ in 0..9 {
            assert_eq!(
                app.call(&again).with_options(once).await,
                Err(CallError::Timeout)
            );
        }
    }
    app.close();
    let mut handed_on = Vec::new();
    while let Some(report) = reports.recv().await {
        handed_on.push(report.id);
    }
    let counters = app.counters();
    assert_eq!(handed_on.len() as u64, counters.reports);
    let total: usize = sent.values().sum();
    assert_eq!(
        counters.reports + counters.repeated_reports + counters.reports_refused,
        total as u64
    );
    for (id, count) in &robot.acknowledged {
        assert!(handed_on.contains(id), "acknowledged and not handed on");
        assert!(count <= &sent[id]);
    }
    let count = handed_on.len();
    handed_on.sort_unstable();
    handed_on.dedup();
    assert_eq!(handed_on.len(), count, "handed on twice");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[fc_test::test]
    fn calls_end_once_and_reports_arrive_once(steps in steps(), lose in any::<bool>()) {
        tokio::runtime::Builder::new_current_thread()
            .enable_time()
            .start_paused(true)
            .build()
            .unwrap()
            .block_on(play(steps, lose));
    }
}
