//! The process of the app, which receives or sends chunks.

use super::{CODE, Direction, Kind, Load, Seconds, plain};
use crate::calls::{fc, runtime};
use crate::cost::{Meter, peak_memory};
use fc_bench_cases::messages::picture;
use fc_generated::Fc;
use fc_runtime::Connection;
use std::net::SocketAddr;
use tokio::io::duplex;
use tokio::net::TcpStream;

/// Runs `data-drive KIND ADDRESS DIRECTION CHUNK COUNT RATE`.
///
/// A receiving app prints a line when the first bytes arrive. At the end, the app prints the seconds of receiving (0 if
/// it sends), CPU seconds, and the peak memory in MiB.
pub fn drive(kind: Kind, address: SocketAddr, load: Load) {
    runtime(false).block_on(async {
        let (seconds, cpu) = match kind {
            Kind::Fc => ours(address, load).await,
            Kind::Tcp | Kind::TcpMd5 => plain(kind == Kind::TcpMd5, address, load).await,
        };
        println!("{seconds} {cpu} {}", peak_memory());
    });
}

async fn ours(address: SocketAddr, load: Load) -> (Seconds, Seconds) {
    let config = fc::config(address).data_port(address.port());
    // This measurement makes no calls, so the command connection has no robot at its other end.
    let (commands, _robot) = duplex(64);
    let app = Connection::<Fc>::over(commands, config);
    let connection = app.data();
    connection.connected().await.expect("connect");
    let meter = Meter::start();
    if load.direction == Direction::Up {
        let data = picture(load.chunk);
        for id in 0..load.count {
            connection.send(CODE, u32::try_from(id).unwrap_or(u32::MAX), &data).await.expect("sent");
        }
        let cpu = meter.cpu();
        connection.close();
        return (0.0, cpu);
    }
    let mut first = None;
    for _ in 0..load.count {
        let frame = connection.recv().await.expect("a frame");
        assert_eq!(frame.data.len(), load.chunk, "a whole chunk");
        first.get_or_insert_with(plain::flowing);
    }
    (first.map_or(0.0, |first| first.elapsed().as_secs_f64()), meter.cpu())
}

async fn plain(md5: bool, address: SocketAddr, load: Load) -> (Seconds, Seconds) {
    let mut stream = TcpStream::connect(address).await.expect("connect");
    let meter = Meter::start();
    let seconds = match load.direction {
        Direction::Up => plain::send(&mut stream, md5, load).await,
        _ => plain::receive(&mut stream, md5, load).await,
    };
    (seconds, meter.cpu())
}
