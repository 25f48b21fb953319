//! Descriptions of the keys and words of the spec language, by name.

use fc_spec::language::{Key, Part, reference};
use fc_spec::model::Lang;
use fc_spec::model::Text;
use gen_lsp_types::{MarkupContent, MarkupKind};
use std::sync::OnceLock;

/// Returns a key of a part.
pub fn key(part: &str, name: &str) -> Option<&'static Key> {
    let part = self::part(part)?;
    part.keys.iter().find(|key| key.name == name)
}

/// Returns a part by its id.
pub fn part(id: &str) -> Option<&'static Part> {
    static LANGUAGE: OnceLock<Vec<Part>> = OnceLock::new();
    let parts = LANGUAGE.get_or_init(reference);
    parts.iter().find(|part| part.id == id)
}

/// Returns Markdown for a client.
pub fn markdown(value: String) -> MarkupContent {
    MarkupContent {
        kind: MarkupKind::Markdown,
        value,
    }
}

/// Returns a text in both languages as paragraphs, the client's language first.
pub fn both(text: &Text, lang: Lang) -> String {
    let other = match lang {
        Lang::Zh => &text.en,
        Lang::En => &text.zh,
    };
    let own = lang.text(text);
    match (own.is_empty(), other.is_empty()) {
        (false, false) if own != other => format!("{own}\n\n{other}"),
        (true, _) => other.clone(),
        _ => own.to_owned(),
    }
}
