//! Conversion between paths and `file:` URIs.

use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, percent_decode_str, utf8_percent_encode};
use std::path::{Path, PathBuf};

/// The characters that are escaped in a path.
const ESCAPED: &AsciiSet = &NON_ALPHANUMERIC
    .remove(b'/')
    .remove(b'-')
    .remove(b'.')
    .remove(b'_')
    .remove(b'~');

/// Returns the path of a URI, or `None` if it is not a file on this machine.
pub fn to_path(uri: &str) -> Option<PathBuf> {
    let rest = uri.strip_prefix("file://")?;
    let path = rest.strip_prefix("localhost").unwrap_or(rest);
    if !path.starts_with('/') {
        return None;
    }
    let path = percent_decode_str(path).decode_utf8().ok()?;
    let bare = path.strip_prefix('/').unwrap_or(&path);
    let has_drive = bare.as_bytes().get(1) == Some(&b':')
        && bare.starts_with(|c: char| c.is_ascii_alphabetic());
    Some(PathBuf::from(if cfg!(windows) && has_drive {
        bare
    } else {
        &path
    }))
}

/// Returns the URI of a path.
pub fn of_path(path: &Path) -> String {
    let text = path.to_string_lossy();
    let text = if cfg!(windows) {
        text.replace('\\', "/")
    } else {
        text.into_owned()
    };
    let slash = if text.starts_with('/') { "" } else { "/" };
    format!("file://{slash}{}", utf8_percent_encode(&text, ESCAPED))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_there_and_back() {
        for path in ["/a/b.yaml", "/规范/a b%20.yaml", "/a+b/c#d?.yaml"] {
            let uri = of_path(Path::new(path));
            assert!(uri.is_ascii(), "{uri}");
            assert_eq!(to_path(&uri).as_deref(), Some(Path::new(path)), "{uri}");
        }
        let other = "file://localhost/a:b/%E8%A7%84.yaml";
        assert_eq!(to_path(other).as_deref(), Some(Path::new("/a:b/规.yaml")));
        for none in [
            "untitled:Untitled-1",
            "file:a",
            "file://server/share",
            "file:///%ff",
            "",
        ] {
            assert_eq!(to_path(none), None, "{none}");
        }
    }
}
