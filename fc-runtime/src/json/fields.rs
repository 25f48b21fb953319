//! Fields of objects, found in their order or looked up in any other order.
//!
//! A message names its fields to the reader ([`Message::read_fields`]) again and again until the object is read. The
//! reader compares each name with the text at its position. If all keys come in their usual order and spelling, it
//! needs nothing else. Otherwise the reader stops: it moves to the end of the text, where no name matches, and
//! [`ReaderState`] specifies the purpose of the names.

use super::reader_state::ReaderState;
use super::{Allowance, BodyError, BodyErrorKind, Extra, Form, FromJson, Plain, Reader};
use crate::message::Message;
use std::borrow::Cow;
use std::mem;

/// The fields of a message without its type, so that the loops over keys are compiled once and not for every message.
pub(super) trait Fields {
    fn read(&mut self, reader: &mut Reader<'_>);
}

/// The slots of a message.
pub(super) struct FieldsOf<'s, M: Message>(pub(super) &'s mut M::Slots);

impl<M: Message> Fields for FieldsOf<'_, M> {
    fn read(&mut self, reader: &mut Reader<'_>) {
        M::read_fields(self.0, reader);
    }
}

/// Returns the names of required fields of a message that are not among these keys.
pub type Lacking = fn(&[Cow<'_, str>]) -> Vec<&'static str>;

/// Returns the names of a message's required fields, such as `"stationId":`, that are not among these keys.
#[must_use]
pub fn lacking<M: Message>(present: &[Cow<'_, str>]) -> Vec<&'static str> {
    lacking_of(present, &mut FieldsOf::<M>(&mut M::slots()))
}

fn lacking_of(present: &[Cow<'_, str>], fields: &mut dyn Fields) -> Vec<&'static str> {
    let mut reader = Reader::new("", Allowance::depth(0));
    reader.state = ReaderState::LackingKeys {
        present,
        lacking: Vec::new(),
    };
    fields.read(&mut reader);
    match reader.state {
        ReaderState::LackingKeys { lacking, .. } => lacking,
        _ => Vec::new(),
    }
}

/// Returns `true` if a field's name, such as `"stationId":`, is the name of `key`.
#[allow(
    clippy::ptr_arg,
    reason = "a key with escapes is owned, and compared otherwise"
)]
fn names(name: &str, key: &Cow<'_, str>) -> bool {
    match key {
        // A borrowed key has no escapes, so it is compared as sent.
        Cow::Borrowed(key) => plain(name) == *key,
        Cow::Owned(key) => read_name(name) == *key,
    }
}

fn plain(name: &str) -> &str {
    name.get(1..name.len().saturating_sub(2))
        .unwrap_or_default()
}

/// Returns the key of a field's name.
pub(super) fn read_name(name: &str) -> String {
    let key = Reader::new(name, Allowance::depth(0)).string();
    key.map(Cow::into_owned).unwrap_or_default()
}

/// Creates a message from its slots after the object at `start` of `text` has been read.
pub(super) fn finish<M: Message>(
    slots: M::Slots,
    text: &str,
    start: usize,
) -> Result<M, BodyError> {
    let Some(message) = M::finish(slots) else {
        return Err(incomplete(text, start, lacking::<M>));
    };
    match message.check_own() {
        Ok(()) => Ok(message),
        Err(error) => Err(error.at(start)),
    }
}

/// Returns the error of an object without a required key.
#[cold]
fn incomplete(text: &str, start: usize, lacking: Lacking) -> BodyError {
    // The text has already been read within its allowance.
    let mut reader = Reader::new(text, Allowance::ANY);
    reader.at = start;
    match reader.required_keys(&[lacking]) {
        Ok(present) => {
            let first = lacking(&present).first().map(|name| read_name(name));
            BodyError::missing(&first.unwrap_or_default()).at(start)
        }
        Err(error) => error,
    }
}

/// Field names of a message.
///
/// A name is the text before the value: `"stationId":`.
impl<'a> Reader<'a> {
    /// Reads a field if it comes next.
    // Inlined in optimized builds, where a comparison with a constant name is fast. In other builds it would only be
    // compiled at every field.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn field<T: FromJson>(&mut self, name: &'static str, slot: &mut Option<T>) {
        if self.take(name) {
            self.rest_of_field::<Plain, T>(slot);
        } else if self.rest().is_empty() {
            self.stopped_field::<Plain, T>(&[name], slot);
        }
    }

    /// Reads a field with one or several names in the form `F`, as [`field`](Self::field) does.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn field_as<F: Form<T>, T: FromJson>(
        &mut self,
        names: &[&'static str],
        slot: &mut Option<T>,
    ) {
        if names.iter().any(|name| self.take(name)) {
            self.rest_of_field::<F, T>(slot);
        } else if self.rest().is_empty() {
            self.stopped_field::<F, T>(names, slot);
        }
    }

    /// Reads a value and the text after it, up to the next key.
    fn rest_of_field<F: Form<T>, T>(&mut self, slot: &mut Option<T>) {
        if slot.is_some() {
            return self.came_before();
        }
        let end = match self.count(1).and_then(|()| F::read(self)) {
            Ok(value) => {
                *slot = Some(value);
                self.end_value()
            }
            Err(error) => Err(error),
        };
        if let Err(error) = end {
            self.fail(error);
        }
    }

    #[cold]
    fn stopped_field<F: Form<T>, T: FromJson>(
        &mut self,
        names: &[&'static str],
        slot: &mut Option<T>,
    ) {
        if self.claim(names, T::OPTIONAL) {
            self.rest_of_field::<F, T>(slot);
        }
    }

    /// Answers for a field the question of the reader's state. Returns `true` if the value must be read now.
    fn claim(&mut self, known: &[&'static str], optional: bool) -> bool {
        match &mut self.state {
            ReaderState::KeySearch { key, value, .. }
                if known.iter().any(|name| names(name, key)) =>
            {
                self.at = *value;
                self.state = ReaderState::Reading;
                true
            }
            ReaderState::LackingKeys { present, lacking } => {
                let mut known = known.iter();
                let is_present = |name: &&str| present.iter().any(|key| names(name, key));
                if !optional && !known.clone().any(is_present) {
                    lacking.extend(known.next());
                }
                false
            }
            _ => false,
        }
    }

    /// Names the field that keeps unknown keys.
    pub fn extra(&mut self, extra: &mut Extra) {
        if let ReaderState::KeySearch {
            keep: true, value, ..
        } = self.state
            && let ReaderState::KeySearch { key, .. } =
                mem::replace(&mut self.state, ReaderState::Reading)
        {
            self.at = value;
            let kept = self.count(1).and_then(|()| extra.keep(&key, self));
            let end = kept.and_then(|()| self.end_value());
            if let Err(error) = end {
                self.fail(error);
            }
        }
    }

    /// Ends the reading at a repeated key.
    #[cold]
    fn came_before(&mut self) {
        self.peek();
        let fault = self.fault(
            BodyErrorKind::DuplicateKey,
            "the key came before; send it once",
        );
        self.fail(fault);
    }

    #[cold]
    fn fail(&mut self, error: BodyError) {
        self.state = ReaderState::Failed(error);
        self.at = self.text.len();
    }

    /// Returns the error of a value after the fields have been named.
    #[inline]
    fn fields_read(&mut self) -> Result<(), BodyError> {
        if !matches!(self.state, ReaderState::Failed(_)) {
            return Ok(());
        }
        match mem::replace(&mut self.state, ReaderState::Reading) {
            ReaderState::Failed(error) => Err(error),
            _ => Ok(()),
        }
    }

    /// Reads a key and stops, to find the field with this name.
    fn ask(&mut self, keep: bool) -> Result<(), BodyError> {
        let key = self.key()?;
        self.state = ReaderState::KeySearch {
            key,
            value: self.at,
            keep,
        };
        self.at = self.text.len();
        Ok(())
    }

    /// Skips the value of a key that no field has claimed.
    fn skip_unclaimed(&mut self) -> Result<(), BodyError> {
        let ReaderState::KeySearch { value, .. } = self.state else {
            return Ok(());
        };
        self.state = ReaderState::Reading;
        self.at = value;
        self.count(1)?;
        self.skip_value()?;
        self.end_value()
    }

    /// Reads an object as a message.
    pub(crate) fn message<M: Message>(&mut self) -> Result<M, BodyError> {
        let mut slots = M::slots();
        match self.object(&mut FieldsOf::<M>(&mut slots)) {
            Ok(start) => finish(slots, self.text, start),
            Err(error) => Err(error),
        }
    }

    /// Reads an object and returns its keys that some of these messages require, each once. So the number of returned
    /// keys is small, however many the object has.
    pub(super) fn required_keys(
        &mut self,
        messages: &[Lacking],
    ) -> Result<Vec<Cow<'a, str>>, BodyError> {
        let required = |lacking: &Lacking, key: &Cow<'a, str>| {
            lacking(std::slice::from_ref(key)).len() < lacking(&[]).len()
        };
        let mut keys = Vec::new();
        self.begin_object()?;
        while !self.end_object() {
            let key = self.key()?;
            if !keys.contains(&key) && messages.iter().any(|lacking| required(lacking, &key)) {
                keys.push(key);
            }
            self.count(1)?;
            self.skip_value()?;
            self.end_value()?;
        }
        Ok(keys)
    }

    /// Reads an object into fields. Returns the offset of its opening brace.
    pub(super) fn object(&mut self, fields: &mut dyn Fields) -> Result<usize, BodyError> {
        let start = self.begin_object()?;
        loop {
            let before = self.at;
            fields.read(self);
            self.fields_read()?;
            if self.end_object() {
                return Ok(start);
            }
            if self.at == before {
                self.ask(true)?;
                fields.read(self);
                self.fields_read()?;
                self.skip_unclaimed()?;
            }
        }
    }

    /// Reads a whole text, which must be an object, into the fields of an envelope and of a body.
    pub(super) fn fill_both(
        &mut self,
        envelope: &mut dyn Fields,
        body: &mut dyn Fields,
    ) -> Result<usize, Failed> {
        use Failed::{Body, Envelope};

        self.expect_object().map_err(Envelope)?;
        let start = self.begin_object().map_err(Envelope)?;
        loop {
            let before = self.at;
            envelope.read(self);
            self.fields_read().map_err(Envelope)?;
            body.read(self);
            self.fields_read().map_err(Body)?;
            if self.end_object() {
                break;
            }
            if self.at == before {
                self.ask(false).map_err(Envelope)?;
                envelope.read(self);
                self.fields_read().map_err(Envelope)?;
                if let ReaderState::KeySearch { keep, .. } = &mut self.state {
                    *keep = true;
                }
                body.read(self);
                self.fields_read().map_err(Body)?;
                self.skip_unclaimed().map_err(Envelope)?;
            }
        }
        self.end().map_err(Envelope)?;
        Ok(start)
    }
}

/// The half of a message that could not be read.
pub(super) enum Failed {
    Envelope(BodyError),
    Body(BodyError),
}
