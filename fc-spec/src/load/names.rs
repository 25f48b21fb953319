//! Names: which are well formed, and how one is made from another.

/// Whether this is a `snake_case` name: lower-case letters and digits in parts joined by single underscores,
/// starting with a letter.
pub(crate) fn is_snake(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_lowercase())
        && name.split('_').all(|part| {
            !part.is_empty()
                && part
                    .chars()
                    .all(|c| c.is_ascii_lowercase() || c.is_ascii_digit())
        })
}

/// Whether this is a `PascalCase` name: ASCII letters and digits, starting with an upper-case letter.
pub(crate) fn is_pascal(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_uppercase())
        && name.chars().all(|c| c.is_ascii_alphanumeric())
}

/// `snake_case` of a wire name: `robotSn` becomes `robot_sn`, `HTTPPort` `http_port`, `MD5` `md5`.
/// Characters that no name may hold separate its parts; the result may still be no name at all.
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

/// `PascalCase` of a `snake_case` name: `get_station` becomes `GetStation`.
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
    }
}
