//! The language of the command's output.

use std::ffi::OsString;
use std::sync::OnceLock;

use clap::ValueEnum;
use fc_spec::model::{Lang, Text};

/// A language of the output.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum Language {
    #[value(help = both("中文", "Chinese"))]
    Zh,
    #[value(help = both("英文", "English"))]
    En,
}

/// The language of this run.
static SPOKEN: OnceLock<Lang> = OnceLock::new();

/// The environment variables for the language, in POSIX order. The first one that is set and not empty counts.
const VARIABLES: [&str; 3] = ["LC_ALL", "LC_MESSAGES", "LANG"];

/// Sets the language of this run from `--lang` or the environment.
///
/// It reads `--lang` before clap parses the command line, so that help and usage errors use the language too.
pub fn speak(words: impl IntoIterator<Item = OsString>) {
    // A run has one command line, so only this call sets the language.
    let _ = SPOKEN.set(asked(words).unwrap_or_else(of_environment));
}

/// Returns the language of `--lang`, if the option has a valid one.
fn asked(words: impl IntoIterator<Item = OsString>) -> Option<Lang> {
    let words = words
        .into_iter()
        .map(|word| word.to_string_lossy().into_owned());
    let mut words = words.take_while(|word| word != "--");
    while let Some(word) = words.next() {
        let value = match word.strip_prefix("--lang") {
            Some("") => words.next()?,
            Some(rest) => rest.strip_prefix('=').unwrap_or_default().to_owned(),
            None => continue,
        };
        match value.as_str() {
            "zh" => return Some(Lang::Zh),
            "en" => return Some(Lang::En),
            // The parser reports an invalid value.
            _ => {}
        }
    }
    None
}

fn of_environment() -> Lang {
    let mut values = VARIABLES.into_iter().filter_map(std::env::var_os);
    let locale = values.find(|value| !value.is_empty());
    let locale = locale.unwrap_or_default();
    let is_chinese = locale
        .to_string_lossy()
        .to_ascii_lowercase()
        .starts_with("zh");
    if is_chinese { Lang::Zh } else { Lang::En }
}

/// Returns the language of this run.
pub fn lang() -> Lang {
    *SPOKEN.get_or_init(of_environment)
}

/// Returns a fixed text in the language of this run.
pub fn both(zh: &'static str, en: &'static str) -> &'static str {
    lang().pick(zh, en)
}

/// Returns a text in the language of this run.
pub fn in_lang(text: &Text) -> String {
    lang().text(text).to_owned()
}

/// Formats a text as [`fc_spec::text!`] does, in the language of this run.
macro_rules! said {
    ($($text:tt)+) => {
        $crate::lang::in_lang(&fc_spec::text!($($text)+))
    };
}

pub(crate) use said;

/// Returns a number with its noun: `1 file`, `2 files`; `1 个文件`.
pub fn counted(count: usize, zh: &str, en: &str) -> String {
    match (lang(), count) {
        (Lang::Zh, _) => format!("{count} 个{zh}"),
        (Lang::En, 1) => format!("1 {en}"),
        (Lang::En, _) => format!("{count} {en}s"),
    }
}
