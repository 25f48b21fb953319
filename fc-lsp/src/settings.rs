//! The settings that the client sends at the start.

use crate::position::Encoding;
use fc_spec::model::Lang;
use serde_json::Value;
use std::path::PathBuf;

/// The client's settings and capabilities.
#[derive(Clone, Debug)]
pub struct Settings {
    /// The unit of columns.
    pub encoding: Encoding,
    /// The language of messages. Where both languages are shown, it comes first.
    pub lang: Lang,
    /// `true` if the client has the command that shows references from a lens.
    pub shows_references: bool,
    /// `true` if the client supports requests to refresh lenses.
    pub refreshes_lenses: bool,
    /// `true` if the client can watch files.
    pub can_watch: bool,
    /// The client's directories. The search for the project starts with the first.
    pub folders: Vec<PathBuf>,
}

impl Settings {
    /// Reads the parameters of `initialize`. Ignores invalid values, so that an unusual client still gets answers.
    #[must_use]
    pub fn read(params: &Value) -> Self {
        let text = |pointer: &str| params.pointer(pointer).and_then(Value::as_str);
        let is_true =
            |pointer: &str| params.pointer(pointer).and_then(Value::as_bool) == Some(true);
        let encodings = params.pointer("/capabilities/general/positionEncodings");
        let encodings = encodings.and_then(Value::as_array);
        let counts_bytes = encodings.is_some_and(|all| all.iter().any(|it| it == "utf-8"));
        let lang = text("/initializationOptions/lang").or_else(|| text("/locale"));
        let folders = params
            .pointer("/workspaceFolders")
            .and_then(Value::as_array);
        let folders = folders.into_iter().flatten();
        let folders = folders.filter_map(|folder| folder.get("uri")?.as_str());
        let uris = folders.chain(text("/rootUri"));
        let mut folders: Vec<_> = uris.filter_map(crate::uri::to_path).collect();
        folders.extend(text("/rootPath").map(PathBuf::from));
        Self {
            encoding: if counts_bytes {
                Encoding::Utf8
            } else {
                Encoding::Utf16
            },
            lang: match lang {
                Some(lang) if lang.to_ascii_lowercase().starts_with("zh") => Lang::Zh,
                _ => Lang::En,
            },
            shows_references: is_true("/initializationOptions/showReferences"),
            refreshes_lenses: is_true("/capabilities/workspace/codeLens/refreshSupport"),
            can_watch: is_true("/capabilities/workspace/didChangeWatchedFiles/dynamicRegistration"),
            folders,
        }
    }
}
