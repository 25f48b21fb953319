//! Sends and receives chunks over a plain socket.

use super::{Direction, Load, Seconds, digested};
use fc_bench_cases::messages::picture;
use std::time::Instant;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::TcpStream;

/// Length of the digest before a chunk, in bytes.
const DIGEST: usize = 16;

/// Sends chunks, each after its digest if `md5` is set. Returns 0, because only a receiver measures seconds.
pub async fn send(stream: &mut TcpStream, md5: bool, load: Load) -> Seconds {
    let data = picture(load.chunk);
    for _ in 0..load.count {
        let sent = async {
            if md5 {
                stream.write_all(&digested(&data)).await?;
            }
            stream.write_all(&data).await
        };
        if sent.await.is_err() {
            break;
        }
    }
    let _ = stream.shutdown().await;
    0.0
}

/// Receives chunks, and checks their digests if `md5` is set. Returns the seconds since the first bytes.
pub async fn receive(stream: &mut TcpStream, md5: bool, load: Load) -> Seconds {
    let mut first = None;
    let mut buffer = vec![0; if md5 { DIGEST + load.chunk } else { 256 * 1024 }];
    let total = load.chunk.saturating_mul(load.count);
    let start: fn() -> Instant = if load.direction == Direction::Down { flowing } else { Instant::now };
    let mut received = 0;
    while received < total {
        if md5 {
            if stream.read_exact(&mut buffer).await.is_err() {
                break;
            }
            let (digest, data) = buffer.split_at(DIGEST);
            assert!(digested(data) == digest, "the digest is wrong");
            received += load.chunk;
        } else {
            match stream.read(&mut buffer).await {
                Ok(0) | Err(_) => break,
                Ok(read) => received += read,
            }
        }
        first.get_or_insert_with(start);
    }
    first.map_or(0.0, |first: Instant| first.elapsed().as_secs_f64())
}

/// Prints that bytes have arrived, and returns the current time.
pub fn flowing() -> Instant {
    println!("flowing");
    Instant::now()
}
