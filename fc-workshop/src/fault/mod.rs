//! Faults of a network or a peer, injected into the frames of one direction of a connection.
//!
//! It does no I/O, and the same seed gives the same faults for the same frames.

mod change;
mod read;

use crate::arguments::json;
use crate::facts;
use crate::stream::Piece;
use fc_reflect::{Direction, Frame, FrameId, Packing, Reflector};
use fc_spec::model::{EncodingRole, HeaderRole, KindRole, Value};
use std::num::NonZeroU32;
use std::time::Duration;

/// A fault, and the frames that it concerns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// The fault.
    pub kind: FaultKind,
    /// Only frames with this code; `None` for all.
    pub code: Option<u16>,
    /// The choice among the frames that fit.
    pub when: When,
}

/// The kind of a fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FaultKind {
    /// A frame arrives later.
    Delay(Duration),
    /// The acknowledgement of a report is lost.
    DropAcknowledgement,
    /// The response to a command arrives twice.
    DuplicateResponse,
    /// The response to a command has the message id of no call.
    WrongId,
    /// The connection ends inside a frame.
    Cut,
    /// The digest of a frame is wrong.
    BadDigest,
    /// A frame arrives with this number of bytes per second.
    Slow(NonZeroU32),
    /// A message has a key that the spec lacks.
    UnknownKey,
    /// An enum of a message has a value that the spec lacks.
    UnknownValue,
    /// The data of a frame is compressed.
    Compress,
}

impl FaultKind {
    /// The kinds without a value.
    pub const PLAIN: [Self; 8] = [
        Self::DropAcknowledgement,
        Self::DuplicateResponse,
        Self::WrongId,
        Self::Cut,
        Self::BadDigest,
        Self::UnknownKey,
        Self::UnknownValue,
        Self::Compress,
    ];

    /// Returns the name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Delay(_) => "delay",
            Self::DropAcknowledgement => "drop-acknowledgement",
            Self::DuplicateResponse => "duplicate-response",
            Self::WrongId => "wrong-id",
            Self::Cut => "cut",
            Self::BadDigest => "bad-digest",
            Self::Slow(_) => "slow",
            Self::UnknownKey => "unknown-key",
            Self::UnknownValue => "unknown-value",
            Self::Compress => "compress",
        }
    }
}

/// The choice among the frames that a fault concerns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum When {
    /// All of them.
    Always,
    /// Each with this chance in percent.
    Chance(u8),
    /// Each with a number that this number divides.
    Every(NonZeroU32),
    /// The one with this number, from 1.
    Only(NonZeroU32),
    /// Those after this number.
    After(u32),
}

/// A frame as it arrives.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Delivery {
    /// Time before the first byte.
    pub delay: Duration,
    /// The bytes; empty if the frame is lost.
    pub bytes: Vec<u8>,
    /// Bytes per second; `None` for all at once.
    pub rate: Option<NonZeroU32>,
    /// `true` if the connection ends after the bytes.
    pub ends: bool,
    /// The faults in it.
    pub faults: Vec<FaultKind>,
}

/// Returns any seed.
#[must_use]
pub fn any_seed() -> u64 {
    fastrand::u64(..)
}

/// The faults of one direction of a connection.
pub struct Faults<'r, 'm> {
    reflector: &'r Reflector<'m>,
    /// Each fault with the number of frames that it has concerned.
    list: Vec<(Fault, u32)>,
    random: fastrand::Rng,
}

impl<'r, 'm> Faults<'r, 'm> {
    /// Creates the faults of one direction. `stream` tells the directions of all connections apart, which then have
    /// different chances.
    #[must_use]
    pub fn new(reflector: &'r Reflector<'m>, faults: &[Fault], seed: u64, stream: u64) -> Self {
        let mut random = fastrand::Rng::with_seed(seed);
        let seed = random.u64(..) ^ stream;
        Self {
            reflector,
            list: faults.iter().map(|fault| (fault.clone(), 0)).collect(),
            random: fastrand::Rng::with_seed(seed),
        }
    }

    /// Returns the frame as it arrives. A frame with an error is delivered unchanged.
    pub fn deliver(&mut self, piece: &Piece<'m>) -> Delivery {
        let mut delivery = Delivery {
            delay: Duration::ZERO,
            bytes: piece.bytes.clone(),
            rate: None,
            ends: false,
            faults: Vec::new(),
        };
        let Ok(frame) = &piece.frame else {
            return delivery;
        };
        let mut draft = Draft::of(frame);
        for index in 0..self.list.len() {
            let Some(kind) = self.next(index, frame) else {
                continue;
            };
            if self.apply(kind, frame, &mut draft, &mut delivery) {
                delivery.faults.push(kind);
            }
        }
        self.finish(&draft, &mut delivery);
        delivery
    }

    /// Returns the kind of a fault if it strikes this frame.
    fn next(&mut self, index: usize, frame: &Frame<'_>) -> Option<FaultKind> {
        let (fault, count) = self.list.get_mut(index)?;
        let has_code = fault.code.is_none_or(|code| code == frame.id.code);
        if !has_code || !concerns(self.reflector, fault.kind, frame) {
            return None;
        }
        *count = count.saturating_add(1);
        let strikes = match fault.when {
            When::Always => true,
            When::Chance(percent) => self.random.u8(0..100) < percent,
            When::Every(number) => *count % number == 0,
            When::Only(number) => *count == number.get(),
            When::After(number) => *count > number,
        };
        strikes.then_some(fault.kind)
    }

    /// Applies a fault. Returns `false` if it has no effect on this frame.
    fn apply(
        &mut self,
        kind: FaultKind,
        frame: &Frame<'m>,
        draft: &mut Draft,
        delivery: &mut Delivery,
    ) -> bool {
        match kind {
            FaultKind::Delay(delay) => delivery.delay += delay,
            FaultKind::Slow(rate) => delivery.rate = Some(rate),
            FaultKind::DropAcknowledgement => draft.copies = 0,
            FaultKind::DuplicateResponse => draft.copies = 2,
            FaultKind::WrongId => {
                draft.id.id ^= facts::rules(self.reflector.model()).id_max;
                draft.is_changed = true;
            }
            FaultKind::Cut => delivery.ends = true,
            FaultKind::BadDigest => draft.is_damaged = true,
            FaultKind::Compress => {
                draft.packing = GZIP;
                draft.is_changed = true;
            }
            FaultKind::UnknownKey => return draft.change(change::unknown_key),
            FaultKind::UnknownValue => {
                let Self {
                    reflector, random, ..
                } = self;
                return draft.change(|body| {
                    change::unknown_value(reflector, frame, body, |count| random.usize(0..count))
                });
            }
        }
        true
    }

    /// Writes the changed frame.
    fn finish(&self, draft: &Draft, delivery: &mut Delivery) {
        if draft.is_changed {
            match self.reflector.seal(draft.id, &draft.data, draft.packing) {
                Ok(bytes) => delivery.bytes = bytes,
                // The fault makes the frame too long: it is delivered unchanged.
                Err(_) => delivery.faults.clear(),
            }
        }
        if draft.is_damaged {
            let digest = HeaderRole::Digest;
            self.reflector.overwrite(&mut delivery.bytes, digest, 0xBAD);
        }
        delivery.bytes = delivery.bytes.repeat(draft.copies);
        if delivery.ends {
            delivery.bytes.truncate(delivery.bytes.len() / 2);
        }
    }
}

/// The packing of compressed data.
const GZIP: Packing = Packing::Gzip { level: 6 };

/// A frame that is being changed.
struct Draft {
    id: FrameId,
    data: Vec<u8>,
    packing: Packing,
    copies: usize,
    /// `true` if its bytes must be written again.
    is_changed: bool,
    /// `true` if its digest must be wrong.
    is_damaged: bool,
}

impl Draft {
    fn of(frame: &Frame<'_>) -> Self {
        let is_packed = frame
            .encoding
            .is_some_and(|it| it.role == EncodingRole::Gzip);
        Self {
            id: frame.id,
            data: frame.data.clone(),
            packing: if is_packed { GZIP } else { Packing::Plain },
            copies: 1,
            is_changed: false,
            is_damaged: false,
        }
    }

    /// Changes the JSON of the data. Returns `false` if that is not possible.
    fn change(&mut self, change: impl FnOnce(&mut Value) -> bool) -> bool {
        let text = std::str::from_utf8(&self.data).ok();
        let Some(mut body) = text.and_then(json) else {
            return false;
        };
        if !change(&mut body) {
            return false;
        }
        self.data = body.to_string().into_bytes();
        self.is_changed = true;
        true
    }
}

/// Returns `true` if a kind of fault can strike a frame.
fn concerns(reflector: &Reflector<'_>, kind: FaultKind, frame: &Frame<'_>) -> bool {
    let is_response = frame.id.direction == Direction::Response;
    let role = frame.kind.role;
    match kind {
        FaultKind::Delay(_) | FaultKind::Slow(_) | FaultKind::Cut => true,
        FaultKind::DropAcknowledgement => is_response && role == KindRole::Report,
        FaultKind::DuplicateResponse | FaultKind::WrongId => {
            is_response && role == KindRole::Command
        }
        FaultKind::BadDigest => frame.field(HeaderRole::Digest).is_some(),
        FaultKind::UnknownKey | FaultKind::UnknownValue => frame.is_json(),
        FaultKind::Compress => {
            let mut encodings = reflector.model().frame.encodings.iter();
            encodings.any(|encoding| encoding.role == EncodingRole::Gzip)
        }
    }
}
