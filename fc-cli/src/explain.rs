//! `fcproto explain`.

use std::fmt::Write as _;

use fc_diff::Rule;
use fc_spec::diagnostic::{FaultCode, nearest};
use fc_spec::lint;

use crate::lang::{lang, said};
use crate::outcome::{Failure, Status};
use crate::print;

/// Show what an error code or a rule of `fcproto diff` or `fcproto lint` means, or list all codes.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  fcproto explain         list all codes
  fcproto explain FC0012  explain one of them; `12` or `fc0012` works as well
  fcproto explain FC0731  explain a rule of `fcproto diff`
  fcproto explain FC0802  explain a rule of `fcproto lint`; its name works as well")]
pub struct Options {
    /// The code, as shown in brackets in an error.
    code: Option<String>,
}

pub fn run(options: &Options) -> Result<Status, Failure> {
    let lang = lang();
    let colon = lang.pick("：", ": ");
    let mut text = String::new();
    match &options.code {
        None => {
            for code in FaultCode::ALL {
                let _ = writeln!(text, "{code}  {}", code.title(lang));
            }
            for rule in Rule::all() {
                let _ = writeln!(text, "{}  {}", rule.code(), rule.title_in(lang));
            }
            for rule in lint::Rule::all() {
                let _ = writeln!(text, "{}  {}", rule.code, rule.title_in(lang));
            }
        }
        Some(number) => {
            if let Some(rule) = Rule::parse(number) {
                let (code, title) = (rule.code(), rule.title_in(lang));
                let _ = write!(text, "{code}{colon}{title}\n\n{}", rule.explain(lang));
            } else if let Some(rule) = lint::Rule::parse(number) {
                let (code, title) = (rule.code, rule.title_in(lang));
                let _ = write!(text, "{code}{colon}{title}\n\n{}", rule.explain(lang));
            } else {
                let code = FaultCode::parse(number).ok_or_else(|| unknown(number))?;
                let (title, about) = (code.title(lang), code.explain(lang));
                let _ = write!(text, "{code}{colon}{title}\n\n{about}");
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
        Some(code) => said!(
            "没有错误码 `{number}`；是否想写 `{code}`？",
            "there is no error code `{number}`; did you mean `{code}`?"
        ),
        None => said!(
            "没有错误码 `{number}`；`fcproto explain` 列出全部错误码",
            "there is no error code `{number}`; `fcproto explain` lists them all"
        ),
    }
}
