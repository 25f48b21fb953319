//! Bytes to frames.

use super::Frame;
use super::buffer::Buffer;
use super::digesting::{Digesting, LONG};
use super::error::{FrameError, FrameId};
use super::gzip::{InflateError, Inflater};
use crate::protocol::{DigestOf, Protocol};
use crate::wire::{Header, Limits};
use std::marker::PhantomData;
use std::ops::Range;

/// How many times the longest frame a search may look through without success: heads that lie inside each
/// other must not cost more work than they cost bytes.
const SEARCH: u64 = 4;

/// Bytes that are digested at most before more is read.
const PIECE: usize = 256 * 1024;

/// What a frame makes a decoder look at, in bytes.
#[cfg(feature = "server")]
#[derive(Clone, Copy, Debug)]
pub(crate) struct Work {
    /// Its data.
    pub(crate) data: usize,
    /// What that is inflated to; 0 if it is not.
    pub(crate) inflated: usize,
}

/// A header and where its data lies.
type Located<P> = (<P as Protocol>::Header, Range<usize>);

/// Cuts a stream of bytes into frames.
///
/// Bytes come in with [`push`](Self::push) in any split; [`next`](Self::next) gives one frame after
/// the other and borrows its body from the decoder's own buffer. What can be refused is refused as
/// soon as it is known: a wrong head with its first wrong byte, an impossible length before the data
/// has come.
///
/// Memory: the receive buffer grows with what has really arrived, up to about twice the longest
/// frame; a compressed body takes its plain length besides, never more than the limit.
#[derive(Debug)]
pub struct Decoder<P: Protocol> {
    received: Buffer,
    inflated: Buffer,
    inflater: Option<Inflater>,
    frame_bytes: u32,
    inflated_bytes: u32,
    inflate_ratio: u32,
    verify_digest: bool,
    /// Of the frame at the front.
    ahead: Digesting<DigestOf<P>>,
    resync: bool,
    /// Bytes have been skipped and no frame has been found since.
    searching: bool,
    /// Bytes of frames that were tried in this search without success.
    tried: u64,
    skipped: u64,
    /// Bytes that came out of compressed data beyond those that went in.
    surplus: u64,
    failed: Option<FrameError>,
    protocol: PhantomData<P>,
}

impl<P: Protocol> Default for Decoder<P> {
    fn default() -> Self {
        Self::new()
    }
}

impl<P: Protocol> Decoder<P> {
    /// A decoder with the protocol's default limits, which verifies digests and does not search for
    /// lost frames.
    #[must_use]
    pub fn new() -> Self {
        Self {
            received: Buffer::default(),
            inflated: Buffer::default(),
            inflater: None,
            frame_bytes: P::DEFAULTS.limits.frame_bytes,
            inflated_bytes: P::DEFAULTS.limits.inflated_bytes,
            inflate_ratio: P::DEFAULTS.limits.inflate_ratio,
            verify_digest: true,
            ahead: Digesting::default(),
            resync: false,
            searching: false,
            tried: 0,
            skipped: 0,
            surplus: 0,
            failed: None,
            protocol: PhantomData,
        }
    }

    /// Sets the longest frame, the longest data after decompression, and by how much it may grow.
    #[must_use]
    pub fn limits(mut self, limits: &Limits) -> Self {
        self.frame_bytes = limits.frame_bytes;
        self.inflated_bytes = limits.inflated_bytes;
        self.inflate_ratio = limits.inflate_ratio;
        self
    }

    /// Whether to verify digests (the default). Leaving it out saves about half of the time spent on
    /// a frame, and leaves damage to be found by TCP's own checksum and by the parser.
    #[must_use]
    pub fn verify_digest(mut self, verify: bool) -> Self {
        self.verify_digest = verify;
        self
    }

    /// Whether to search for the next frame after a wrong head or an impossible length, instead of
    /// failing for good (the default). While searching, only a frame that is right in every respect
    /// is taken for one; a search that has looked at several times the longest frame without success fails.
    #[must_use]
    pub fn resync(mut self, resync: bool) -> Self {
        self.resync = resync;
        self
    }

    /// Appends received bytes.
    pub fn push(&mut self, bytes: &[u8]) {
        self.room().extend_from_slice(bytes);
    }

    /// The buffer to append received bytes to, with room for a good read behind its end. What it
    /// holds already is the decoder's: only append.
    pub(crate) fn room(&mut self) -> &mut Vec<u8> {
        self.received.room(self.missing())
    }

    /// How much memory the next [`room`](Self::room) takes beyond what there is, in bytes.
    #[cfg(feature = "server")]
    pub(crate) fn growth(&self) -> usize {
        self.received.growth(self.missing())
    }

    /// Whether nothing of a frame has come, and there is no memory yet to receive one.
    #[cfg(feature = "server")]
    pub(crate) fn is_bare(&self) -> bool {
        self.pending() == 0 && self.growth() > 0
    }

    /// Takes the first bytes of a frame when it [is bare](Self::is_bare), and only as much memory.
    #[cfg(feature = "server")]
    pub(crate) fn begin(&mut self, bytes: &[u8]) {
        self.received.begin(bytes);
    }

    /// The part of the frame at the front that has been announced and has not come, in bytes.
    fn missing(&self) -> usize {
        let held = self.received.unread();
        P::Header::peek_total_length(held)
            .filter(|&total| total <= self.frame_bytes)
            .and_then(|total| usize::try_from(total).ok())
            .map_or(0, |total| total.saturating_sub(held.len()))
    }

    /// Bytes received and not yet given out as frames.
    #[must_use]
    pub fn pending(&self) -> usize {
        self.received.unread().len()
    }

    /// How long the frame claims to be that has begun to arrive, in bytes, if that has come already.
    #[cfg(feature = "client")]
    pub(crate) fn expected(&self) -> Option<usize> {
        let total = P::Header::peek_total_length(self.received.unread())?;
        usize::try_from(total).ok()
    }

    /// Whether the frame that has begun to arrive lacks a part of its header.
    #[cfg(feature = "server")]
    pub(crate) fn inside_header(&self) -> bool {
        (1..P::Header::LEN).contains(&self.pending())
    }

    /// Memory kept for what comes next, in bytes; all there is, if nothing is pending.
    #[cfg(feature = "server")]
    pub(crate) fn idle(&self) -> usize {
        let received = match self.pending() {
            0 => self.received.capacity(),
            _ => 0,
        };
        received + self.inflated.capacity()
    }

    /// Gives back that memory. The frame given out last must not be of interest any more.
    #[cfg(feature = "server")]
    pub(crate) fn tidy(&mut self) {
        self.received.tidy();
        self.inflated = Buffer::default();
    }

    /// Gives back the memory of a large body that nobody looks at any more.
    pub(crate) fn release(&mut self) {
        self.inflated.release();
    }

    /// How many bytes have come out of compressed data since this was last asked, beyond those that
    /// went in: work that the peer has caused and not paid for by sending.
    #[cfg(feature = "server")]
    pub(crate) fn take_surplus(&mut self) -> u64 {
        std::mem::take(&mut self.surplus)
    }

    /// The work on the frame at the front, if it is there as a whole and so much at least, in bytes to be
    /// looked at.
    #[cfg(feature = "server")]
    pub(crate) fn work(&self, least: usize) -> Option<Work> {
        /// Bytes that deflate makes of one at most.
        const EXPANDS: u64 = 1032;

        // Seen at a glance of most frames.
        let total = P::Header::peek_total_length(self.received.unread())?;
        if u64::from(total) * (1 + EXPANDS) < least as u64 {
            return None;
        }
        let Ok(Some((header, data))) = self.locate() else {
            return None;
        };
        let packed = Some(header.encoding()) == P::GZIP;
        let plain = header.plain_length();
        let inflated = if packed && plain <= self.inflated_bytes {
            usize::try_from(plain).unwrap_or(usize::MAX)
        } else {
            0
        };
        let work = Work {
            data: data.len(),
            inflated,
        };
        (work.data.saturating_add(work.inflated) >= least).then_some(work)
    }

    /// Bytes passed over in search of a frame since the beginning.
    #[must_use]
    pub fn skipped(&self) -> u64 {
        self.skipped
    }

    /// Memory held for buffers, in bytes.
    #[must_use]
    pub fn capacity(&self) -> usize {
        self.received.capacity() + self.inflated.capacity()
    }

    /// The next whole frame; `None` if it has not arrived yet.
    ///
    /// # Errors
    ///
    /// [`FrameError`]. If it is fatal, every further call gives it again; otherwise the frame has
    /// been skipped and the next call goes on behind it.
    #[allow(
        clippy::should_implement_trait,
        reason = "a frame borrows from the decoder, which an iterator's item cannot"
    )]
    pub fn next(&mut self) -> Result<Option<Frame<'_, P>>, FrameError> {
        self.release();
        if let Some(error) = self.failed {
            return Err(error);
        }
        loop {
            match self.locate() {
                Ok(None) => {
                    self.digest_ahead();
                    return Ok(None);
                }
                Ok(Some((header, data))) => {
                    let packed = Some(header.encoding()) == P::GZIP;
                    match self.check(&header, &data) {
                        Ok(()) => {
                            self.searching = false;
                            self.tried = 0;
                            self.received.consume(data.end);
                            return Ok(Some(if packed {
                                let range = 0..self.inflated.unread().len();
                                Frame::new(header, &mut self.inflated, range)
                            } else {
                                Frame::new(header, &mut self.received, data)
                            }));
                        }
                        Err(_) if self.searching => {
                            self.tried += u64::from(header.total_length());
                            if self.tried > SEARCH * u64::from(self.frame_bytes) {
                                self.failed = Some(FrameError::BadHead);
                                return Err(FrameError::BadHead);
                            }
                            self.search();
                        }
                        Err(error) => {
                            self.received.consume(data.end);
                            return Err(error);
                        }
                    }
                }
                Err(_) if self.resync => self.search(),
                Err(error) => {
                    self.failed = Some(error);
                    return Err(error);
                }
            }
        }
    }

    /// Digests what has arrived of a long frame at the front.
    fn digest_ahead(&mut self) {
        let held = self.received.unread();
        let total =
            P::Header::peek_total_length(held).and_then(|total| usize::try_from(total).ok());
        if total.is_some_and(|total| total >= LONG) && self.verify_digest && !self.searching {
            let data = held.get(P::Header::LEN..).unwrap_or_default();
            self.ahead.go_on(data, PIECE);
        }
    }

    /// Says whether the stream may end here.
    ///
    /// # Errors
    ///
    /// [`FrameError::Truncated`] inside a frame; the fatal error if there was one.
    pub fn finish(&self) -> Result<(), FrameError> {
        match (self.failed, self.pending()) {
            (Some(error), _) => Err(error),
            (None, 0) => Ok(()),
            (None, _) if self.searching => Ok(()),
            (None, bytes) => Err(FrameError::Truncated { bytes }),
        }
    }

    /// Header and place of the data of the frame at the front, if all of it is there. Errors are
    /// fatal ones.
    fn locate(&self) -> Result<Option<Located<P>>, FrameError> {
        let held = self.received.unread();
        if !opens(held, P::REQUEST_HEAD) && !opens(held, P::RESPONSE_HEAD) {
            return Err(FrameError::BadHead);
        }
        let Some(total) = P::Header::peek_total_length(held) else {
            return Ok(None);
        };
        if total > self.frame_bytes {
            return Err(FrameError::FrameTooLong {
                total: u64::from(total),
                limit: self.frame_bytes,
            });
        }
        let length = usize::try_from(total).unwrap_or(usize::MAX);
        if length < P::Header::LEN {
            return Err(FrameError::ShortFrame {
                total,
                header: P::Header::LEN,
            });
        }
        if held.len() < length {
            return Ok(None);
        }
        let start = self.received.start();
        Ok(P::Header::read(held).map(|header| (header, start + P::Header::LEN..start + length)))
    }

    /// Checks a whole frame in the order that decides which of several errors it has, and inflates
    /// it. Errors are never fatal.
    fn check(&mut self, header: &P::Header, data: &Range<usize>) -> Result<(), FrameError> {
        let ahead = std::mem::take(&mut self.ahead);
        let frame = FrameId::of::<P>(header);
        let kind = header.kind();
        if P::RESERVED_KINDS.contains(&kind) {
            return Err(FrameError::ReservedKind { frame });
        }
        if kind != P::COMMAND && kind != P::REPORT && kind != P::STREAM {
            return Err(FrameError::UnknownKind { frame });
        }
        let encoding = header.encoding();
        if encoding != P::PLAIN && Some(encoding) != P::GZIP {
            return Err(FrameError::UnknownEncoding { frame, encoding });
        }
        let bytes = self.received.get(data);
        if self.verify_digest && ahead.finish(bytes) != header.digest() {
            return Err(FrameError::BadDigest { frame });
        }
        let plain = header.plain_length();
        let mismatch = FrameError::PlainLengthMismatch { frame, plain };
        if encoding == P::PLAIN {
            let length = u32::try_from(bytes.len());
            let quirk = P::ZERO_PLAIN_LENGTH && plain == 0;
            return if length == Ok(plain) || quirk {
                Ok(())
            } else {
                Err(mismatch)
            };
        }
        if plain > self.inflated_bytes {
            return Err(FrameError::InflatedTooLong {
                frame,
                plain,
                limit: self.inflated_bytes,
            });
        }
        let most = u64::from(self.inflate_ratio).saturating_mul(bytes.len() as u64);
        if kind != P::STREAM && plain > Limits::INFLATE_FREE && u64::from(plain) > most {
            return Err(FrameError::InflatesTooMuch {
                frame,
                plain,
                packed: bytes.len(),
                limit: self.inflate_ratio,
            });
        }
        let plain = usize::try_from(plain).map_err(|_| mismatch)?;
        let inflater = self.inflater.get_or_insert_with(Inflater::default);
        let out = self.inflated.replace();
        let outcome = inflater.inflate(bytes, plain, out);
        self.surplus += out.len().saturating_sub(bytes.len()) as u64;
        outcome.map_err(|error| match error {
            InflateError::Damaged => FrameError::BadGzip { frame },
            InflateError::Length => mismatch,
        })
    }

    /// Gives up the place at the front and goes to the next that may be a head.
    fn search(&mut self) {
        let held = self.received.unread();
        let next = (1..held.len())
            .find(|&at| {
                let rest = held.get(at..).unwrap_or_default();
                opens(rest, P::REQUEST_HEAD) || opens(rest, P::RESPONSE_HEAD)
            })
            .unwrap_or(held.len());
        self.received.consume(self.received.start() + next);
        self.searching = true;
        self.skipped += next as u64;
    }
}

/// Whether `bytes` begin like `head`, as far as they go.
fn opens(bytes: &[u8], head: &[u8]) -> bool {
    bytes.iter().zip(head).all(|(a, b)| a == b)
}
