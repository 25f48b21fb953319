//! Rust spellings of the spec's names.

/// Words that cannot be an identifier even as `r#word`.
const NEVER_RAW: &[&str] = &["Self", "crate", "self", "super"];

/// Keywords of every edition up to 2024, strict and reserved, sorted.
const KEYWORDS: &[&str] = &[
    "Self", "abstract", "as", "async", "await", "become", "box", "break", "const", "continue",
    "crate", "do", "dyn", "else", "enum", "extern", "false", "final", "fn", "for", "gen", "if",
    "impl", "in", "let", "loop", "macro", "match", "mod", "move", "mut", "override", "priv", "pub",
    "ref", "return", "self", "static", "struct", "super", "trait", "true", "try", "type", "typeof",
    "unsafe", "unsized", "use", "virtual", "where", "while", "yield",
];

/// A name as an identifier: `type` becomes `r#type`, `self` becomes `self_`.
pub fn ident(name: &str) -> String {
    if KEYWORDS.binary_search(&name).is_err() {
        name.to_owned()
    } else if NEVER_RAW.contains(&name) {
        format!("{name}_")
    } else {
        format!("r#{name}")
    }
}

/// A method's identifier: one that `taken` already holds gets an underscore behind it.
pub fn method(name: &str, taken: &[&str]) -> String {
    if taken.contains(&name) {
        format!("{name}_")
    } else {
        ident(name)
    }
}

/// `snake_case` to `PascalCase`: `at_undock_point` becomes `AtUndockPoint`.
pub fn pascal(name: &str) -> String {
    let mut out = String::with_capacity(name.len());
    for part in name.split('_') {
        let mut characters = part.chars();
        if let Some(first) = characters.next() {
            out.extend(first.to_uppercase());
            out.push_str(characters.as_str());
        }
    }
    if KEYWORDS.binary_search(&out.as_str()).is_ok() {
        out.push('_');
    }
    out
}

/// The first of `wishes` that `taken` does not hold; failing all, the last with underscores.
pub fn free(wishes: &[&str], taken: impl Fn(&str) -> bool) -> String {
    for wish in wishes {
        if !taken(wish) {
            return (*wish).to_owned();
        }
    }
    let mut name = wishes.last().copied().unwrap_or("other").to_owned();
    while taken(&name) {
        name.push('_');
    }
    name
}

/// A text as a Rust string literal, raw where that spares escapes and shows the text as it is.
pub fn literal(text: &str) -> String {
    let needs_escape = |c: char| c.is_control() || turns_text_around(c);
    // First bytes of what is escaped and of some that is not.
    let suspect = |byte| matches!(byte, 0..=0x1F | b'"' | b'\\' | 0x7F | 0xC2 | 0xE2);
    if !text.bytes().any(suspect) {
        return ["\"", text, "\""].concat();
    }
    if text.contains(['"', '\\']) && !text.contains(needs_escape) {
        let mut hashes = String::new();
        while text.contains(&format!("\"{hashes}")) {
            hashes.push('#');
        }
        return ["r", &hashes, "\"", text, "\"", &hashes].concat();
    }
    let mut out = String::with_capacity(text.len() + 2);
    out.push('"');
    for character in text.chars() {
        match character {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            '\n' => out.push_str("\\n"),
            '\r' => out.push_str("\\r"),
            '\t' => out.push_str("\\t"),
            c if needs_escape(c) => out.extend(c.escape_unicode()),
            c => out.push(c),
        }
    }
    out.push('"');
    out
}

/// Whether a character changes the direction of the text after it, which the compiler refuses.
pub fn turns_text_around(character: char) -> bool {
    matches!(character, '\u{202A}'..='\u{202E}' | '\u{2066}'..='\u{2069}')
}

/// An integer literal with its digits in groups of three: `16_777_216`.
pub fn integer(value: i128) -> String {
    let digits = value.unsigned_abs().to_string();
    let mut out = if value < 0 {
        "-".to_owned()
    } else {
        String::new()
    };
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) && digits.len() > 4 {
            out.push('_');
        }
        out.push(digit);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keywords_are_sorted_for_the_search() {
        assert!(KEYWORDS.is_sorted());
    }

    #[test]
    fn identifiers() {
        for (name, expected) in [
            ("robot_sn", "robot_sn"),
            ("type", "r#type"),
            ("self", "self_"),
            ("gen", "r#gen"),
        ] {
            assert_eq!(ident(name), expected);
        }
        assert_eq!(method("connect", &["connect", "reports"]), "connect_");
        assert_eq!(method("loop", &["connect"]), "r#loop");
    }

    #[test]
    fn pascal_case() {
        for (name, expected) in [
            ("idle", "Idle"),
            ("at_undock_point", "AtUndockPoint"),
            ("switch_0a08", "Switch0a08"),
            ("self", "Self_"),
        ] {
            assert_eq!(pascal(name), expected);
        }
    }

    #[test]
    fn free_names() {
        let taken = ["Unknown", "Other"];
        assert_eq!(
            free(&["Unknown", "Other", "Unlisted"], |name| taken
                .contains(&name)),
            "Unlisted"
        );
        assert_eq!(free(&["Unknown"], |name| taken.contains(&name)), "Unknown_");
    }

    #[test]
    fn string_literals() {
        for (text, expected) in [
            ("站点", "\"站点\""),
            (r#"{"a":1}"#, r##"r#"{"a":1}"#"##),
            (r##"a"#b"##, r###"r##"a"#b"##"###),
            ("a\n\"b\"", r#""a\n\"b\"""#),
            ("a\u{202e}b", r#""a\u{202e}b""#),
            (r"\d", r#"r"\d""#),
        ] {
            assert_eq!(literal(text), expected);
        }
    }

    #[test]
    fn grouped_digits() {
        for (value, expected) in [
            (0, "0"),
            (5656, "5656"),
            (65_536, "65_536"),
            (-1_234_567, "-1_234_567"),
        ] {
            assert_eq!(integer(value), expected);
        }
    }
}
