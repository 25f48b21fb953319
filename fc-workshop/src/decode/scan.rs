//! Finds the frames in a sequence of bytes, and the next frame after damaged bytes.

use fc_reflect::{Frame, FrameError, FrameFault, Reflector};
use fc_spec::model::Model;
use std::borrow::Cow;

/// Candidates for a frame inside a damaged frame that are tried.
const CANDIDATES: usize = 16;

/// Bytes of memory that a scanner keeps for the next frame.
const ROOM: usize = 4096;

/// A frame, or bytes that are none.
pub struct Piece<'b, 'm> {
    /// The position of the first byte in the input.
    pub offset: u64,
    /// The bytes of a frame. Of damaged bytes, only as many as a header has.
    pub bytes: Cow<'b, [u8]>,
    /// The number of bytes. Damaged bytes end at the next frame.
    pub length: u64,
    /// The frame or its error.
    pub frame: Result<Frame<'m>, FrameError>,
}

/// Splits bytes into pieces. It keeps at most one incomplete frame.
pub struct Scanner<'r, 'm> {
    reflector: &'r Reflector<'m>,
    heads: [&'m [u8]; 2],
    header_len: usize,
    buffer: Vec<u8>,
    /// The bytes of `buffer` before this position belong to earlier pieces.
    start: usize,
    /// The position of `start` in the input.
    offset: u64,
    damage: Option<Damage>,
    /// The number of bytes from `start` that the next step needs.
    needed: usize,
    /// Bytes that may still be read twice in search of a frame. Each input byte adds a few, so hostile input costs time
    /// in proportion to its length.
    effort: usize,
}

/// The end of a damaged frame.
enum End {
    /// After this number of bytes.
    At(usize),
    /// It can be told when there is this number of bytes.
    Later(usize),
    /// Its length is unknown.
    Unknown,
}

/// Bytes that are no frame, whose end has not been found.
struct Damage {
    offset: u64,
    error: FrameError,
    /// As many bytes as a header has.
    beginning: Vec<u8>,
    length: u64,
}

impl<'r, 'm> Scanner<'r, 'm> {
    /// Creates a scanner at the beginning of an input.
    #[must_use]
    pub fn new(reflector: &'r Reflector<'m>) -> Self {
        let model: &'m Model = reflector.model();
        Self {
            reflector,
            heads: [&model.frame.request_head, &model.frame.response_head],
            header_len: model.frame.header_len(),
            buffer: Vec::new(),
            start: 0,
            offset: 0,
            damage: None,
            needed: model.frame.header_len(),
            effort: 0,
        }
    }

    /// Adds the next bytes. Call [`next_piece`](Self::next_piece) until it returns `None`, then
    /// [`release`](Self::release), before adding more.
    pub fn push(&mut self, bytes: &[u8]) {
        self.buffer.extend_from_slice(bytes);
        self.effort = self.effort.saturating_add(bytes.len().saturating_mul(4));
    }

    /// Frees the memory of the pieces that were returned.
    pub fn release(&mut self) {
        self.buffer.drain(..self.start);
        self.start = 0;
        let room = self.buffer.len().max(ROOM);
        if self.buffer.capacity() > 2 * room {
            self.buffer.shrink_to(room);
        }
    }

    /// Returns the number of bytes of memory that the buffer takes.
    #[must_use]
    pub fn memory(&self) -> usize {
        self.buffer.capacity()
    }

    /// Returns the number of bytes of an incomplete frame.
    #[must_use]
    pub fn kept(&self) -> usize {
        self.buffer.len()
    }

    /// Continues after bytes that are missing in the input. Take all pieces with `is_end` before.
    pub fn skip(&mut self, missing: u64) {
        self.offset = self.offset.saturating_add(missing);
    }

    /// Returns the next piece, or `None` while its bytes are incomplete. With `is_end`, no more bytes follow, and an
    /// incomplete frame is an error.
    pub fn next_piece(&mut self, is_end: bool) -> Option<Piece<'_, 'm>> {
        if self.rest().is_empty() && self.damage.is_none() {
            return None;
        }
        if self.rest().len() < self.needed && !is_end {
            return None;
        }
        self.needed = self.header_len;
        if self.damage.is_some() {
            return self.search(is_end);
        }
        match self.reflector.frame(self.rest()) {
            Ok(frame) => {
                let length = frame.length;
                Some(self.take(length, Ok(frame)))
            }
            Err(error) if error.fault == FrameFault::Truncated && !is_end => {
                self.needed = self.claimed(0).unwrap_or(self.header_len);
                None
            }
            Err(error) => match self.end(&error, is_end) {
                End::At(length) => Some(self.take(length, Err(error))),
                End::Later(needed) => {
                    self.needed = needed;
                    None
                }
                End::Unknown => {
                    let rest = self.rest();
                    let beginning = rest.get(..self.header_len).unwrap_or(rest).to_vec();
                    self.damage = Some(Damage {
                        offset: self.offset,
                        error,
                        beginning,
                        length: 0,
                    });
                    self.lose(1);
                    self.search(is_end)
                }
            },
        }
    }

    fn rest(&self) -> &[u8] {
        self.buffer.get(self.start..).unwrap_or_default()
    }

    /// Returns the number of bytes up to the end of the frame that begins at a position, as far as its bytes show it.
    ///
    /// # Errors
    /// No frame begins there.
    fn claimed(&self, at: usize) -> Result<usize, FrameError> {
        let bytes = self.rest().get(at..).unwrap_or_default();
        let length = self.reflector.length(bytes)?;
        Ok(at.saturating_add(length.unwrap_or(self.header_len)))
    }

    /// Returns the end of a damaged frame. A valid frame that begins inside proves that the claimed length is wrong.
    fn end(&mut self, error: &FrameError, is_end: bool) -> End {
        if error.frame.is_none() {
            return End::Unknown;
        }
        let Ok(length) = self.claimed(0) else {
            return End::Unknown;
        };
        let mut at = 1;
        for _ in 0..CANDIDATES {
            // The bytes of this frame are read again.
            if self.effort < length {
                break;
            }
            let rest = self.rest();
            let inside = rest.get(..length).unwrap_or(rest);
            let Some(found) = self.head(inside, at) else {
                break;
            };
            let inner = rest.get(found..).unwrap_or_default();
            match self.claimed(found) {
                Ok(needed) if needed > rest.len() && !is_end => {
                    self.effort -= length;
                    return End::Later(needed);
                }
                Ok(needed) if needed <= rest.len() => {
                    let cost = needed - found;
                    if cost > self.effort {
                        break;
                    }
                    let is_frame = self.reflector.frame(inner).is_ok();
                    self.effort -= cost;
                    if is_frame {
                        self.effort = self.effort.saturating_sub(length);
                        return End::At(found);
                    }
                }
                Ok(_) | Err(_) => {}
            }
            at = found + 1;
        }
        End::At(length)
    }

    /// Returns the position of the next whole head.
    fn head(&self, bytes: &[u8], from: usize) -> Option<usize> {
        let is_head = |at: &usize| {
            let rest = bytes.get(*at..).unwrap_or_default();
            self.heads.iter().any(|head| rest.starts_with(head))
        };
        (from..bytes.len()).find(is_head)
    }

    /// Skips damaged bytes up to the next frame.
    fn search(&mut self, is_end: bool) -> Option<Piece<'_, 'm>> {
        loop {
            let rest = self.rest();
            let Some(found) = self.head(rest, 0) else {
                // The last bytes can be the beginning of a head.
                let longest = self.heads.iter().map(|head| head.len()).max();
                let kept = if is_end { 0 } else { longest.unwrap_or(1) - 1 };
                self.lose(rest.len().saturating_sub(kept));
                return if is_end { self.damaged() } else { None };
            };
            self.lose(found);
            if self.begins_frame(is_end)? {
                return self.damaged();
            }
            self.lose(1);
        }
    }

    /// Returns `true` if a frame begins here that is not obviously wrong, or `None` while that cannot be told.
    fn begins_frame(&mut self, is_end: bool) -> Option<bool> {
        let rest = self.rest();
        let Ok(length) = self.claimed(0) else {
            return Some(false);
        };
        if length > rest.len() {
            if !is_end {
                self.needed = length;
            }
            return is_end.then_some(false);
        }
        if length > self.effort {
            return Some(false);
        }
        let fault = self.reflector.frame(rest).err().map(|error| error.fault);
        self.effort -= length;
        let is_wrong = matches!(
            fault,
            Some(FrameFault::UnknownKind | FrameFault::ReservedKind | FrameFault::UnknownEncoding)
        );
        Some(!is_wrong)
    }

    /// Counts damaged bytes.
    fn lose(&mut self, count: usize) {
        self.start = self.start.saturating_add(count).min(self.buffer.len());
        self.offset = self.offset.saturating_add(count as u64);
        if let Some(damage) = &mut self.damage {
            damage.length = damage.length.saturating_add(count as u64);
        }
    }

    /// Returns the damage, which ends here.
    fn damaged(&mut self) -> Option<Piece<'static, 'm>> {
        let damage = self.damage.take()?;
        Some(Piece {
            offset: damage.offset,
            bytes: Cow::Owned(damage.beginning),
            length: damage.length,
            frame: Err(damage.error),
        })
    }

    fn take(&mut self, length: usize, frame: Result<Frame<'m>, FrameError>) -> Piece<'_, 'm> {
        let (start, offset) = (self.start, self.offset);
        self.lose(length);
        Piece {
            offset,
            bytes: Cow::Borrowed(self.buffer.get(start..self.start).unwrap_or_default()),
            length: length as u64,
            frame,
        }
    }
}
