//! Messages to bytes.

#[cfg(feature = "server")]
use super::digesting::{Digesting, LONG};
use super::error::{FrameError, FrameId};
use super::gzip::Deflater;
#[cfg(feature = "server")]
use super::prepared_response::PreparedBody;
use crate::digest::{Compute as _, Sum};
use crate::message::{Message, write_enveloped};
use crate::protocol::{DigestOf, Protocol};
use crate::wire::Header;
use std::fmt;
use std::marker::PhantomData;
#[cfg(feature = "server")]
use std::ops::Range;
use std::sync::Arc;

/// When and how hard to compress what is sent.
///
/// Level 1 suits lists; data that is dense already, such as base64 text of pictures, costs much
/// time and saves little, and is sent plain whenever compressing does not make it shorter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Gzip {
    /// Least length of the data area that is compressed, in bytes.
    pub from_bytes: usize,
    /// 1 (fast) to 9 (small).
    pub level: u8,
}

impl Default for Gzip {
    fn default() -> Self {
        Self {
            from_bytes: 1024,
            level: 1,
        }
    }
}

/// Writes frames behind the end of a buffer: header placeholder, body in place, then the header
/// with length and digest.
///
/// Keeps the compressor's state between frames.
#[derive(Debug)]
pub struct Encoder<P> {
    gzip: Option<(Gzip, Deflater)>,
    packed: Vec<u8>,
    #[cfg(feature = "client")]
    staged: Vec<u8>,
    frame_bytes: u32,
    protocol: PhantomData<P>,
}

impl<P: Protocol> Default for Encoder<P> {
    fn default() -> Self {
        Self::new()
    }
}

impl<P: Protocol> Encoder<P> {
    /// Compresses nothing; frames may be as long as the protocol's default limit.
    #[must_use]
    pub fn new() -> Self {
        Self {
            gzip: None,
            packed: Vec::new(),
            #[cfg(feature = "client")]
            staged: Vec::new(),
            frame_bytes: P::DEFAULTS.limits.frame_bytes,
            protocol: PhantomData,
        }
    }

    /// Compresses as `gzip` says, or not at all.
    #[must_use]
    pub fn gzip(mut self, gzip: impl Into<Option<Gzip>>) -> Self {
        self.gzip = gzip.into().map(|gzip| (gzip, Deflater::new(gzip.level)));
        self
    }

    /// Longest frame to be written, header included, in bytes.
    #[must_use]
    pub fn frame_bytes(mut self, limit: u32) -> Self {
        self.frame_bytes = limit;
        self
    }

    /// Appends a frame with envelope and message as its body.
    ///
    /// # Errors
    ///
    /// [`FrameError::FrameTooLong`]; `out` is as before.
    pub fn message<E: Message, B: Message>(
        &mut self,
        out: &mut Vec<u8>,
        id: FrameId,
        envelope: &E,
        body: &B,
    ) -> Result<(), FrameError> {
        self.frame(out, id, |out| write_enveloped(envelope, body, out))
    }

    /// Appends a frame with `data` as it is.
    ///
    /// # Errors
    ///
    /// [`FrameError::FrameTooLong`]; `out` is as before.
    pub fn bytes(&mut self, out: &mut Vec<u8>, id: FrameId, data: &[u8]) -> Result<(), FrameError> {
        self.frame(out, id, |out| out.extend_from_slice(data))
    }

    /// Appends a frame whose body `write` appends.
    ///
    /// # Errors
    ///
    /// [`FrameError::FrameTooLong`]; `out` is as before, also if `write` panics.
    pub fn frame(
        &mut self,
        out: &mut Vec<u8>,
        id: FrameId,
        write: impl FnOnce(&mut Vec<u8>),
    ) -> Result<(), FrameError> {
        let mut frame = Unfinished::new(out, P::Header::LEN);
        write(frame.out);
        self.finish(&mut frame, id)?;
        frame.finished = true;
        Ok(())
    }

    /// The same for a frame that may be long: then its header is missing until it has been digested, in
    /// whatever pieces.
    #[cfg(feature = "server")]
    pub(crate) fn unsealed(
        &mut self,
        out: &mut Vec<u8>,
        id: FrameId,
        write: impl FnOnce(&mut Vec<u8>),
    ) -> Result<Option<Unsealed<P>>, FrameError> {
        let mut frame = Unfinished::new(out, P::Header::LEN);
        write(frame.out);
        let start = frame.start;
        let data = start + P::Header::LEN;
        let sealed = self.pack(frame.out, data)?;
        frame.finished = true;
        let data = data..frame.out.len();
        if data.len() < LONG {
            let sealed = sealed.digested::<P>(frame.out.get(data).unwrap_or_default());
            sealed.write::<P>(frame.out, start, id);
            return Ok(None);
        }
        Ok(Some(Unsealed {
            id,
            sealed,
            start,
            data,
            digesting: Digesting::default(),
        }))
    }

    /// Packs and digests a body once, to be sent any number of times.
    ///
    /// # Errors
    ///
    /// [`FrameError::FrameTooLong`].
    pub fn prepare(&mut self, write: impl FnOnce(&mut Vec<u8>)) -> Result<Prepared, FrameError> {
        let mut data = Vec::new();
        write(&mut data);
        let sealed = self.seal(&mut data, 0)?;
        Ok(Prepared::new(sealed, data))
    }

    /// Packs and digests a body in memory of its own, to be copied behind whatever is sent next.
    #[cfg(feature = "client")]
    pub(crate) fn stage(
        &mut self,
        write: impl FnOnce(&mut Vec<u8>),
    ) -> Result<Staged<'_>, FrameError> {
        let mut data = std::mem::take(&mut self.staged);
        data.clear();
        if data.capacity() > KEEP {
            data = Vec::new();
        }
        write(&mut data);
        let sealed = self.seal(&mut data, 0);
        self.staged = data;
        Ok(Staged {
            sealed: sealed?,
            data: &self.staged,
        })
    }

    /// Begins to prepare a body that is long: it is packed, and not digested yet.
    #[cfg(feature = "server")]
    pub(crate) fn begin(&mut self, mut data: Vec<u8>) -> Result<Preparing<P>, FrameError> {
        let sealed = self.pack(&mut data, 0)?;
        Ok(Preparing {
            sealed,
            data,
            digesting: Digesting::default(),
        })
    }

    /// Appends a frame with a body prepared before.
    pub fn prepared(&mut self, out: &mut Vec<u8>, id: FrameId, body: &Prepared) {
        body.header::<P>(out, id);
        out.extend_from_slice(&body.data);
    }

    /// Appends a frame with a kept body, and the keys of `envelope` behind its own.
    ///
    /// # Errors
    ///
    /// [`FrameError::FrameTooLong`]; `out` is as before.
    #[cfg(feature = "server")]
    pub(crate) fn prepared_response<E: Message>(
        &mut self,
        out: &mut Vec<u8>,
        id: FrameId,
        envelope: &E,
        body: &PreparedBody<DigestOf<P>>,
    ) -> Result<(), FrameError> {
        let tail = body.tail(envelope);
        let data = body.text().len() + tail.text.len();
        let sealed = Sealed {
            digest: tail.digest,
            ..self.sealed(P::PLAIN, data, data)?
        };
        let start = out.len();
        out.reserve(P::Header::LEN + data);
        out.resize(start + P::Header::LEN, 0);
        sealed.write::<P>(out, start, id);
        out.extend_from_slice(body.text());
        out.extend_from_slice(&tail.text);
        Ok(())
    }

    fn finish(&mut self, frame: &mut Unfinished<'_>, id: FrameId) -> Result<(), FrameError> {
        let sealed = self.seal(frame.out, frame.start + P::Header::LEN)?;
        sealed.write::<P>(frame.out, frame.start, id);
        Ok(())
    }

    /// Packs what `out` holds from `start` on, in place, and finds what the header says of it.
    fn seal(&mut self, out: &mut Vec<u8>, start: usize) -> Result<Sealed, FrameError> {
        let sealed = self.pack(out, start)?;
        Ok(sealed.digested::<P>(out.get(start..).unwrap_or_default()))
    }

    /// The same but for the digest.
    fn pack(&mut self, out: &mut Vec<u8>, start: usize) -> Result<Sealed, FrameError> {
        let plain = out.len() - start;
        let mut encoding = P::PLAIN;
        if let (Some((gzip, deflater)), Some(packed)) = (&mut self.gzip, P::GZIP)
            && plain >= gzip.from_bytes
        {
            let data = out.get(start..).unwrap_or_default();
            if deflater.member(data, &mut self.packed) {
                out.truncate(start);
                out.extend_from_slice(&self.packed);
                encoding = packed;
            }
        }
        self.sealed(encoding, out.len() - start, plain)
    }

    /// What the header of a frame says of so much data, but for the digest.
    fn sealed(&self, encoding: u8, data: usize, plain: usize) -> Result<Sealed, FrameError> {
        let total = P::Header::LEN + data;
        let too_long = FrameError::FrameTooLong {
            total: total as u64,
            limit: self.frame_bytes,
        };
        let (Ok(total), Ok(plain)) = (u32::try_from(total), u32::try_from(plain)) else {
            return Err(too_long);
        };
        if total > self.frame_bytes {
            return Err(too_long);
        }
        Ok(Sealed {
            encoding,
            total,
            plain,
            digest: Sum::default(),
        })
    }
}

/// What a header says of the data behind it.
#[derive(Clone, Copy, Debug)]
struct Sealed {
    encoding: u8,
    total: u32,
    plain: u32,
    digest: Sum,
}

impl Sealed {
    /// The same with the digest of the data.
    fn digested<P: Protocol>(self, data: &[u8]) -> Self {
        Self {
            digest: DigestOf::<P>::of(data),
            ..self
        }
    }

    /// Writes the header to the place kept for it at `start`.
    fn write<P: Protocol>(&self, out: &mut [u8], start: usize, id: FrameId) {
        let head = if id.response {
            P::RESPONSE_HEAD
        } else {
            P::REQUEST_HEAD
        };
        let mut header = P::Header::new(head, id.kind, id.code, id.id, self.encoding);
        header.seal(self.total, self.plain, self.digest);
        header.write(out.get_mut(start..).unwrap_or_default());
    }
}

/// Memory that an encoder keeps for the next body, in bytes.
#[cfg(feature = "client")]
const KEEP: usize = 2 * 1024 * 1024;

/// A body that is packed and digested already, and lies in its encoder.
#[cfg(feature = "client")]
#[derive(Clone, Copy)]
pub(crate) struct Staged<'a> {
    sealed: Sealed,
    data: &'a [u8],
}

#[cfg(feature = "client")]
impl Staged<'_> {
    /// Appends a frame with it.
    pub(crate) fn append<P: Protocol>(&self, out: &mut Vec<u8>, id: FrameId) {
        out.reserve(P::Header::LEN + self.data.len());
        let start = out.len();
        out.resize(start + P::Header::LEN, 0);
        self.sealed.write::<P>(out, start, id);
        out.extend_from_slice(self.data);
    }
}

/// A body that is packed and digested already. Cheap to clone.
#[derive(Clone)]
pub struct Prepared {
    sealed: Sealed,
    /// Not `Arc<[u8]>`: that would copy a map once more.
    data: Arc<Vec<u8>>,
}

impl Prepared {
    fn new(sealed: Sealed, data: Vec<u8>) -> Self {
        Self {
            sealed,
            data: Arc::new(data),
        }
    }

    /// Appends the header of a frame with this body.
    pub(crate) fn header<P: Protocol>(&self, out: &mut Vec<u8>, id: FrameId) {
        let start = out.len();
        out.resize(start + P::Header::LEN, 0);
        self.sealed.write::<P>(out, start, id);
    }

    /// The packed body.
    #[cfg(any(feature = "client", feature = "server"))]
    pub(crate) fn data(&self) -> &[u8] {
        &self.data
    }

    /// Its length in bytes.
    #[cfg(feature = "server")]
    pub(crate) fn len(&self) -> usize {
        self.data.len()
    }
}

/// Shows the length alone: bodies may hold what must not be logged.
impl fmt::Debug for Prepared {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Prepared({} bytes)", self.data.len())
    }
}

/// A body that is packed already and being digested piece by piece, so that others have their turn
/// in between.
#[cfg(feature = "server")]
pub(crate) struct Preparing<P: Protocol> {
    sealed: Sealed,
    data: Vec<u8>,
    digesting: Digesting<DigestOf<P>>,
}

#[cfg(feature = "server")]
impl<P: Protocol> Preparing<P> {
    /// Digests at most so many bytes more. Whether some are left.
    pub(crate) fn go_on(&mut self, bytes: usize) -> bool {
        self.digesting.go_on(&self.data, bytes);
        !self.digesting.is_done(self.data.len())
    }

    /// The body, once nothing is left to be digested.
    pub(crate) fn finish(self) -> Prepared {
        let digest = self.digesting.finish(&self.data);
        Prepared::new(
            Sealed {
                digest,
                ..self.sealed
            },
            self.data,
        )
    }
}

/// A frame that lies in a buffer and lacks its header.
#[cfg(feature = "server")]
#[derive(Debug)]
pub(crate) struct Unsealed<P: Protocol> {
    id: FrameId,
    sealed: Sealed,
    /// Where the header is to be.
    start: usize,
    /// And what follows it.
    data: Range<usize>,
    digesting: Digesting<DigestOf<P>>,
}

#[cfg(feature = "server")]
impl<P: Protocol> Unsealed<P> {
    /// Digests at most so many bytes more of the buffer it lies in, and gives how many it were.
    pub(crate) fn go_on(&mut self, out: &[u8], most: usize) -> usize {
        let data = out.get(self.data.clone()).unwrap_or_default();
        self.digesting.go_on(data, most)
    }

    /// Whether nothing is left to be digested.
    pub(crate) fn is_digested(&self) -> bool {
        self.digesting.is_done(self.data.len())
    }

    /// Writes the header.
    pub(crate) fn seal(self, out: &mut [u8]) {
        let digest = (self.digesting).finish(out.get(self.data).unwrap_or_default());
        let sealed = Sealed {
            digest,
            ..self.sealed
        };
        sealed.write::<P>(out, self.start, self.id);
    }
}

/// A frame being written; takes itself back unless it is finished.
struct Unfinished<'a> {
    out: &'a mut Vec<u8>,
    start: usize,
    finished: bool,
}

impl<'a> Unfinished<'a> {
    fn new(out: &'a mut Vec<u8>, header: usize) -> Self {
        let start = out.len();
        out.resize(start + header, 0);
        Self {
            out,
            start,
            finished: false,
        }
    }
}

impl Drop for Unfinished<'_> {
    fn drop(&mut self) {
        if !self.finished {
            self.out.truncate(self.start);
        }
    }
}
