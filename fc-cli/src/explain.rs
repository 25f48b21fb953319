//! `fcproto explain`.

use std::fmt::Write as _;

use fc_diff::Rule;
use fc_spec::diagnostic::{FaultCode, nearest};
use fc_spec::lint;

use crate::help::{Help, Part};
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

pub fn help() -> Help {
    Help {
        summary: both("解释错误码或规则", "Explain an error code or a rule"),
        details: vec![
            Part::Text(both(
                "错误码在报错的方括号里。FC07 开头的是 `fcproto diff` 的规则，FC08 开头的是 `fcproto lint` 的规则。",
                "The code is in the brackets of an error. Codes that begin with FC07 are rules of `fcproto diff`, codes that \
                 begin with FC08 are rules of `fcproto lint`.",
            )),
            Part::Examples(vec![
                (
                    "fcproto explain",
                    both("列出全部错误码和规则", "List all codes and rules"),
                ),
                (
                    "fcproto explain FC0012",
                    both(
                        "解释一个错误码；写 12 或 fc0012 也可以",
                        "Explain a code; 12 and fc0012 work, too",
                    ),
                ),
                (
                    "fcproto explain FC0802",
                    both(
                        "解释一条规则；写它的名称也可以",
                        "Explain a rule; its name works, too",
                    ),
                ),
            ]),
        ],
        fails: "",
        speaks: both("说明文字", "The explanations"),
    }
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
