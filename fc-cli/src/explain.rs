//! `fc explain`.

use std::fmt::Write as _;

use fc_diff::Rule;
use fc_spec::diagnostic::{FaultCode, nearest};
use fc_spec::lint;

use crate::outcome::{Failure, Status};
use crate::print;

/// Show what an error code or a rule of `fc diff` or `fc lint` means, or list all codes.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  fc explain              list all codes
  fc explain FC0012       explain one of them; `12` or `fc0012` works as well
  fc explain FC0731       explain a rule of `fc diff`
  fc explain FC0802       explain a rule of `fc lint`; its name works as well")]
pub struct Options {
    /// The code, as shown in brackets in an error.
    code: Option<String>,
}

pub fn run(options: &Options) -> Result<Status, Failure> {
    let mut text = String::new();
    match &options.code {
        None => {
            for code in FaultCode::ALL {
                let _ = writeln!(text, "{code}  {}", code.title());
            }
            for rule in Rule::all() {
                let [title, _] = rule.title;
                let _ = writeln!(text, "{}  {title}", rule.code());
            }
            for rule in lint::Rule::all() {
                let [title, _] = rule.title;
                let _ = writeln!(text, "{}  {title}", rule.code);
            }
        }
        Some(number) => {
            if let Some(rule) = Rule::parse(number) {
                let [title, _] = rule.title;
                let _ = write!(text, "{}: {title}\n\n{}", rule.code(), rule.explain());
            } else if let Some(rule) = lint::Rule::parse(number) {
                let [title, _] = rule.title;
                let _ = write!(text, "{}: {title}\n\n{}", rule.code, rule.explain());
            } else {
                let code = FaultCode::parse(number).ok_or_else(|| unknown(number))?;
                let _ = write!(text, "{code}: {}\n\n{}", code.title(), code.explain());
            }
        }
    }
    print::result(&text)?;
    Ok(Status::Fine)
}

fn unknown(number: &str) -> String {
    let codes = FaultCode::ALL.iter().map(|code| code.as_str());
    let codes = codes.chain(lint::Rule::all().flat_map(|rule| [rule.code, rule.name]));
    match nearest(number, codes) {
        Some(code) => format!("there is no error code `{number}`; did you mean `{code}`?"),
        None => format!("there is no error code `{number}`; `fc explain` lists them all"),
    }
}
