//! Text in two languages.

use std::borrow::Cow;

/// A language of the results.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    /// 中文.
    Chinese,
    /// English.
    English,
}

/// A text in both languages.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Text {
    chinese: Cow<'static, str>,
    english: Cow<'static, str>,
}

impl Text {
    /// Returns the text in `language`.
    #[must_use]
    pub fn get(&self, language: Language) -> &str {
        match language {
            Language::Chinese => &self.chinese,
            Language::English => &self.english,
        }
    }
}

/// Creates a text in both languages.
pub fn t(chinese: impl Into<Cow<'static, str>>, english: impl Into<Cow<'static, str>>) -> Text {
    Text { chinese: chinese.into(), english: english.into() }
}

/// Names and figures are the same in both languages.
impl From<&'static str> for Text {
    fn from(text: &'static str) -> Self {
        t(text, text)
    }
}

impl From<String> for Text {
    fn from(text: String) -> Self {
        t(text.clone(), text)
    }
}
