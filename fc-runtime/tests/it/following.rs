//! A command followed to its end: the answer, and then the reports that it sets off.

use crate::common::net::{Raw, Robot, app_of_raw, loopback, service};
use crate::common::{
    Done, Go, LIMITS, Moved, Step, Toy, Trouble, UnderWay, answer_to, report, result, until,
};
use fc_runtime::{
    AckOutcome, Audience, Backoff, CallError, ClientConfig, Connection, FollowError, Followed,
    Following, Limits, Loss, Report as _,
};
use futures_util::StreamExt as _;
use std::time::Duration;
use tokio::io::{AsyncRead, AsyncWrite};
use tokio::net::{TcpListener, TcpStream};
use tokio::time::timeout;

const GO: Go = Go { metres: 3 };
/// No connection has so many frames in a test.
const FIRST: u32 = 1000;

fn step(step: Step) -> UnderWay {
    UnderWay {
        step,
        metres: None,
        trouble: None,
    }
}

/// The text of a report, as a robot sends it.
fn text(step: &str) -> String {
    format!(r#"{{"at":1,"step":"{step}"}}"#)
}

fn way(id: u32) -> fc_runtime::FrameId {
    report(UnderWay::CODE, FIRST + id)
}

/// Returns the next event. Only a failing test waits for so long.
async fn next(
    following: &mut Following<Toy, Go, UnderWay>,
) -> Option<Result<Followed<UnderWay>, FollowError>> {
    let next = timeout(Duration::from_secs(10), following.recv()).await;
    next.expect("something to come")
}

async fn next_step(following: &mut Following<Toy, Go, UnderWay>) -> Step {
    let next = next(following).await.unwrap().unwrap();
    next.into_report().unwrap().step
}

/// Answers the next command, which has to be the one that is followed.
async fn answer<S: AsyncRead + AsyncWrite + Unpin>(robot: &mut Raw<S>) {
    let (id, _) = robot.recv().await.expect("the command");
    assert!(!id.response);
    robot.send_frame(answer_to(id), &result(7)).await;
}

/// Sends a report, and takes its acknowledgement. Only a test that fails waits for so long.
async fn send<S: AsyncRead + AsyncWrite + Unpin>(robot: &mut Raw<S>, id: u32, text: &str) {
    robot.send_frame(way(id), text).await;
    let acknowledged = timeout(Duration::from_secs(10), robot.result()).await;
    assert_eq!(acknowledged, Ok((answer_to(way(id)), 7)));
}

/// An app that follows a command of a robot that is a test.
async fn followed(
    config: ClientConfig,
) -> (
    Connection<Toy>,
    Raw<tokio::io::DuplexStream>,
    Following<Toy, Go, UnderWay>,
) {
    let (app, mut robot) = app_of_raw(config);
    let (following, ()) = tokio::join!(app.call(&GO).follow(), answer(&mut robot));
    (app, robot, following.unwrap())
}

#[fc_test::test]
async fn a_process_is_followed_from_its_start_to_its_end() {
    let robot = Robot::start(loopback(), service).await;
    let app = robot.connect().await;
    let mut others = app.reports();
    let mut following = app.call(&GO).follow::<UnderWay>().await.unwrap();
    assert_eq!(following.answer(), &Done {});
    for (said, meant) in [
        (Step::Ready, Followed::Going(step(Step::Ready))),
        (Step::Rolling, Followed::Going(step(Step::Rolling))),
        (Step::There, Followed::Ended(step(Step::There))),
    ] {
        let pushed = robot.handle.push(Audience::All, &step(said)).await.unwrap();
        assert_eq!(pushed[0].outcome, AckOutcome::Acknowledged);
        assert_eq!(next(&mut following).await, Some(Ok(meant.clone())));
        let other = others.recv().await.unwrap();
        assert_eq!(
            other.read::<Toy, UnderWay>().as_ref(),
            Ok(meant.report().unwrap())
        );
    }
    assert_eq!(next(&mut following).await, None);
    assert_eq!(next(&mut following).await, None);
    assert_eq!(app.counters().reports_out_of_order, 0);
}

/// The robot may be quicker with its first report than with the answer.
#[fc_test::test]
async fn a_report_before_the_answer_is_not_lost() {
    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let port = listener.local_addr().unwrap().port();
    let config = ClientConfig::new().host("127.0.0.1").command_port(port);
    let (app, stream) = tokio::join!(Connection::<Toy>::connect(config), listener.accept());
    let (app, mut robot) = (app.unwrap(), Raw::new(stream.unwrap().0));
    let script = async {
        let (id, _) = robot.recv().await.unwrap();
        send(&mut robot, 1, &text("ready")).await;
        robot.send_frame(answer_to(id), &result(7)).await;
        send(&mut robot, 2, &text("rolling")).await;
    };
    let (following, ()) = tokio::join!(app.call(&GO).follow::<UnderWay>(), script);
    let mut following = following.unwrap();
    assert_eq!(next_step(&mut following).await, Step::Ready);
    assert_eq!(next_step(&mut following).await, Step::Rolling);
}

/// The next connection of an app. Only a test that fails waits for so long.
async fn accept(listener: &TcpListener) -> Raw<TcpStream> {
    let accepted = timeout(Duration::from_secs(10), listener.accept()).await;
    Raw::new(accepted.expect("a connection").unwrap().0)
}

#[fc_test::test]
async fn following_continues_after_a_lost_connection() {
    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let at_once = Backoff {
        first: Duration::ZERO,
        longest: Duration::ZERO,
        attempts: None,
    };
    let config = ClientConfig::new()
        .host("127.0.0.1")
        .command_port(listener.local_addr().unwrap().port())
        .reconnect(at_once);
    let (app, mut robot) = tokio::join!(Connection::<Toy>::connect(config), accept(&listener));
    let app = app.unwrap();
    let (following, ()) = tokio::join!(app.call(&GO).follow::<UnderWay>(), answer(&mut robot));
    let mut following = following.unwrap();
    send(&mut robot, 1, &text("ready")).await;
    drop(robot);
    let mut robot = accept(&listener).await;
    send(&mut robot, 2, &text("rolling")).await;
    // As if its acknowledgement had been lost.
    send(&mut robot, 2, &text("rolling")).await;
    // All of this arrives before the app receives, and is delivered in order.
    assert_eq!(next_step(&mut following).await, Step::Ready);
    let lost = next(&mut following).await;
    assert!(
        matches!(lost, Some(Ok(Followed::Interrupted(_)))),
        "{lost:?}"
    );
    assert_eq!(next(&mut following).await, Some(Ok(Followed::Resumed)));
    assert_eq!(next_step(&mut following).await, Step::Rolling);
    // Once more, and this time the app watches.
    drop(robot);
    let lost = next(&mut following).await;
    assert!(
        matches!(lost, Some(Ok(Followed::Interrupted(_)))),
        "{lost:?}"
    );
    let mut robot = accept(&listener).await;
    assert_eq!(next(&mut following).await, Some(Ok(Followed::Resumed)));
    send(&mut robot, 3, &text("there")).await;
    let ended = Followed::Ended(step(Step::There));
    assert_eq!(next(&mut following).await, Some(Ok(ended)));
    assert_eq!(next(&mut following).await, None);
}

#[fc_test::test]
async fn a_failure_ends_it() {
    let (_app, mut robot, mut following) = followed(ClientConfig::new()).await;
    send(&mut robot, 1, &text("stuck")).await;
    let failed = Followed::Failed(step(Step::Stuck));
    assert_eq!(next(&mut following).await, Some(Ok(failed)));
    assert_eq!(next(&mut following).await, None);

    // Reported with an unchanged state.
    let (_app, mut robot, mut following) = followed(ClientConfig::new()).await;
    send(&mut robot, 1, r#"{"step":"rolling","trouble":0}"#).await;
    send(&mut robot, 2, r#"{"step":"rolling","trouble":1}"#).await;
    let rolling = |trouble| UnderWay {
        trouble: Some(trouble),
        ..step(Step::Rolling)
    };
    let going = Followed::Going(rolling(Trouble::None));
    assert_eq!(next(&mut following).await, Some(Ok(going)));
    let failed = Followed::Failed(rolling(Trouble::Wheel));
    assert_eq!(next(&mut following).await, Some(Ok(failed)));
    assert_eq!(next(&mut following).await, None);
}

#[fc_test::test]
async fn out_of_order_report_is_delivered_and_counted() {
    let (app, mut robot, mut following) = followed(ClientConfig::new()).await;
    // Not in the list: from ready to there, which ends the process. Before that: no change, and an unknown state.
    for (id, (said, counted)) in (1..).zip([
        ("rolling", 0),
        ("rolling", 0),
        ("ready", 1),
        ("asleep", 1),
        ("ready", 1),
        ("there", 2),
    ]) {
        send(&mut robot, id, &text(said)).await;
        assert_eq!(next_step(&mut following).await.wire(), said);
        assert_eq!(app.counters().reports_out_of_order, counted, "{said}");
    }
    assert_eq!(next(&mut following).await, None);
}

/// A follower that does not receive misses reports that others take, and gets their number.
#[fc_test::test]
async fn missed_reports_are_told_in_order() {
    let limits = Limits {
        queued_reports: 2,
        ..LIMITS
    };
    let (app, mut robot, mut following) = followed(ClientConfig::new().limits(limits)).await;
    let mut quick = app.reports();
    for id in 1..=5 {
        send(&mut robot, id, &text("rolling")).await;
        quick.recv().await.unwrap();
    }
    assert_eq!(next_step(&mut following).await, Step::Rolling);
    send(&mut robot, 6, &text("there")).await;
    assert_eq!(next_step(&mut following).await, Step::Rolling);
    assert_eq!(next(&mut following).await, Some(Ok(Followed::Missed(3))));
    assert_eq!(next_step(&mut following).await, Step::There);
    assert_eq!(app.counters().reports_missed, 3);
}

/// The queue of a follower: a full one leaves reports to be repeated, and a dropped one takes no more.
#[fc_test::test]
async fn report_without_a_follower_is_not_acknowledged() {
    let limits = Limits {
        queued_reports: 1,
        ..LIMITS
    };
    let (app, mut robot, mut following) = followed(ClientConfig::new().limits(limits)).await;
    let refused = async |robot: &mut Raw<_>, id, text: &str, so_far| {
        robot.send_frame(id, text).await;
        until(|| app.counters().reports_refused == so_far).await;
    };
    send(&mut robot, 1, &text("ready")).await;
    refused(&mut robot, way(2), &text("rolling"), 1).await;
    assert_eq!(next_step(&mut following).await, Step::Ready);
    send(&mut robot, 2, &text("rolling")).await;
    // Of another code, which is not followed, although there is room.
    assert_eq!(next_step(&mut following).await, Step::Rolling);
    refused(&mut robot, report(Moved::CODE, 9), r#"{"metres":1}"#, 2).await;
    // Reports after the end are not followed either, whether the follower is dropped or not.
    send(&mut robot, 3, &text("there")).await;
    assert_eq!(next_step(&mut following).await, Step::There);
    refused(&mut robot, way(4), &text("ready"), 3).await;
    assert_eq!(next(&mut following).await, None);
    let (dropped, ()) = tokio::join!(app.call(&GO).follow::<UnderWay>(), answer(&mut robot));
    drop(dropped);
    refused(&mut robot, way(5), &text("ready"), 4).await;
}

/// By the key of the request that the report has as well.
#[fc_test::test]
async fn reports_of_another_call_are_not_delivered() {
    let (app, mut robot, mut following) = followed(ClientConfig::new()).await;
    let of = |metres: i32, step: &str| format!(r#"{{"step":"{step}","metres":{metres}}}"#);
    send(&mut robot, 1, &of(4, "stuck")).await;
    send(&mut robot, 2, &of(3, "rolling")).await;
    // It does not say whose it is.
    send(&mut robot, 3, &text("there")).await;
    assert_eq!(next_step(&mut following).await, Step::Rolling);
    assert_eq!(next_step(&mut following).await, Step::There);
    assert_eq!(next(&mut following).await, None);
    assert_eq!(app.counters().reports_out_of_order, 0);
}

#[fc_test::test]
async fn a_connection_that_is_closed_ends_it_with_an_error() {
    let (app, mut robot, mut following) = followed(ClientConfig::new()).await;
    send(&mut robot, 1, &text("ready")).await;
    app.close();
    assert_eq!(next_step(&mut following).await, Step::Ready);
    let closed = FollowError::Closed(Loss::Here);
    assert_eq!(closed.name(), "closed");
    assert_eq!(next(&mut following).await, Some(Err(closed)));
    assert_eq!(next(&mut following).await, None);

    // A waiting follower is woken.
    let (_app, robot, following) = followed(ClientConfig::new()).await;
    let (all, ()) = tokio::join!(following.collect::<Vec<_>>(), async { drop(robot) });
    assert!(matches!(all[..], [Err(FollowError::Closed(_))]), "{all:?}");
}

/// A call that is never polled is not followed, and leaves no queue behind.
#[fc_test::test]
async fn a_call_that_is_refused_is_not_followed() {
    let robot = Robot::start(loopback(), service).await;
    let app = robot.connect().await;
    let far = Go { metres: 60 };
    let refused = app.call(&far).follow::<UnderWay>().await;
    assert!(matches!(refused, Err(CallError::Refused(_))), "{refused:?}");
    let push = tokio::spawn({
        let handle = robot.handle.clone();
        async move { handle.push(Audience::All, &step(Step::Ready)).await }
    });
    until(|| app.counters().reports_refused == 1).await;
    push.abort();
}

/// A report without states is followed until the follower is dropped.
#[fc_test::test]
async fn without_states_no_report_ends_it() {
    let robot = Robot::start(loopback(), service).await;
    let app = robot.connect().await;
    let mut following = app.call(&GO).follow::<Moved>().await.unwrap();
    for metres in [3, 1, 2] {
        let moved = Moved { metres };
        robot.handle.push(Audience::All, &moved).await.unwrap();
        let next = following.next().await;
        assert_eq!(next, Some(Ok(Followed::Going(moved))));
    }
    assert_eq!(app.counters().reports_out_of_order, 0);
}
