//! Output to the terminal. All texts may contain ANSI colors, and the streams remove them where they are not supported.

use fc_codegen::output::{OutputError, unified};
use fc_codegen::project::ProjectError;
use fc_codegen::questions::SelectionError;
use fc_codegen::target::TargetError;
use fc_diff::{UnknownCode, VersionError};
use fc_package::PackError;
use fc_spec::diagnostic::{Faults, Format, render, summary};
use fc_spec::index::NotDeclared;
use fc_spec::load::SettleError;
use fc_spec::model::{DumpError, ProjectionError, Text};
use fc_spec::retire::RetireError;
use fc_spec::scaffold::ScaffoldError;
use fc_spec::source::Sources;
use fc_workshop::client::ClientError;
use fc_workshop::error::InputError;
use fc_workshop::listen::ListenError;

use crate::lang::{in_lang, lang, said};
use std::error::Error;
use std::fmt::Write as _;
use std::io::{self, Write as _};

use clap::builder::styling::{AnsiColor, Style};

use crate::progress;

const ERROR: Style = AnsiColor::Red.on_default().bold();
const GOOD: Style = AnsiColor::Green.on_default().bold();

/// Prints the result of a command.
pub fn result(text: &str) -> io::Result<()> {
    progress::done();
    let mut stdout = anstream::stdout().lock();
    stdout.write_all(text.as_bytes())?;
    stdout.flush()
}

/// Prints a success message, unless the run is quiet.
pub fn done(text: &str) -> io::Result<()> {
    if progress::is_quiet() {
        return Ok(());
    }
    result(text)
}

/// Prints a message to standard error.
pub fn message(text: &str) -> io::Result<()> {
    progress::done();
    anstream::stderr().lock().write_all(text.as_bytes())
}

/// Prints diagnostics as text, with a hint for more information.
pub fn faults(faults: &Faults, sources: &Sources) -> io::Result<()> {
    let text = render(faults, sources, Format::Colored, lang());
    let summary = summary(faults, lang()).map(|line| leveled(&line) + "\n");
    message(&(text + &summary.unwrap_or_default()))
}

/// Prints the reason why a command failed.
pub fn failure(failure: &(dyn Error + 'static)) {
    if let Some(ProjectError::Targets(TargetError::Settings(settings))) = failure.downcast_ref() {
        let _ = faults(&settings.faults, &settings.sources);
        return;
    }
    // If standard error is closed as well, the exit status is the only signal.
    let _ = error(&in_lang(&reason(failure)));
}

/// Prints an error to standard error.
pub fn error(text: &str) -> io::Result<()> {
    let line = said!("错误：{text}\n", "error: {text}\n");
    message(&leveled(&line))
}

/// Returns the reason of a failure. Some reasons are in the language of this run only, and those of libraries in English.
pub fn reason(failure: &(dyn Error + 'static)) -> Text {
    macro_rules! of {
        ($($Known:ty),+) => {
            $(if let Some(error) = failure.downcast_ref::<$Known>() {
                return Text::clone(&error.text());
            })+
        };
    }
    of!(
        DumpError,
        NotDeclared,
        OutputError,
        ProjectError,
        ProjectionError,
        RetireError,
        ScaffoldError,
        SelectionError,
        SettleError,
        TargetError,
        UnknownCode,
        VersionError,
        ClientError,
        InputError,
        ListenError,
        PackError
    );
    let text = failure.to_string();
    Text {
        zh: text.clone(),
        en: text,
    }
}

/// The maximum number of paths that a message lists.
const NAMED: usize = 10;

/// Returns the first lines of a list, and the number of the others after `indent`.
pub fn first(lines: impl ExactSizeIterator<Item = String>, indent: &str) -> String {
    let more = lines.len().saturating_sub(NAMED);
    let mut text: String = lines.take(NAMED).collect();
    if more > 0 {
        text += &said!("{indent}另有 {more} 个\n", "{indent}and {more} more\n");
    }
    text
}

/// Returns a success word in color.
pub fn good(text: &str) -> String {
    format!("{GOOD}{text}{GOOD:#}")
}

/// Colors the level at the start of a line.
pub fn leveled(line: &str) -> String {
    for level in ["error:", "错误："] {
        if let Some(rest) = line.strip_prefix(level) {
            return format!("{ERROR}{level}{ERROR:#}{rest}");
        }
    }
    line.to_owned()
}

/// Colors a unified diff.
pub fn diff(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for line in text.lines() {
        let style = match line.as_bytes() {
            [b'+', ..] => AnsiColor::Green.on_default(),
            [b'-', ..] => AnsiColor::Red.on_default(),
            [b'@', ..] => AnsiColor::Cyan.on_default(),
            _ => Style::new(),
        };
        let _ = writeln!(out, "{style}{line}{style:#}");
    }
    out
}

/// Returns the change of a file as a colored diff.
pub fn change(path: &str, old: &str, new: &str) -> String {
    let (before, after) = (format!("a/{path}"), format!("b/{path}"));
    diff(&unified(&before, &after, old, new))
}

/// Returns `true` if a command failed because its output was closed, as in `fcproto explain | head`.
pub fn is_closed_pipe(failure: &(dyn Error + 'static)) -> bool {
    failure
        .downcast_ref::<io::Error>()
        .is_some_and(|error| error.kind() == io::ErrorKind::BrokenPipe)
}
