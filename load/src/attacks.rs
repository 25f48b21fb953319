//! Hostile peers, and honest peers with a similar load.

use crate::apps::connect;
use crate::fault::Fault;
use crate::robot::Places;
use fc_generated::{Fc, GetFirmwareVersionsRequest, GetRobotSnRequest};
use fc_runtime::digest::{DigestAlgorithm as _, Md5};
use fc_runtime::{Command as _, Encoder, FrameId, Gzip, Header, Protocol};
use std::convert::Infallible;
use std::fmt::Write as _;
use std::net::Ipv4Addr;
use std::sync::Arc;
use std::time::Duration;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::{TcpSocket, TcpStream};
use tokio::task::JoinSet;
use tokio::time::{sleep, timeout};

type Head = <Fc as Protocol>::Header;

/// Limits of the robot in the attack `silent`. One address can use all connections.
pub const FEW: Places = Places {
    total: 2000,
    address: 2000,
};

/// Address of the attacker in the attack `silent`.
const ATTACKER: Ipv4Addr = Ipv4Addr::new(127, 0, 0, 3);

/// A code that no command has.
const UNKNOWN: u16 = 0xEEEE;

fn id(code: u16) -> FrameId {
    FrameId {
        response: false,
        kind: Fc::COMMAND,
        code,
        id: 7,
    }
}

pub fn frame(code: u16, body: &[u8]) -> Result<Vec<u8>, Fault> {
    let mut out = Vec::new();
    Encoder::<Fc>::new().bytes(&mut out, id(code), body)?;
    Ok(out)
}

/// Connects to `port` from this local address.
pub async fn from(address: Ipv4Addr, port: u16) -> std::io::Result<TcpStream> {
    let socket = TcpSocket::new_v4()?;
    socket.bind((address, 0).into())?;
    socket.connect((Ipv4Addr::LOCALHOST, port).into()).await
}

/// Runs an attack, or honest work, until the process is killed.
pub async fn attack(kind: &str, port: u16, data: u16) -> Result<(), Fault> {
    match kind {
        "bombs" => bombs(port).await,
        "keys" => flood(port, key_bombs()?, true).await,
        "lengths" => lengths(port).await,
        "slow" => slow(port).await,
        "held" => held(port).await,
        "silent" => silent([port, data]).await,
        "panics" => flood(port, frame(GetFirmwareVersionsRequest::CODE, b"{}")?, true).await,
        "codes" => flood(port, frame(UNKNOWN, b"{}")?, true).await,
        "deaf" => deaf(port).await,
        "frames" => {
            let mut damaged = frame(GetRobotSnRequest::CODE, b"{}")?;
            if let Some(last) = damaged.last_mut() {
                *last ^= 1;
            }
            flood(port, damaged, true).await
        }
        "reports" => stay(port, 100).await,
        "idle" => stay(port, 1000).await,
        "calls" => flood(port, frame(GetRobotSnRequest::CODE, b"{}")?, true).await,
        "large" => {
            let body = format!(r#"{{"text":"{}"}}"#, "x".repeat(64 * 1024));
            flood(port, frame(GetRobotSnRequest::CODE, body.as_bytes())?, true).await
        }
        "listeners" => listen(port).await,
        "visitors" => loop {
            let mut some = JoinSet::new();
            for _ in 0..100 {
                some.spawn(async move {
                    let app = connect(port).await?;
                    Ok::<_, Fault>(app.call(&GetRobotSnRequest::default()).await?)
                });
            }
            while let Some(visit) = some.join_next().await {
                visit??;
            }
        },
        "connections" => loop {
            let mut some = Vec::new();
            for _ in 0..100 {
                some.push(reach(port).await?);
            }
        },
        other => Err(format!("no such attack: {other}").into()),
    }
}

/// Opens connections and leaves them idle.
async fn stay(port: u16, count: usize) -> Result<(), Fault> {
    let mut idle = Vec::new();
    for _ in 0..count {
        idle.push(reach(port).await?);
    }
    std::future::pending().await
}

/// Receives and acknowledges reports on 100 connections.
async fn listen(port: u16) -> Result<(), Fault> {
    let mut listening = JoinSet::new();
    for _ in 0..100 {
        let mut reports = connect(port).await?.reports();
        listening.spawn(async move { while reports.recv().await.is_some() {} });
    }
    while listening.join_next().await.is_some() {}
    Ok(())
}

async fn reach(port: u16) -> Result<TcpStream, Fault> {
    loop {
        match TcpStream::connect(("127.0.0.1", port)).await {
            Ok(stream) => {
                // Closing resets the connection, so that a thousand closes a second leave no TIME_WAIT sockets.
                #[allow(deprecated, reason = "an attacker does not wait for its close")]
                stream.set_linger(Some(Duration::ZERO))?;
                return Ok(stream);
            }
            Err(_) => sleep(Duration::from_millis(5)).await,
        }
    }
}

/// Sends the same frame repeatedly on four connections. Opens a connection again after the robot closes it.
async fn flood(port: u16, frame: Vec<u8>, read: bool) -> Result<(), Fault> {
    let many = frame.repeat(32 * 1024 / frame.len().max(1) + 1);
    let mut tasks = JoinSet::new();
    for _ in 0..4 {
        let many = many.clone();
        tasks.spawn(async move {
            loop {
                let (mut from, mut to) = reach(port).await?.into_split();
                let reading = async {
                    let mut sink = vec![0; 64 * 1024];
                    while read && from.read(&mut sink).await.is_ok_and(|n| n > 0) {}
                    std::future::pending::<Infallible>().await
                };
                let writing = async { while to.write_all(&many).await.is_ok() {} };
                tokio::select! {
                    never = reading => return Ok::<_, Fault>(never),
                    () = writing => {}
                }
            }
        });
    }
    while tasks.join_next().await.is_some() {}
    Ok(())
}

async fn deaf(port: u16) -> Result<(), Fault> {
    let many = frame(UNKNOWN, b"{}")?.repeat(1000);
    loop {
        let mut kept = Vec::new();
        for _ in 0..20 {
            let mut stream = reach(port).await?;
            // A write that takes 20 ms means that the robot no longer reads.
            while timeout(Duration::from_millis(20), stream.write_all(&many))
                .await
                .is_ok_and(|sent| sent.is_ok())
            {}
            kept.push(stream);
        }
    }
}

async fn bombs(port: u16) -> Result<(), Fault> {
    let most = Fc::DEFAULTS.limits.inflated_bytes as usize;
    let mut bomb = Vec::new();
    let mut encoder = Encoder::<Fc>::new().gzip(Gzip {
        from_bytes: 0,
        level: 9,
    });
    encoder.bytes(&mut bomb, id(GetRobotSnRequest::CODE), &vec![b' '; most])?;
    let mut liar = bomb.clone();
    let (front, data) = liar.split_at_mut(Head::LEN);
    let mut header = Head::read(front).ok_or("no header")?;
    header.seal(header.total_length(), 100, Md5::digest(data));
    header.write(front);
    flood(port, [bomb, liar].concat(), true).await
}

async fn lengths(port: u16) -> Result<(), Fault> {
    let honest = frame(GetRobotSnRequest::CODE, b"{}")?;
    let mut header = Head::read(&honest).ok_or("no header")?;
    loop {
        for length in [0, 34, u32::MAX] {
            let mut lie = honest.clone();
            header.seal(length, 2, header.digest());
            header.write(&mut lie);
            let mut stream = reach(port).await?;
            let _ = stream.write_all(&lie).await;
            let _ = timeout(Duration::from_secs(1), stream.read(&mut [0; 100])).await;
        }
    }
}

async fn slow(port: u16) -> Result<(), Fault> {
    let bytes = frame(GetRobotSnRequest::CODE, &[b' '; 200])?;
    let mut slow = Vec::new();
    for _ in 0..1000 {
        slow.push(reach(port).await?);
    }
    for byte in bytes.iter().cycle() {
        for stream in &mut slow {
            if stream.write_all(std::slice::from_ref(byte)).await.is_err() {
                *stream = reach(port).await?;
            }
        }
        sleep(Duration::from_secs(1)).await;
    }
    Ok(())
}

/// Returns three compressed frames whose bodies repeat a short unknown key.
///
/// The first body is longer than a robot with the default memory inflates, and announces that length. The second has
/// 36 MiB, which such a robot inflates. The third stays below the limit of keys and items.
fn key_bombs() -> Result<Vec<u8>, Fault> {
    const KEY: &str = r#""a":[],"#;
    let limits = Fc::DEFAULTS.limits;
    let mut encoder = Encoder::<Fc>::new().gzip(Gzip {
        from_bytes: 0,
        level: 9,
    });
    let mut bombs = Vec::new();
    let keys = limits.json_values / 2;
    for length in [limits.inflated_bytes as usize, 36 << 20, keys * KEY.len()] {
        // Text that does not compress keeps the ratio of the body within `inflate_ratio`.
        let mut noise = String::new();
        let mut seed = 1_u64;
        while noise.len() < length / limits.inflate_ratio as usize * 3 / 2 {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            write!(noise, "{:x}", seed >> 32)?;
        }
        let count = (length - noise.len() - 20) / KEY.len();
        let body = format!("{{{}\"b\":\"{noise}\"}}", KEY.repeat(count));
        encoder.bytes(&mut bombs, id(GetRobotSnRequest::CODE), body.as_bytes())?;
    }
    Ok(bombs)
}

/// Length of the end of a held frame, which is sent slowly, in bytes.
const REST: usize = 1 << 20;
/// Speed of sending that end, in bytes per second.
const PIECE: usize = 2 * 1024;

/// Sends frames of the largest length on 64 connections. Sends all but the last [`REST`] bytes at once, and these only
/// as fast as the robot requires.
async fn held(port: u16) -> Result<(), Fault> {
    let total = Fc::DEFAULTS.limits.frame_bytes;
    let mut begun = frame(GetRobotSnRequest::CODE, b"{}")?;
    let mut header = Head::read(&begun).ok_or("no header")?;
    header.seal(total, total - Head::LEN as u32, header.digest());
    header.write(&mut begun);
    begun.resize(total as usize - REST, b' ');
    let begun = Arc::new(begun);
    let mut holders = JoinSet::new();
    for _ in 0..64 {
        let begun = Arc::clone(&begun);
        holders.spawn(async move { hold(port, &begun).await });
    }
    while let Some(holder) = holders.join_next().await {
        holder??;
    }
    Ok(())
}

/// Sends the first part of a frame at once and its end in pieces. Starts again after the robot closes the connection.
async fn hold(port: u16, begun: &[u8]) -> Result<Infallible, Fault> {
    loop {
        let mut stream = reach(port).await?;
        if stream.write_all(begun).await.is_err() {
            continue;
        }
        let piece = [b' '; PIECE];
        while stream.write_all(&piece).await.is_ok() {
            sleep(Duration::from_secs(1)).await;
        }
    }
}

/// Opens as many connections from one address as the robot accepts. Opens a new one for each that the robot closes.
async fn silent(ports: [u16; 2]) -> Result<(), Fault> {
    let mut attacks = JoinSet::new();
    for port in ports {
        attacks.spawn(async move {
            let mut open = JoinSet::new();
            loop {
                while open.len() < FEW.total {
                    match from(ATTACKER, port).await {
                        Ok(mut stream) => {
                            // The read ends when the robot closes the connection.
                            open.spawn(async move { stream.read(&mut [0]).await });
                        }
                        Err(_) => sleep(Duration::from_millis(5)).await,
                    }
                }
                open.join_next().await;
            }
        });
    }
    while attacks.join_next().await.is_some() {}
    Ok(())
}
