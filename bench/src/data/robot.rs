//! The process of the robot, which sends or receives chunks over the data port or a plain socket.

use super::{CODE, Direction, Kind, Load, Seconds, plain};
use crate::calls::{fc, runtime};
use crate::cost::{Meter, peak_memory};
use fc_bench_cases::messages::picture;
use fc_generated::Fc;
use fc_runtime::{Audience, ServerHandle};
use std::io::{Read as _, stdin};
use std::net::Ipv4Addr;
use std::time::Duration;
use tokio::net::TcpListener;
use tokio::time::{Instant, sleep, sleep_until};

/// Runs `data-serve KIND single|threads DIRECTION CHUNK COUNT RATE`.
///
/// Prints its addresses, waits for the app at the data port, and sends or receives the chunks. Then prints the seconds
/// of receiving (0 if it sends), CPU seconds, and the peak memory in MiB.
pub fn serve(kind: Kind, multi_thread: bool, load: Load) {
    runtime(multi_thread).block_on(async {
        let done = match kind {
            Kind::Fc => ours(load).await,
            Kind::Tcp | Kind::TcpMd5 => plain(kind == Kind::TcpMd5, load).await,
        };
        println!("{} {} {}", done.0, done.1, peak_memory());
    });
    let _ = stdin().lock().read_to_string(&mut String::new());
    std::process::exit(0);
}

async fn ours(load: Load) -> (Seconds, Seconds) {
    let server = fc::bind(fc::Robot::new(fc::Answers::Made)).await;
    println!("{} {}", server.command_addr(), server.data_addr());
    let handle = server.handle();
    let mut streams = handle.streams();
    let serving = tokio::spawn(server.run());
    if load.direction == Direction::Idle {
        let _ = serving.await;
        return (0.0, 0.0);
    }
    let data = picture(load.chunk);
    while handle.counters().data_connections == 0 {
        sleep(Duration::from_millis(1)).await;
    }
    let meter = Meter::start();
    let mut seconds = 0.0;
    if load.direction == Direction::Down {
        let mut pace = Pace::of(load);
        for id in 0..load.count {
            pace.wait().await;
            if !send(&handle, id, &data).await {
                break;
            }
        }
        // The queued chunks still have to be written.
        while handle.counters().stream_frames_out < load.count as u64 && !load.is_endless() {
            sleep(Duration::from_millis(1)).await;
        }
    } else {
        let mut received = 0;
        let mut first = None;
        while received < load.count {
            let frame = streams.recv().await.expect("a frame");
            assert_eq!(frame.frame.data.len(), load.chunk, "a whole chunk");
            first.get_or_insert_with(Instant::now);
            received += 1;
        }
        seconds = first.expect("a first chunk").elapsed().as_secs_f64();
    }
    (seconds, meter.cpu())
}

/// Sends a chunk to all apps. Returns `false` if no app is connected.
async fn send(handle: &ServerHandle<Fc>, id: usize, data: &[u8]) -> bool {
    let id = u32::try_from(id).unwrap_or(u32::MAX);
    matches!(handle.send_stream(Audience::All, CODE, id, data).await, Ok(1..))
}

/// The schedule of a load with a fixed rate.
struct Pace {
    next: Instant,
    every: Duration,
}

impl Pace {
    fn of(load: Load) -> Self {
        let every =
            load.bytes_per_second.map_or(Duration::ZERO, |rate| Duration::from_secs_f64(load.chunk as f64 / rate));
        Self { next: Instant::now(), every }
    }

    async fn wait(&mut self) {
        if !self.every.is_zero() {
            sleep_until(self.next).await;
            self.next += self.every;
        }
    }
}

async fn plain(md5: bool, load: Load) -> (Seconds, Seconds) {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).await.expect("bind");
    let address = listener.local_addr().expect("address");
    println!("{address} {address}");
    let (mut stream, _) = listener.accept().await.expect("an app");
    let meter = Meter::start();
    let seconds = match load.direction {
        Direction::Up => plain::receive(&mut stream, md5, load).await,
        _ => plain::send(&mut stream, md5, load).await,
    };
    (seconds, meter.cpu())
}
