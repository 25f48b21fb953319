//! `fcproto explain`.

use std::fmt::Write as _;

use fc_diff::Rule;
use fc_spec::diagnostic::{FaultCode, nearest};
use fc_spec::lint;

use crate::lang::{both, lang, said};
use crate::outcome::{Failure, Status};
use crate::print;

/// Options of `fcproto explain`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[arg(
        value_name = "CODE",
        help = both("错误码或规则 [默认：列出全部]", "Error code or rule [default: list all]")
    )]
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
                let _ = writeln!(text, "{}  {}", rule.code.number, rule.code.title_in(lang));
            }
        }
        Some(number) => {
            if let Some(rule) = Rule::parse(number) {
                let (code, title) = (rule.code(), rule.title_in(lang));
                let _ = write!(text, "{code}{colon}{title}\n\n{}", rule.explain(lang));
            } else if let Some(rule) = lint::Rule::parse(number) {
                let (code, title) = (rule.code.number, rule.code.title_in(lang));
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
    let codes = codes.chain(lint::Rule::all().flat_map(|rule| [rule.code.number, rule.name]));
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
