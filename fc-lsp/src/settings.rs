//! What a client says of itself when it begins.

use crate::position::Encoding;
use fc_spec::model::Lang;
use serde_json::Value;
use std::path::PathBuf;

/// How a client wants its answers.
#[derive(Clone, Debug)]
pub struct Settings {
    /// How it counts columns.
    pub encoding: Encoding,
    /// In which language it is told what is wrong; where both are shown, which comes first.
    pub lang: Lang,
    /// Whether it has the command by which a lens shows references.
    pub shows_references: bool,
    /// Whether it can be told that lenses have changed, so that it asks for them again.
    pub refreshes_lenses: bool,
    /// Whether it can be asked to watch files.
    pub can_watch: bool,
    /// The directories in which it works, the first of which is where the project is looked for.
    pub folders: Vec<PathBuf>,
}

impl Settings {
    /// From the parameters of `initialize`. What is not as it should be is passed over, so that an odd client gets
    /// answers, too.
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
