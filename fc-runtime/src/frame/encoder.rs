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

/// Compression of sent data.
///
/// Level 1 suits lists. Dense data, such as base64 text of pictures, costs much time and saves little. Data that does
/// not become shorter is sent uncompressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Gzip {
    /// Minimum length of the data for compression, in bytes.
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

/// Appends frames to a buffer: a placeholder for the header, the body, and then the header with length and digest.
///
/// It reuses the state of the compressor.
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
    /// Creates an encoder without compression and with the protocol's default limit.
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

    /// Sets the compression.
    #[must_use]
    pub fn gzip(mut self, gzip: impl Into<Option<Gzip>>) -> Self {
        self.gzip = gzip.into().map(|gzip| (gzip, Deflater::new(gzip.level)));
        self
    }

    /// Sets the longest frame in bytes, header included.
    #[must_use]
    pub fn frame_bytes(mut self, limit: u32) -> Self {
        self.frame_bytes = limit;
        self
    }

    /// Appends a frame with envelope and message as its body.
    ///
    /// # Errors
    ///
    /// [`FrameError::FrameTooLong`]; `out` is unchanged.
    pub fn message<E: Message, B: Message>(
        &mut self,
        out: &mut Vec<u8>,
        id: FrameId,
        envelope: &E,
        body: &B,
    ) -> Result<(), FrameError> {
        self.frame(out, id, |out| write_enveloped(envelope, body, out))
    }

    /// Appends a frame with `data` as its body.
    ///
    /// # Errors
    ///
    /// [`FrameError::FrameTooLong`]; `out` is unchanged.
    pub fn bytes(&mut self, out: &mut Vec<u8>, id: FrameId, data: &[u8]) -> Result<(), FrameError> {
        self.frame(out, id, |out| out.extend_from_slice(data))
    }

    /// Appends a frame whose body `write` appends.
    ///
    /// # Errors
    ///
    /// [`FrameError::FrameTooLong`]; `out` is unchanged, also if `write` panics.
    pub fn frame(
        &mut self,
        out: &mut Vec<u8>,
        id: FrameId,
        write: impl FnOnce(&mut Vec<u8>),
    ) -> Result<(), FrameError> {
        let mut frame = Unfinished::new(out, P::Header::LEN);
        write(frame.out);
        let sealed = self.seal(frame.out, frame.start + P::Header::LEN)?;
        sealed.write::<P>(frame.out, frame.start, id);
        frame.finished = true;
        Ok(())
    }

    /// Appends a frame whose body `write` appends. A long frame lacks its header until it has been digested, in any
    /// pieces.
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
            let digest = DigestOf::<P>::of(frame.out.get(data).unwrap_or_default());
            sealed.with(digest).write::<P>(frame.out, start, id);
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

    /// Compresses and digests a body that can be sent any number of times.
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

    /// Compresses and digests a body in its own memory. It is copied into the send buffer later.
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

    /// Starts to prepare a long body: it is compressed but not yet digested.
    #[cfg(feature = "server")]
    pub(crate) fn begin(&mut self, mut data: Vec<u8>) -> Result<Preparing<P>, FrameError> {
        let sealed = self.pack(&mut data, 0)?;
        Ok(Preparing {
            sealed,
            data,
            digesting: Digesting::default(),
        })
    }

    /// Appends a frame with a prepared body.
    pub fn prepared(&mut self, out: &mut Vec<u8>, id: FrameId, body: &Prepared) {
        body.header::<P>(out, id);
        out.extend_from_slice(&body.data);
    }

    /// Appends a frame with a prepared response, and the keys of `envelope` after its own.
    ///
    /// # Errors
    ///
    /// [`FrameError::FrameTooLong`]; `out` is unchanged.
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
        let sealed = self.sealed(P::PLAIN, data, data)?.with(tail.digest);
        out.reserve(P::Header::LEN + data);
        sealed.append::<P>(out, id);
        out.extend_from_slice(body.text());
        out.extend_from_slice(&tail.text);
        Ok(())
    }

    /// Compresses and digests the bytes of `out` from `start` on, in place. Returns the values for the header.
    fn seal(&mut self, out: &mut Vec<u8>, start: usize) -> Result<Sealed, FrameError> {
        let sealed = self.pack(out, start)?;
        Ok(sealed.with(DigestOf::<P>::of(out.get(start..).unwrap_or_default())))
    }

    /// Compresses the bytes of `out` from `start` on, in place. Returns the values for the header without the digest.
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

    /// Returns the values for the header of a frame with this much data, without the digest.
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

/// The values of a header that depend on the data.
#[derive(Clone, Copy, Debug)]
struct Sealed {
    encoding: u8,
    total: u32,
    plain: u32,
    digest: Sum,
}

impl Sealed {
    /// Adds the digest of the data.
    fn with(self, digest: Sum) -> Self {
        Self { digest, ..self }
    }

    /// Appends the header.
    fn append<P: Protocol>(&self, out: &mut Vec<u8>, id: FrameId) {
        let start = out.len();
        out.resize(start + P::Header::LEN, 0);
        self.write::<P>(out, start, id);
    }

    /// Writes the header into its placeholder at `start`.
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

/// A compressed and digested body in the memory of its encoder.
#[cfg(feature = "client")]
#[derive(Clone, Copy)]
pub(crate) struct Staged<'a> {
    sealed: Sealed,
    data: &'a [u8],
}

#[cfg(feature = "client")]
impl Staged<'_> {
    /// Appends a frame with this body.
    pub(crate) fn append<P: Protocol>(&self, out: &mut Vec<u8>, id: FrameId) {
        out.reserve(P::Header::LEN + self.data.len());
        self.sealed.append::<P>(out, id);
        out.extend_from_slice(self.data);
    }
}

/// A compressed and digested body. Cheap to clone.
#[derive(Clone)]
pub struct Prepared {
    sealed: Sealed,
    /// Not `Arc<[u8]>`, because that would copy a map once more.
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
        self.sealed.append::<P>(out, id);
    }

    /// Returns the compressed body.
    #[cfg(any(feature = "client", feature = "server"))]
    pub(crate) fn data(&self) -> &[u8] {
        &self.data
    }

    /// Returns its length in bytes.
    #[cfg(feature = "server")]
    pub(crate) fn len(&self) -> usize {
        self.data.len()
    }
}

/// Shows only the length, because bodies may contain data that must not be logged.
impl fmt::Debug for Prepared {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Prepared({} bytes)", self.data.len())
    }
}

/// A compressed body that is digested piece by piece, with pauses for other tasks.
#[cfg(feature = "server")]
pub(crate) struct Preparing<P: Protocol> {
    sealed: Sealed,
    data: Vec<u8>,
    digesting: Digesting<DigestOf<P>>,
}

#[cfg(feature = "server")]
impl<P: Protocol> Preparing<P> {
    /// Digests up to this many further bytes. Returns `true` if some are left.
    pub(crate) fn go_on(&mut self, bytes: usize) -> bool {
        self.digesting.go_on(&self.data, bytes);
        !self.digesting.is_done(self.data.len())
    }

    /// Returns the body after all bytes have been digested.
    pub(crate) fn finish(self) -> Prepared {
        let digest = self.digesting.finish(&self.data);
        Prepared::new(self.sealed.with(digest), self.data)
    }
}

/// A frame in a buffer that lacks its header.
#[cfg(feature = "server")]
#[derive(Debug)]
pub(crate) struct Unsealed<P: Protocol> {
    id: FrameId,
    sealed: Sealed,
    /// Offset of the header.
    start: usize,
    /// Offsets of the data.
    data: Range<usize>,
    digesting: Digesting<DigestOf<P>>,
}

#[cfg(feature = "server")]
impl<P: Protocol> Unsealed<P> {
    /// Digests up to `most` further bytes of its buffer, and returns their number.
    pub(crate) fn go_on(&mut self, out: &[u8], most: usize) -> usize {
        let data = out.get(self.data.clone()).unwrap_or_default();
        self.digesting.go_on(data, most)
    }

    /// Returns `true` if all bytes have been digested.
    pub(crate) fn is_digested(&self) -> bool {
        self.digesting.is_done(self.data.len())
    }

    /// Writes the header.
    pub(crate) fn seal(self, out: &mut [u8]) {
        let digest = (self.digesting).finish(out.get(self.data).unwrap_or_default());
        let sealed = self.sealed.with(digest);
        sealed.write::<P>(out, self.start, self.id);
    }
}

/// A frame that is being written. It is removed if it is dropped unfinished.
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
