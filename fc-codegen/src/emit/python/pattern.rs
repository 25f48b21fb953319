//! Regular expressions of the spec in the words of Python's `re`, which the runtime asks for ASCII classes.

/// POSIX classes, as they stand inside brackets.
const CLASSES: [(&str, &str); 14] = [
    ("alnum", "0-9A-Za-z"),
    ("alpha", "A-Za-z"),
    ("ascii", r"\x00-\x7f"),
    ("blank", r"\t "),
    ("cntrl", r"\x00-\x1f\x7f"),
    ("digit", "0-9"),
    ("graph", "!-~"),
    ("lower", "a-z"),
    ("print", " -~"),
    ("punct", r"!-/:-@\[-`{-~"),
    ("space", r"\t\n\v\f\r "),
    ("upper", "A-Z"),
    ("word", "0-9A-Za-z_"),
    ("xdigit", "0-9A-Fa-f"),
];

/// What Python says otherwise: POSIX classes, names of groups, code points in braces, the end, the edges of words.
pub fn pattern(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let (taken, said) = translated(rest).unwrap_or_else(|| {
            // An escape stays as it is, so that nothing in it is taken for something else.
            let length = if first == '\\' { 2 } else { 1 };
            let length = rest.chars().take(length).map(char::len_utf8).sum();
            (length, rest.split_at(length).0.to_owned())
        });
        out.push_str(&said);
        rest = rest.split_at(taken).1;
    }
    out
}

/// What a text begins with that Python says otherwise: how long it is, and what Python says.
fn translated(text: &str) -> Option<(usize, String)> {
    for (before, said) in [(r"\z", r"\Z"), (r"\<", r"\b(?=\w)"), (r"\>", r"\b(?<=\w)")] {
        if text.starts_with(before) {
            return Some((before.len(), said.to_owned()));
        }
    }
    for (name, said) in CLASSES {
        let class = format!("[:{name}:]");
        if text.starts_with(&class) {
            return Some((class.len(), said.to_owned()));
        }
    }
    for open in ["(?P<", "(?<"] {
        if text.starts_with(open) {
            return Some((text.find('>')? + 1, "(".to_owned()));
        }
    }
    for open in [r"\x{", r"\u{", r"\U{"] {
        if let Some(digits) = text.strip_prefix(open) {
            let (digits, _) = digits.split_once('}')?;
            let code = u32::from_str_radix(digits, 16).ok()?;
            return Some((open.len() + digits.len() + 1, format!("\\U{code:08x}")));
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::pattern;

    #[test]
    fn what_python_says_otherwise() {
        for (text, expected) in [
            (r"[a-z]+\d{2,3}", r"[a-z]+\d{2,3}"),
            (r"[[:alpha:]_]+\z", r"[A-Za-z_]+\Z"),
            (r"(?<year>\d+)-(?P<m>\d)", r"(\d+)-(\d)"),
            (r"\x{4E00}\\z\(?<", r"\U00004e00\\z\(?<"),
            (r"(?:站|点)\<a\>", r"(?:站|点)\b(?=\w)a\b(?<=\w)"),
        ] {
            assert_eq!(pattern(text), expected);
        }
    }
}
