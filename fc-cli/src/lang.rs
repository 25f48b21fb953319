//! In which language the command speaks.

use std::ffi::OsString;
use std::sync::OnceLock;

use clap::ValueEnum;
use fc_spec::model::{Lang, Text};

/// A language that the command speaks.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum Language {
    #[value(help = both("中文", "Chinese"))]
    Zh,
    #[value(help = both("英文", "English"))]
    En,
}

/// The language of this run.
static SPOKEN: OnceLock<Lang> = OnceLock::new();

/// Where the language stands if no option names one, the first that is set and not empty; so does POSIX have it.
const VARIABLES: [&str; 3] = ["LC_ALL", "LC_MESSAGES", "LANG"];

/// Settles the language of this run: `--lang` on the command line, or else the environment.
///
/// The words are read before the command line is parsed: help and usage errors are in this language, too.
pub fn speak(words: impl IntoIterator<Item = OsString>) {
    // A run has one command line, so this is the first call.
    let _ = SPOKEN.set(asked(words).unwrap_or_else(of_environment));
}

/// The language that `--lang` names, if it names one.
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
            // The parser reports a wrong value.
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

/// The language of this run.
pub fn lang() -> Lang {
    *SPOKEN.get_or_init(of_environment)
}

/// A fixed text in the language of this run.
pub fn both(zh: &'static str, en: &'static str) -> &'static str {
    lang().pick(zh, en)
}

/// A text in the language of this run.
pub fn in_lang(text: &Text) -> String {
    lang().text(text).to_owned()
}

/// What [`fc_spec::text!`] writes, in the language of this run.
macro_rules! said {
    ($($text:tt)+) => {
        $crate::lang::in_lang(&fc_spec::text!($($text)+))
    };
}

pub(crate) use said;

/// `1 file`, `2 files`; `1 个文件`.
pub fn counted(count: usize, zh: &str, en: &str) -> String {
    match (lang(), count) {
        (Lang::Zh, _) => format!("{count} 个{zh}"),
        (Lang::En, 1) => format!("1 {en}"),
        (Lang::En, _) => format!("{count} {en}s"),
    }
}
