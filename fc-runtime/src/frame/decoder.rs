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

/// Maximum work of a search without success, in multiples of the longest frame. Nested heads must not cost more work
/// than they cost bytes.
const SEARCH: u64 = 4;

/// Maximum bytes digested before the next read.
const PIECE: usize = 256 * 1024;

/// The work of a decoder on a frame, in bytes.
#[cfg(feature = "server")]
#[derive(Clone, Copy, Debug)]
pub(crate) struct Work {
    /// Length of the data.
    pub(crate) data: usize,
    /// Length of the inflated data, or 0 if it is not compressed.
    pub(crate) inflated: usize,
}

/// A header and where its data lies.
type Located<P> = (<P as Protocol>::Header, Range<usize>);

/// Splits a stream of bytes into frames.
///
/// [`push`](Self::push) accepts bytes in pieces of any size. [`next`](Self::next) returns one frame after the other,
/// whose body is borrowed from the decoder's buffer. Errors are returned as early as possible: a wrong head at its
/// first wrong byte, an impossible length before the data arrives.
///
/// The receive buffer grows with the received bytes, up to about twice the longest frame. A compressed body also takes
/// its plain length, which is limited.
#[derive(Debug)]
pub struct Decoder<P: Protocol> {
    received: Buffer,
    inflated: Buffer,
    inflater: Option<Inflater>,
    frame_bytes: u32,
    inflated_bytes: u32,
    inflate_ratio: u32,
    verify_digest: bool,
    /// Digest of the frame at the front, as far as it has arrived.
    ahead: Digesting<DigestOf<P>>,
    resync: bool,
    /// `true` after bytes have been skipped, until the next frame.
    searching: bool,
    /// Bytes of unsuccessful candidates in this search.
    tried: u64,
    skipped: u64,
    /// Bytes of inflated data beyond those of its compressed form.
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
    /// Creates a decoder with the protocol's default limits. It verifies digests and does not search for lost frames.
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

    /// Sets the longest frame, the longest inflated data, and the largest inflation ratio.
    #[must_use]
    pub fn limits(mut self, limits: &Limits) -> Self {
        self.frame_bytes = limits.frame_bytes;
        self.inflated_bytes = limits.inflated_bytes;
        self.inflate_ratio = limits.inflate_ratio;
        self
    }

    /// Sets whether to verify digests; `true` by default. Without verification, a frame takes about half the time, and
    /// only the checksum of TCP and the parser detect damage.
    #[must_use]
    pub fn verify_digest(mut self, verify: bool) -> Self {
        self.verify_digest = verify;
        self
    }

    /// Sets whether to search for the next frame after a wrong head or an impossible length; `false` by default.
    /// Without the search, the decoder fails for good. During a search, only a frame without any error is accepted. A
    /// search fails after several times the longest frame.
    #[must_use]
    pub fn resync(mut self, resync: bool) -> Self {
        self.resync = resync;
        self
    }

    /// Appends received bytes.
    pub fn push(&mut self, bytes: &[u8]) {
        self.room().extend_from_slice(bytes);
    }

    /// Returns the buffer for appending received bytes, with room for a read. Only append to it.
    pub(crate) fn room(&mut self) -> &mut Vec<u8> {
        self.received.room(self.missing())
    }

    /// Returns the memory that the next [`room`](Self::room) would add, in bytes.
    #[cfg(feature = "server")]
    pub(crate) fn growth(&self) -> usize {
        self.received.growth(self.missing())
    }

    /// Returns `true` if the decoder holds no bytes of a frame and no memory to receive one.
    #[cfg(feature = "server")]
    pub(crate) fn is_bare(&self) -> bool {
        self.pending() == 0 && self.growth() > 0
    }

    /// Takes the first bytes of a frame into a [bare](Self::is_bare) decoder, with only as much memory.
    #[cfg(feature = "server")]
    pub(crate) fn begin(&mut self, bytes: &[u8]) {
        self.received.begin(bytes);
    }

    /// Returns the number of announced but missing bytes of the frame at the front.
    fn missing(&self) -> usize {
        let held = self.received.unread();
        P::Header::peek_total_length(held)
            .filter(|&total| total <= self.frame_bytes)
            .and_then(|total| usize::try_from(total).ok())
            .map_or(0, |total| total.saturating_sub(held.len()))
    }

    /// Returns the number of received bytes that are not part of a returned frame.
    #[must_use]
    pub fn pending(&self) -> usize {
        self.received.unread().len()
    }

    /// Returns the announced length of the arriving frame in bytes, if it is known.
    #[cfg(feature = "client")]
    pub(crate) fn expected(&self) -> Option<usize> {
        let total = P::Header::peek_total_length(self.received.unread())?;
        usize::try_from(total).ok()
    }

    /// Returns `true` if the arriving frame lacks a part of its header.
    #[cfg(feature = "server")]
    pub(crate) fn inside_header(&self) -> bool {
        (1..P::Header::LEN).contains(&self.pending())
    }

    /// Returns the memory kept for the next frames, in bytes. This is all memory if no bytes are pending.
    #[cfg(feature = "server")]
    pub(crate) fn idle(&self) -> usize {
        let received = match self.pending() {
            0 => self.received.capacity(),
            _ => 0,
        };
        received + self.inflated.capacity()
    }

    /// Releases the memory kept for the next frames. The last returned frame must not be used any more.
    #[cfg(feature = "server")]
    pub(crate) fn tidy(&mut self) {
        self.received.tidy();
        self.inflated = Buffer::default();
    }

    /// Releases the memory of a large body that is not used any more.
    pub(crate) fn release(&mut self) {
        self.inflated.release();
    }

    /// Returns the inflated bytes since the last call beyond those received. This is work that the peer has not paid
    /// for by sending.
    #[cfg(feature = "server")]
    pub(crate) fn take_surplus(&mut self) -> u64 {
        std::mem::take(&mut self.surplus)
    }

    /// Returns the work on the frame at the front, if the frame is complete and the work is at least `least` bytes.
    #[cfg(feature = "server")]
    pub(crate) fn work(&self, least: usize) -> Option<Work> {
        /// Largest ratio of deflate.
        const EXPANDS: u64 = 1032;

        // A quick check that excludes most frames.
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

    /// Returns the number of bytes skipped in searches.
    #[must_use]
    pub fn skipped(&self) -> u64 {
        self.skipped
    }

    /// Returns the memory of the buffers, in bytes.
    #[must_use]
    pub fn capacity(&self) -> usize {
        self.received.capacity() + self.inflated.capacity()
    }

    /// Returns the next complete frame, or `None` if it has not arrived yet.
    ///
    /// # Errors
    ///
    /// [`FrameError`]. A fatal error is returned by every further call. After any other error, the frame has been
    /// skipped and the next call continues after it.
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

    /// Digests the received part of a long frame at the front.
    fn digest_ahead(&mut self) {
        let held = self.received.unread();
        let total =
            P::Header::peek_total_length(held).and_then(|total| usize::try_from(total).ok());
        if total.is_some_and(|total| total >= LONG) && self.verify_digest && !self.searching {
            let data = held.get(P::Header::LEN..).unwrap_or_default();
            self.ahead.go_on(data, PIECE);
        }
    }

    /// Checks that the stream may end here.
    ///
    /// # Errors
    ///
    /// [`FrameError::Truncated`] inside a frame, or an earlier fatal error.
    pub fn finish(&self) -> Result<(), FrameError> {
        match (self.failed, self.pending()) {
            (Some(error), _) => Err(error),
            (None, 0) => Ok(()),
            (None, _) if self.searching => Ok(()),
            (None, bytes) => Err(FrameError::Truncated { bytes }),
        }
    }

    /// Returns header and data range of the frame at the front, or `None` if it is incomplete. All errors are fatal.
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

    /// Checks and inflates a complete frame. The order of the checks decides which of several errors is returned. No
    /// error is fatal.
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

    /// Skips to the next position that may be a head.
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

/// Returns `true` if `bytes` and `head` agree up to the end of the shorter one.
fn opens(bytes: &[u8], head: &[u8]) -> bool {
    bytes.iter().zip(head).all(|(a, b)| a == b)
}
