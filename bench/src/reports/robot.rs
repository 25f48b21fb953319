//! The process of the robot, which reads one order.
//!
//! `push APPS REPORTS` pushes in batches and prints seconds and CPU seconds. `paced FAST APPS SECONDS` pushes as fast
//! as the fast apps acknowledge, and prints acknowledged deliveries and seconds.

use crate::calls::fc::{self, Answers};
use crate::calls::runtime;
use crate::cost::Meter;
use fc_generated::{Fc, RechargeProgress};
use fc_runtime::{Audience, Message as _, ServerHandle};
use futures_util::FutureExt as _;
use futures_util::future::join_all;
use std::io::stdin;
use std::net::Ipv4Addr;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::{Notify, mpsc};

/// Largest number of reports without an acknowledgement, for each app.
const BATCH: usize = 16;
/// Length of a report frame of fc, in bytes.
pub const REPORT: usize = 104;
/// Length of an acknowledgement frame of fc, in bytes.
pub const ACKNOWLEDGEMENT: usize = 105;

/// Runs `reports-serve ROBOT`.
///
/// The order of the robots `timed` and `timed-prepared` is a number of reports. They push one report at a time to the
/// first app, and print p50 and p99 in microseconds.
pub fn serve(robot: &str) {
    let runtime = runtime(false);
    runtime.block_on(async {
        match robot {
            "raw" => raw().await,
            "fc" => ours(false).await,
            "timed" => timed(Answers::Made).await,
            "timed-prepared" => timed(Answers::Prepared).await,
            "fc-each" => ours(true).await,
            other => panic!("no robot {other}"),
        }
    });
}

/// Returns the words of the next input line. It reads on another thread, so that the runtime continues.
async fn order() -> Vec<String> {
    let line = tokio::task::spawn_blocking(|| {
        let mut line = String::new();
        stdin().read_line(&mut line).expect("input");
        line
    });
    line.await.expect("a line").split_whitespace().map(str::to_owned).collect()
}

fn number(word: &str) -> usize {
    word.parse().expect("a number")
}

async fn ours(each: bool) {
    let server = fc::bind(fc::Robot::new(Answers::Made)).await;
    println!("{}", server.command_addr());
    let handle = server.handle();
    tokio::spawn(server.run());
    let order = order().await;
    match order[0].as_str() {
        "push" => push(&handle, each, number(&order[1]), number(&order[2])).await,
        _ => paced(&handle, number(&order[1]), number(&order[2]), order[3].parse().expect("seconds")).await,
    }
}

/// Waits until this number of apps is connected.
async fn gathered(handle: &ServerHandle<Fc>, apps: usize) {
    while handle.connections().len() < apps {
        tokio::time::sleep(Duration::from_millis(1)).await;
    }
}

async fn push(handle: &ServerHandle<Fc>, each: bool, apps: usize, reports: usize) {
    gathered(handle, apps).await;
    let report = RechargeProgress::example();
    let audiences: Vec<Audience> = if each {
        handle.connections().into_iter().map(|(id, _)| Audience::One(id)).collect()
    } else {
        vec![Audience::All]
    };
    let meter = Meter::start();
    let start = Instant::now();
    let mut left = reports;
    let mut delivered = 0;
    while left > 0 {
        let batch = left.min(BATCH);
        left -= batch;
        let pushes = (0..batch).flat_map(|_| audiences.iter().map(|audience| handle.push(*audience, &report)));
        for pushed in join_all(pushes).await {
            delivered += pushed.expect("pushed").len();
        }
    }
    assert_eq!(delivered, apps * reports, "every app got every report");
    println!("{} {}", start.elapsed().as_secs_f64(), meter.cpu());
}

/// Pushes reports without waiting for each push. The acknowledgements of the fast apps set the pace. Newer reports
/// replace those that wait for a slow app.
async fn paced(handle: &ServerHandle<Fc>, fast: usize, apps: usize, seconds: f64) {
    gathered(handle, apps).await;
    let report = RechargeProgress::example();
    let start = Instant::now();
    let mut pushed = 0;
    let mut acknowledged = 0;
    while start.elapsed().as_secs_f64() < seconds {
        acknowledged = handle.counters().reports_acknowledged as usize;
        if pushed * fast < acknowledged + BATCH * fast {
            let _ = handle.push(Audience::All, &report).now_or_never();
            pushed += 1;
        } else {
            tokio::task::yield_now().await;
        }
    }
    println!("{acknowledged} {}", start.elapsed().as_secs_f64());
}

/// Pushes a report every millisecond or two, like a robot that reports its position. Measures the time from each push
/// to the acknowledgement by the first app.
async fn timed(answers: Answers) {
    let server = fc::bind(fc::Robot::new(answers)).await;
    println!("{}", server.command_addr());
    let handle = server.handle();
    tokio::spawn(server.run());
    let reports = number(&order().await[0]);
    gathered(&handle, 1).await;
    let first = Audience::One(handle.connections()[0].0);
    let report = RechargeProgress::example();
    let pushes = tokio::spawn(async move {
        let mut latencies = Vec::with_capacity(reports);
        for _ in 0..reports {
            tokio::time::sleep(Duration::from_millis(1)).await;
            let start = Instant::now();
            assert_eq!(handle.push(first, &report).await.expect("pushed").len(), 1, "the first app is there");
            latencies.push(start.elapsed().as_secs_f64() * 1e6);
        }
        latencies
    });
    let mut latencies = pushes.await.expect("a robot that lives");
    latencies.sort_by(f64::total_cmp);
    let at = |share: f64| latencies[((latencies.len() - 1) as f64 * share) as usize];
    println!("{} {}", at(0.5), at(0.99));
}

/// The queue of frames to one app of the floor.
struct Listener {
    frames: mpsc::UnboundedSender<Arc<[u8]>>,
}

async fn raw() {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).await.expect("bind");
    println!("{}", listener.local_addr().expect("address"));
    let (acknowledged, heard) = (Arc::new(AtomicUsize::new(0)), Arc::new(Notify::new()));
    let (accepted, mut apps_accepted) = mpsc::unbounded_channel();
    tokio::spawn(async move {
        while let Ok((stream, _)) = listener.accept().await {
            let _ = accepted.send(stream);
        }
    });
    let order = order().await;
    let (apps, reports) = (number(&order[1]), number(&order[2]));
    let mut listeners = Vec::new();
    while listeners.len() < apps {
        let stream = apps_accepted.recv().await.expect("an app");
        stream.set_nodelay(true).expect("nodelay");
        let (frames, outbox) = mpsc::unbounded_channel();
        tokio::spawn(attend(stream, outbox, Arc::clone(&acknowledged), Arc::clone(&heard)));
        listeners.push(Listener { frames });
    }
    let report: Arc<[u8]> = vec![7; REPORT].into();
    let meter = Meter::start();
    let start = Instant::now();
    let mut pushed = 0;
    while pushed < reports {
        let batch = (reports - pushed).min(BATCH);
        pushed += batch;
        for _ in 0..batch {
            for listener in &listeners {
                let _ = listener.frames.send(Arc::clone(&report));
            }
        }
        while acknowledged.load(Ordering::Relaxed) < pushed * apps {
            heard.notified().await;
        }
    }
    println!("{} {}", start.elapsed().as_secs_f64(), meter.cpu());
}

/// Writes all queued frames in one write, and counts the acknowledgements by their bytes.
async fn attend(
    stream: TcpStream,
    mut outbox: mpsc::UnboundedReceiver<Arc<[u8]>>,
    acknowledged: Arc<AtomicUsize>,
    heard: Arc<Notify>,
) {
    let (mut reader, mut writer) = stream.into_split();
    tokio::spawn(async move {
        let mut out = Vec::new();
        while let Some(frame) = outbox.recv().await {
            out.clear();
            out.extend_from_slice(&frame);
            while let Ok(frame) = outbox.try_recv() {
                out.extend_from_slice(&frame);
            }
            if writer.write_all(&out).await.is_err() {
                return;
            }
        }
    });
    let mut input = vec![0; 64 * 1024];
    let mut have = 0;
    while let Ok(read @ 1..) = reader.read(&mut input).await {
        have += read;
        acknowledged.fetch_add(have / ACKNOWLEDGEMENT, Ordering::Relaxed);
        have %= ACKNOWLEDGEMENT;
        heard.notify_one();
    }
}
