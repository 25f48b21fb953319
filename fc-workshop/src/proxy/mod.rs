//! A proxy between apps and a robot. It forwards everything, describes the frames, and injects faults.
//!
//! ```text
//! app ──read──► relay ──► robot        one relay for each direction of a connection
//!                 └─► Decoder ──► Event::Record
//! ```

mod text;

pub use text::{json_line, line, unreachable};

use crate::capture::Flow;
use crate::decode::{Decoder, Record};
use crate::facts;
use crate::fault::{Delivery, Fault, FaultKind, Faults};
use crate::listen::{self, Listeners};
use crate::stream::FrameStream;
use fc_reflect::{FrameId, Reflector};
use futures_util::future::try_join;
use futures_util::stream::{FuturesUnordered, StreamExt as _};
use std::cell::RefCell;
use std::io;
use std::num::NonZeroU32;
use std::pin::pin;
use std::time::{Duration, SystemTime, UNIX_EPOCH};
use tokio::io::{AsyncRead, AsyncReadExt as _, AsyncWrite, AsyncWriteExt as _, split};
use tokio::net::TcpStream;
use tokio::time::{sleep, timeout};

/// Room for one read, in bytes.
const READ: usize = 16 * 1024;

/// The pieces of a second in which a slow frame is written.
const PER_SECOND: u32 = 20;

/// The settings of a proxy.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Address of the robot's command port.
    pub commands: String,
    /// Address of the robot's data port.
    pub data: String,
    /// The faults to inject.
    pub faults: Vec<Fault>,
    /// The seed of the faults that strike by chance.
    pub seed: u64,
}

/// An observation of a proxy.
#[derive(Debug)]
pub enum Event<'e, 'm> {
    /// A frame, or bytes that are none, as the sender sent them.
    Record(&'e Record<'m>),
    /// Faults in a frame.
    Faults {
        /// The direction of the connection.
        flow: Flow,
        /// The frame.
        id: FrameId,
        /// The faults.
        kinds: &'e [FaultKind],
    },
    /// The robot accepts no connection at an address.
    Unreachable(&'e str, &'e io::Error),
}

/// Receives the observations of a proxy.
pub type Sink<'o, 'm> = dyn FnMut(Event<'_, 'm>) -> io::Result<()> + 'o;

/// Forwards connections until `end` is ready.
///
/// # Errors
/// The error of `sink`.
pub async fn serve<'m>(
    reflector: &Reflector<'m>,
    settings: &Settings,
    listeners: Listeners,
    sink: &mut Sink<'_, 'm>,
    end: impl Future<Output = ()>,
) -> io::Result<()> {
    let most = facts::limits(reflector.model()).connections;
    let proxy = &Proxy::new(reflector, settings, sink);
    let mut links = FuturesUnordered::new();
    let mut end = pin!(end);
    let mut count = 0;
    loop {
        tokio::select! {
            () = &mut end => return proxy.decoder.borrow_mut().finish(&mut proxy.seen()),
            app = listen::accept(&listeners.commands), if links.len() < most => {
                count += 1;
                links.push(proxy.link(app, &settings.commands, count));
            }
            app = listen::accept(&listeners.data), if links.len() < most => {
                count += 1;
                links.push(proxy.link(app, &settings.data, count));
            }
            Some(ended) = links.next(), if !links.is_empty() => ended?,
        }
    }
}

/// Forwards one connection between streams of any kind until it ends. `number` tells connections apart, which then have
/// different chances of faults.
///
/// # Errors
/// The error of `sink`.
pub async fn forward<'m, A, R>(
    reflector: &Reflector<'m>,
    settings: &Settings,
    (flow, number): (Flow, u64),
    (app, robot): (A, R),
    sink: &mut Sink<'_, 'm>,
) -> io::Result<()>
where
    A: AsyncRead + AsyncWrite,
    R: AsyncRead + AsyncWrite,
{
    let proxy = Proxy::new(reflector, settings, sink);
    proxy.forward((flow, number), app, robot).await
}

/// The parts of a proxy that its connections share.
struct Proxy<'r, 'm, 's, 'o> {
    reflector: &'r Reflector<'m>,
    settings: &'r Settings,
    /// The decoder of all connections.
    decoder: RefCell<Decoder<'r, 'm>>,
    sink: RefCell<&'s mut Sink<'o, 'm>>,
}

/// The reason why a relay ends before its sender has closed its side.
enum Stop {
    /// The connection is broken, or a fault ends it.
    Broken,
    /// The sink has failed.
    Sink(io::Error),
}

impl<'r, 'm, 's, 'o> Proxy<'r, 'm, 's, 'o> {
    fn new(
        reflector: &'r Reflector<'m>,
        settings: &'r Settings,
        sink: &'s mut Sink<'o, 'm>,
    ) -> Self {
        Self {
            reflector,
            settings,
            decoder: RefCell::new(Decoder::new(reflector)),
            sink: RefCell::new(sink),
        }
    }

    fn show(&self, event: Event<'_, 'm>) -> io::Result<()> {
        self.sink.borrow_mut()(event)
    }

    /// Returns the receiver of the records.
    fn seen(&self) -> impl FnMut(&Record<'m>) -> io::Result<()> {
        |record| self.show(Event::Record(record))
    }

    /// Connects to the robot and forwards a connection until it ends.
    async fn link(&self, app: TcpStream, robot: &str, number: u64) -> io::Result<()> {
        let wait = facts::call_timeout(self.reflector.model());
        let connected = timeout(wait, TcpStream::connect(robot)).await;
        let robot = match connected.unwrap_or_else(|_| Err(io::ErrorKind::TimedOut.into())) {
            Ok(stream) => stream,
            Err(error) => return self.show(Event::Unreachable(robot, &error)),
        };
        // Without it, small frames only travel later.
        let _ = robot.set_nodelay(true);
        let (Ok(from), Ok(to)) = (app.peer_addr(), robot.peer_addr()) else {
            return Ok(());
        };
        self.forward((Flow { from, to }, number), app, robot).await
    }

    async fn forward<A, R>(&self, (flow, number): (Flow, u64), app: A, robot: R) -> io::Result<()>
    where
        A: AsyncRead + AsyncWrite,
        R: AsyncRead + AsyncWrite,
    {
        let (app_reads, app_writes) = split(app);
        let (robot_reads, robot_writes) = split(robot);
        let there = self.relay(flow, app_reads, robot_writes, 2 * number);
        let back = self.relay(flow.reversed(), robot_reads, app_writes, 2 * number + 1);
        if let Err(Stop::Sink(error)) = try_join(there, back).await {
            return Err(error);
        }
        let mut decoder = self.decoder.borrow_mut();
        decoder.close(Some(flow), &mut self.seen())?;
        decoder.close(Some(flow.reversed()), &mut self.seen())
    }

    /// Forwards one direction until its sender closes its side.
    async fn relay(
        &self,
        flow: Flow,
        mut reader: impl AsyncRead + Unpin,
        mut writer: impl AsyncWrite + Unpin,
        stream: u64,
    ) -> Result<(), Stop> {
        let Settings { faults, seed, .. } = self.settings;
        let faults = Faults::new(self.reflector, faults, *seed, stream);
        let mut link = (!self.settings.faults.is_empty()).then(|| FaultyLink {
            faults,
            frames: FrameStream::default(),
        });
        let mut buffer = vec![0; READ];
        loop {
            let read = reader.read(&mut buffer).await;
            let count = read.map_err(|_| Stop::Broken)?;
            let bytes = buffer.get(..count).unwrap_or_default();
            let time = SystemTime::now().duration_since(UNIX_EPOCH).ok();
            let mut seen = self.seen();
            let pushed = (self.decoder.borrow_mut()).push(Some(flow), time, bytes, &mut seen);
            pushed.map_err(Stop::Sink)?;
            match &mut link {
                Some(link) => self.deliver(link, flow, bytes, &mut writer).await?,
                None => (writer.write_all(bytes).await).map_err(|_| Stop::Broken)?,
            }
            if count == 0 {
                // The receiver may have left already.
                let _ = writer.shutdown().await;
                return Ok(());
            }
        }
    }

    /// Forwards the frames in received bytes, with their faults; no bytes are the end.
    async fn deliver(
        &self,
        link: &mut FaultyLink<'_, 'm>,
        flow: Flow,
        bytes: &[u8],
        writer: &mut (impl AsyncWrite + Unpin),
    ) -> Result<(), Stop> {
        link.frames.room().extend_from_slice(bytes);
        loop {
            let piece = match link.frames.next(self.reflector) {
                Ok(Some(piece)) => piece,
                Ok(None) if !bytes.is_empty() => return Ok(()),
                // The end of the bytes, or bytes that are no frame.
                Ok(None) | Err(_) => {
                    let rest = std::mem::take(&mut link.frames);
                    let written = writer.write_all(rest.rest()).await;
                    return written.map_err(|_| Stop::Broken);
                }
            };
            let delivery = link.faults.deliver(&piece);
            if let (Ok(frame), false) = (&piece.frame, delivery.faults.is_empty()) {
                let (id, kinds) = (frame.id, &delivery.faults);
                let shown = self.show(Event::Faults { flow, id, kinds });
                shown.map_err(Stop::Sink)?;
            }
            if write(&delivery, writer).await.is_err() || delivery.ends {
                return Err(Stop::Broken);
            }
        }
    }
}

/// The frames of a direction, with their faults.
struct FaultyLink<'r, 'm> {
    faults: Faults<'r, 'm>,
    frames: FrameStream,
}

/// Writes a frame as it arrives.
async fn write(delivery: &Delivery, writer: &mut (impl AsyncWrite + Unpin)) -> io::Result<()> {
    sleep(delivery.delay).await;
    let Some(rate) = delivery.rate else {
        return writer.write_all(&delivery.bytes).await;
    };
    let size = (rate.get() / PER_SECOND).max(1);
    let pause = Duration::from_secs(1) * size / NonZeroU32::get(rate);
    for piece in delivery.bytes.chunks(size as usize) {
        writer.write_all(piece).await?;
        sleep(pause).await;
    }
    Ok(())
}
