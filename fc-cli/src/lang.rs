//! In which language the command speaks.

use std::sync::OnceLock;

use clap::ValueEnum;
use fc_spec::model::{Lang, Text};

/// A language that the command speaks.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum Language {
    /// Chinese
    Zh,
    /// English
    En,
}

impl From<Language> for Lang {
    fn from(language: Language) -> Self {
        match language {
            Language::Zh => Self::Zh,
            Language::En => Self::En,
        }
    }
}

/// The language of this run.
static SPOKEN: OnceLock<Lang> = OnceLock::new();

/// Where the language stands if no option names one, the first that is set and not empty; so does POSIX have it.
const VARIABLES: [&str; 3] = ["LC_ALL", "LC_MESSAGES", "LANG"];

/// Settles the language of this run: what the command line says, or else the environment.
pub fn speak(language: Option<Language>) {
    let lang = language.map_or_else(of_environment, Lang::from);
    // A run has one command line, so that this is the first time.
    let _ = SPOKEN.set(lang);
}

fn of_environment() -> Lang {
    let mut values = VARIABLES.iter().filter_map(|name| std::env::var_os(name));
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
