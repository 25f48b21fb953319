//! The patterns of names, codes, dates and other words of a spec.
//!
//! The loader applies the patterns to the YAML, and [`Dump::read`](crate::model::Dump::read) applies them to a dump.

use serde::de::Error as _;
use serde::{Deserialize, Deserializer};

/// Returns `true` for a `snake_case` name.
///
/// Its parts consist of lower-case letters and digits, are joined by single underscores, and start with a letter.
pub(crate) fn is_snake(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_lowercase())
        && name.split('_').all(|part| {
            !part.is_empty()
                && part
                    .chars()
                    .all(|c| c.is_ascii_lowercase() || c.is_ascii_digit())
        })
}

/// Returns `true` for a `PascalCase` name: ASCII letters and digits, starting with an upper-case letter.
pub(crate) fn is_pascal(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_uppercase())
        && name.chars().all(|c| c.is_ascii_alphanumeric())
}

/// Returns `true` for a name that Windows reserves for a device, in any case.
pub(crate) fn is_device(name: &str) -> bool {
    let name = name.to_ascii_lowercase();
    let numbered = ["com", "lpt"]
        .iter()
        .find_map(|device| name.strip_prefix(device));
    let is_numbered = numbered.is_some_and(|digit| matches!(digit.as_bytes(), [b'0'..=b'9']));
    is_numbered || matches!(&*name, "aux" | "con" | "nul" | "prn")
}

/// Returns `true` for a character that is invisible or changes the display of the following text, except newlines and tabs.
#[must_use]
pub const fn is_hidden(character: char) -> bool {
    matches!(
        character,
        '\0'..='\u{8}'
            | '\u{B}'..='\u{1F}'
            | '\u{7F}'..='\u{9F}'
            | '\u{61C}'
            | '\u{200B}'
            | '\u{200E}'
            | '\u{200F}'
            | '\u{2028}'..='\u{202E}'
            | '\u{2060}'..='\u{206F}'
            | '\u{FDD0}'..='\u{FDEF}'
            | '\u{FEFF}'
            | '\u{FFF9}'..='\u{FFFB}'
            | '\u{FFFE}'
            | '\u{FFFF}'
            | '\u{E0000}'..='\u{E007F}'
    )
}

/// Returns `true` for text with a control or hidden character. The bytes alone decide most texts.
#[must_use]
#[allow(
    clippy::needless_bitwise_bool,
    reason = "without branches it becomes vector instructions"
)]
pub fn has_unprintable(text: &str) -> bool {
    // The first bytes of all such characters, and of some others.
    let is_suspect = text.bytes().fold(false, |found, byte| {
        let is_ascii = (byte < 0x20) | (byte == 0x7F);
        let is_lead =
            (byte == 0xC2) | (byte == 0xD8) | (byte == 0xE2) | (byte == 0xEF) | (byte == 0xF3);
        found | is_ascii | is_lead
    });
    is_suspect && text.contains(|c: char| c.is_control() || is_hidden(c))
}

/// Returns `true` for one line of visible characters.
pub(crate) fn is_line(word: &str) -> bool {
    !word.contains(|c| matches!(c, '\n' | '\t') || is_hidden(c))
}

/// Returns `true` for a path of a file or of keys. Comments show such a path as code.
fn is_place(place: &str) -> bool {
    is_line(place) && !place.contains(['`', '*', '<'])
}

/// Returns the `snake_case` of a wire name: `robotSn` becomes `robot_sn`, `HTTPPort` `http_port`, `MD5` `md5`.
///
/// Characters that no name can contain separate its parts. The result is not always a valid name.
pub(crate) fn snake(wire: &str) -> String {
    let mut out = String::with_capacity(wire.len() + 4);
    let mut last: Option<char> = None;
    let mut characters = wire.chars().peekable();
    while let Some(character) = characters.next() {
        let before = last.replace(character);
        if !character.is_ascii_alphanumeric() {
            if !out.is_empty() && !out.ends_with('_') {
                out.push('_');
            }
            continue;
        }
        let after = characters.peek();
        let starts_word = character.is_ascii_uppercase()
            && before.is_some_and(|before| {
                before.is_ascii_lowercase()
                    || before.is_ascii_digit()
                    || (before.is_ascii_uppercase() && after.is_some_and(char::is_ascii_lowercase))
            });
        if starts_word && !out.ends_with('_') {
            out.push('_');
        }
        out.push(character.to_ascii_lowercase());
    }
    out.truncate(out.trim_end_matches('_').len());
    out
}

/// Returns the `PascalCase` of a `snake_case` name: `get_station` becomes `GetStation`.
pub(crate) fn pascal(name: &str) -> String {
    let mut out = String::with_capacity(name.len());
    for part in name.split('_') {
        let mut characters = part.chars();
        if let Some(first) = characters.next() {
            out.push(first.to_ascii_uppercase());
            out.push_str(characters.as_str());
        }
    }
    out
}

/// Returns the number of a code in its only spelling: `0x` and four upper-case hex digits.
pub(crate) fn code(text: &str) -> Option<u16> {
    let digits = text.strip_prefix("0x")?;
    let well_formed = digits.len() == 4
        && digits
            .bytes()
            .all(|b| b.is_ascii_digit() || (b'A'..=b'F').contains(&b));
    well_formed
        .then(|| u16::from_str_radix(digits, 16).ok())
        .flatten()
}

/// Returns the year, month and day of `YYYY-MM` or `YYYY-MM-DD`. The day is 0 if it is missing.
pub(crate) fn date(text: &str) -> Option<(u16, u8, u8)> {
    let mut parts = text.split('-');
    let mut part = |length: usize| {
        let digits = parts.next()?;
        let well_formed = digits.len() == length && digits.bytes().all(|b| b.is_ascii_digit());
        Some(well_formed.then_some(digits))
    };
    let year: u16 = part(4)??.parse().ok()?;
    let month: u8 = part(2)??.parse().ok()?;
    let day: u8 = match part(2) {
        Some(digits) => digits?.parse().ok().filter(|day| *day > 0)?,
        None => 0,
    };
    let well_formed =
        parts.next().is_none() && (1..=12).contains(&month) && day <= days(year, month);
    well_formed.then_some((year, month, day))
}

fn days(year: u16, month: u8) -> u8 {
    let leap = year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400));
    match month {
        2 if leap => 29,
        2 => 28,
        4 | 6 | 9 | 11 => 30,
        _ => 31,
    }
}

/// Returns `true` for the id of a conflict: `C` and at least three digits.
pub(crate) fn is_conflict_id(text: &str) -> bool {
    text.strip_prefix('C')
        .is_some_and(|digits| digits.len() >= 3 && digits.bytes().all(|b| b.is_ascii_digit()))
}

/// Returns `true` for a media type in lower case, without parameters.
pub(crate) fn is_media_type(text: &str) -> bool {
    let is_name = |name: &str| {
        let inside = |b: u8| b.is_ascii_lowercase() || b.is_ascii_digit();
        name.starts_with(|first: char| first.is_ascii() && inside(first as u8))
            && name.bytes().all(|b| inside(b) || b"!#$&^_.+-".contains(&b))
    };
    text.split_once('/')
        .is_some_and(|(ty, subtype)| is_name(ty) && is_name(subtype))
}

/// Defines functions for `deserialize_with`. Each refuses words that do not match the pattern of their kind.
macro_rules! readers {
    ($($(#[$doc:meta])* $name:ident, $fits:expr, $wanted:literal;)+) => { $(
        $(#[$doc])*
        pub(crate) fn $name<'de, D, T>(deserializer: D) -> Result<T, D::Error>
        where
            D: Deserializer<'de>,
            T: Deserialize<'de> + Words,
        {
            let words = T::deserialize(deserializer)?;
            if let Some(word) = words.words().find(|word| !$fits(word)) {
                let message = format_args!("{word:?} is not {}", $wanted);
                return Err(D::Error::custom(message));
            }
            Ok(words)
        }
    )+ };
}

readers! {
    /// Reads names in code.
    read_snake, is_snake, "a name in snake_case";
    /// Reads names of types.
    read_pascal, is_pascal, "a type name in PascalCase";
    /// Reads dates.
    read_date, |word: &str| date(word).is_some(), "a date such as 2024-01 or 2024-01-31";
    /// Reads the spelling of codes.
    read_code, |word: &str| word == "unassigned" || code(word).is_some(), "a code of `0x` and four hex digits";
    /// Reads texts for people.
    read_text, |text: &str| !text.contains(is_hidden), "a text of visible characters";
    /// Reads wire keys and other words of one line.
    read_line, is_line, "one line of visible characters";
    /// Reads places in files.
    read_place, is_place, "a place in a file";
    /// Reads ids of conflicts.
    read_conflict_id, is_conflict_id, "an id such as C040";
    /// Reads media types.
    read_media_type, is_media_type, "a media type such as image/png";
}

/// The words in a value of a dump.
pub(crate) trait Words {
    /// Returns all words.
    fn words(&self) -> impl Iterator<Item = &str>;
}

impl Words for String {
    fn words(&self) -> impl Iterator<Item = &str> {
        std::iter::once(self.as_str())
    }
}

impl Words for Option<String> {
    fn words(&self) -> impl Iterator<Item = &str> {
        self.as_deref().into_iter()
    }
}

impl Words for Vec<String> {
    fn words(&self) -> impl Iterator<Item = &str> {
        self.iter().map(String::as_str)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wire_names_become_snake_case() {
        for (wire, expected) in [
            ("robotSn", "robot_sn"),
            ("cmdTime", "cmd_time"),
            ("MD5", "md5"),
            ("GZipDataLength", "g_zip_data_length"),
            ("HTTPPort", "http_port"),
            ("upper_status", "upper_status"),
            ("x", "x"),
            ("door1Open", "door1_open"),
            ("robotSN", "robot_sn"),
            ("a-b.c", "a_b_c"),
            ("_id", "id"),
            ("2d", "2d"),
            ("状态", ""),
        ] {
            assert_eq!(snake(wire), expected, "{wire}");
        }
    }

    #[test]
    fn snake_names_become_pascal_case() {
        for (name, expected) in [
            ("get_station", "GetStation"),
            ("switch_0a08", "Switch0a08"),
            ("x", "X"),
        ] {
            assert_eq!(pascal(name), expected);
        }
    }

    #[test]
    fn well_formed_names() {
        for name in ["x", "get_robot_sn", "switch_0a08", "md5"] {
            assert!(is_snake(name), "{name}");
        }
        for name in ["", "X", "get__x", "_x", "x_", "0x", "get-x", "站点"] {
            assert!(!is_snake(name), "{name}");
        }
        for name in ["X", "Station", "Station2"] {
            assert!(is_pascal(name), "{name}");
        }
        for name in ["", "station", "Get_Station", "2D", "站点"] {
            assert!(!is_pascal(name), "{name}");
        }
        for name in ["aux", "Con", "com1", "Lpt9"] {
            assert!(is_device(name), "{name}");
        }
        for name in ["auxiliary", "com", "com10", "comx"] {
            assert!(!is_device(name), "{name}");
        }
    }

    #[test]
    fn dates_exist() {
        for (text, expected) in [
            ("2024-01", Some((2024, 1, 0))),
            ("2024-02-29", Some((2024, 2, 29))),
            ("2023-02-29", None),
            ("2024-13", None),
            ("2024-00", None),
            ("2024-01-00", None),
            ("2024-1", None),
            ("2024", None),
            ("2024-01-01-01", None),
            ("24-01", None),
        ] {
            assert_eq!(date(text), expected, "{text}");
        }
    }
}
