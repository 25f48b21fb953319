//! Keys that are carried along without being known.

use super::scan::plain_run;
use super::{Allowance, BodyError, Json, JsonRef, Reader, Writer};
use std::borrow::Cow;
use std::fmt;

/// The keys of an object that its type does not know, in the order in which they came, with
/// duplicates.
///
/// They are kept as one text, so that they cost about as many bytes as they were sent with, however
/// many they are. Values keep their exact text; keys are written as the runtime writes them, with no
/// more escapes than JSON requires. To look one up takes a pass over the text.
///
/// Equality is equality of keys, of the texts of their values, and of their order.
#[derive(Clone, Default, PartialEq, Eq, Hash)]
pub struct Extra {
    /// The members as they are written, each with a comma in front: `,"a":1,"b":[2]`.
    text: String,
}

impl Extra {
    /// No keys.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            text: String::new(),
        }
    }

    /// Keys and values in order.
    pub fn iter(&self) -> impl Iterator<Item = (Cow<'_, str>, JsonRef<'_>)> {
        self.members().map(|member| (member.key, member.value))
    }

    /// The value of a key; of its last occurrence if it came more than once.
    #[must_use]
    pub fn get(&self, key: &str) -> Option<JsonRef<'_>> {
        let found = self.members().filter(|member| member.key == key).last();
        found.map(|member| member.value)
    }

    /// Sets a key, in place of all its former values, which are dropped. A key of the message's own
    /// belongs into its field: here it would be sent twice.
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

    /// Whether there are no keys.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.text.is_empty()
    }

    /// Number of keys. Takes a pass over the text.
    #[must_use]
    pub fn len(&self) -> usize {
        self.members().count()
    }

    /// Reads the value of an unknown key and keeps it. Derived messages call it.
    ///
    /// # Errors
    /// What is wrong with the JSON.
    pub fn keep(&mut self, key: &str, reader: &mut Reader<'_>) -> Result<(), BodyError> {
        let value = reader.value_text()?;
        let needed = key.len() + value.len() + PUNCTUATION;
        reader.grow(&mut self.text, needed);
        self.append(key, value);
        Ok(())
    }

    /// The members as they are written into an object.
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

/// Bytes of a member beside its key and value.
const PUNCTUATION: usize = ",\"\":".len();

/// One key and its value.
struct Member<'a> {
    key: Cow<'a, str>,
    value: JsonRef<'a>,
    /// Both, with the comma in front.
    text: &'a str,
}

/// What is still to be read of the text.
struct Members<'a>(Reader<'a>);

impl<'a> Iterator for Members<'a> {
    type Item = Member<'a>;

    fn next(&mut self) -> Option<Member<'a>> {
        let reader = &mut self.0;
        let start = reader.offset();
        // Nothing but the end can be met: only what has been read is kept.
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
