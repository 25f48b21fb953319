//! Completion of words that the spec knows, for shells.

use std::ffi::{OsStr, OsString};

use clap::ArgMatches;
use clap_complete::CompletionCandidate;
use fc_spec::model::Model;
use fc_workshop::complete::{complete, complete_nested};

use crate::help::described;
use crate::lang::lang;
use crate::progress;
use crate::project_dirs::ProjectDirs;
use crate::spec::Spec;

/// Returns the operations that begin with a word.
pub fn operations(word: &OsStr) -> Vec<CompletionCandidate> {
    let model = Line::read().model();
    model.map_or_else(Vec::new, |model| {
        let names = model.operations.iter().map(|it| it.name.clone());
        candidates(&model, names.collect(), word)
    })
}

/// Returns the completions of a word of `fcproto call`.
pub fn call(word: &OsStr) -> Vec<CompletionCandidate> {
    let line = Line::read();
    let (Some(model), Some(text)) = (line.model(), word.to_str()) else {
        return Vec::new();
    };
    let mut before = line.of_call();
    // Bash cuts words at the equals sign, and leaves out the sign itself if nothing follows it.
    let has_sign = before.pop_if(|word| word == "=").is_some();
    let is_value = before.iter().rev().nth(1).is_some_and(|word| word == "=");
    let is_key = before.len() > 1 && (has_sign || !is_value);
    let key = before.pop_if(|word| is_key && !word.contains('='));
    let before: Vec<&str> = before.iter().map(String::as_str).collect();
    let Some(key) = key else {
        return candidates(&model, complete_nested(&model, &before, text), word);
    };
    let values = complete(&model, &before, &format!("{key}={text}"));
    let values = values.iter().filter_map(|it| it.split_once('='));
    let values = values.map(|(_, value)| value.to_owned());
    candidates(&model, values.collect(), word)
}

/// Returns candidates with the title of each operation.
fn candidates(model: &Model, found: Vec<String>, word: &OsStr) -> Vec<CompletionCandidate> {
    let word = word.to_string_lossy();
    let found = found.into_iter().filter(|it| it.starts_with(&*word));
    let candidates = found.map(|found| {
        let operation = model.operation(&found);
        let title = operation.map(|it| lang().text(&it.title).to_owned().into());
        CompletionCandidate::new(found).help(title)
    });
    candidates.collect()
}

/// The command line so far.
struct Line(Option<ArgMatches>);

impl Line {
    /// Reads the words before the one to complete, which the script of the shell passes behind `--`.
    fn read() -> Self {
        let words = std::env::args_os().skip_while(|word| word != "--");
        let words: Vec<OsString> = words.skip(1).collect();
        let index = std::env::var("_CLAP_COMPLETE_INDEX").ok();
        let index = index.and_then(|index| index.parse().ok());
        let before = words
            .iter()
            .take(index.unwrap_or(words.len().saturating_sub(1)));
        Self(
            described()
                .ignore_errors(true)
                .try_get_matches_from(before)
                .ok(),
        )
    }

    fn get<T: Clone + Send + Sync + 'static>(&self, name: &str) -> Option<T> {
        let matches = self.0.as_ref()?;
        matches.try_get_one::<T>(name).ok().flatten().cloned()
    }

    /// Reads the spec of the project.
    fn model(&self) -> Option<Model> {
        let dirs = ProjectDirs {
            root: self.get("root"),
            spec: self.get("spec"),
        };
        // The terminal shows the line that is being typed.
        progress::quiet(true);
        Spec::read(&dirs).ok()?.model
    }

    /// Returns the name and the arguments of a call.
    fn of_call(&self) -> Vec<String> {
        let call = self.0.as_ref().and_then(|it| it.subcommand_matches("call"));
        let values = |name| call.and_then(|it| it.get_many::<String>(name));
        let words = values("name").into_iter().flatten();
        words
            .chain(values("arguments").into_iter().flatten())
            .cloned()
            .collect()
    }
}
