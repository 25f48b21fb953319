//! Unknown keys that are kept.

use super::scan::plain_run;
use super::{Allowance, BodyError, Json, JsonRef, Reader, Writer};
use std::borrow::Cow;
use std::fmt;

/// The unknown keys of an object in the order received, with duplicates.
///
/// They are kept as one text of about the received length. Values keep their exact text; keys are written with only the
/// escapes that JSON requires. A lookup scans the text.
///
/// Two values are equal if keys, texts of values and their order are equal.
#[derive(Clone, Default, PartialEq, Eq, Hash)]
pub struct Extra {
    /// The members in written form, each with a leading comma: `,"a":1,"b":[2]`.
    text: String,
}

impl Extra {
    /// Creates an empty set of keys.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            text: String::new(),
        }
    }

    /// Returns keys and values in order.
    pub fn iter(&self) -> impl Iterator<Item = (Cow<'_, str>, JsonRef<'_>)> {
        self.members().map(|member| (member.key, member.value))
    }

    /// Returns the value of a key. If the key occurs more than once, returns the last value.
    #[must_use]
    pub fn get(&self, key: &str) -> Option<JsonRef<'_>> {
        let found = self.members().filter(|member| member.key == key).last();
        found.map(|member| member.value)
    }

    /// Sets a key and drops all its former values. Set known keys in their fields instead; here they would be sent
    /// twice.
    #[allow(
        clippy::needless_pass_by_value,
        reason = "a value belongs to the message that it is set in"
    )]
    pub fn insert(&mut self, key: impl AsRef<str>, value: Json) {
        let key = key.as_ref();
        if !self.members().any(|member| member.key == key) {
            self.append(key, value.as_str());
            return;
        }
        let mut changed = Self::new();
        let mut set = false;
        for member in self.members() {
            if member.key != key {
                changed.text.push_str(member.text);
            } else if !set {
                changed.append(key, value.as_str());
                set = true;
            }
        }
        *self = changed;
    }

    /// Returns `true` if there are no keys.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.text.is_empty()
    }

    /// Returns the number of keys. Scans the text.
    #[must_use]
    pub fn len(&self) -> usize {
        self.members().count()
    }

    /// Reads and keeps the value of an unknown key. Derived messages call it.
    ///
    /// # Errors
    /// The error of the value.
    pub fn keep(&mut self, key: &str, reader: &mut Reader<'_>) -> Result<(), BodyError> {
        let value = reader.value_text()?;
        let needed = key.len() + value.len() + PUNCTUATION;
        reader.grow(&mut self.text, needed);
        self.append(key, value);
        Ok(())
    }

    /// Returns the members in written form.
    pub(super) fn text(&self) -> &str {
        &self.text
    }

    fn append(&mut self, key: &str, value: &str) {
        self.text.push(',');
        if plain_run(key.as_bytes()) == key.len() {
            self.text.push('"');
            self.text.push_str(key);
            self.text.push('"');
        } else {
            let mut quoted = Vec::new();
            Writer::new(&mut quoted).string(key);
            self.text.push_str(&String::from_utf8_lossy(&quoted));
        }
        self.text.push(':');
        self.text.push_str(value);
    }

    fn members(&self) -> Members<'_> {
        Members(Reader::new(&self.text, Allowance::ANY))
    }
}

/// Bytes of a member besides its key and value.
const PUNCTUATION: usize = ",\"\":".len();

/// One key and its value.
struct Member<'a> {
    key: Cow<'a, str>,
    value: JsonRef<'a>,
    /// Key and value with the leading comma.
    text: &'a str,
}

/// The unread part of the text.
struct Members<'a>(Reader<'a>);

impl<'a> Iterator for Members<'a> {
    type Item = Member<'a>;

    fn next(&mut self) -> Option<Member<'a>> {
        let reader = &mut self.0;
        let start = reader.offset();
        // The only possible end is the end of the text, because all kept members have been read before.
        if !reader.take(",") {
            return None;
        }
        let key = reader.key().ok()?;
        let value = JsonRef(reader.value_text().ok()?);
        Some(Member {
            key,
            value,
            text: reader.since(start),
        })
    }
}

impl fmt::Debug for Extra {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_map().entries(self.iter()).finish()
    }
}
