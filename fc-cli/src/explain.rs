//! `fcproto explain`.

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
    let text = match &options.code {
        None => {
            let codes = FaultCode::ALL.iter();
            let codes = codes.map(|code| (code.to_string(), code.title(lang)));
            let rules = Rule::all().map(|rule| (rule.code(), rule.title_in(lang)));
            let lints = lint::Rule::all();
            let lints = lints.map(|rule| (rule.code.number.to_owned(), rule.code.title_in(lang)));
            let all = codes.chain(rules).chain(lints);
            let listed: Vec<_> = all
                .map(|(code, title)| format!("{code}  {title}\n"))
                .collect();
            listed.concat()
        }
        Some(number) => {
            let (code, title, about) = if let Some(rule) = Rule::parse(number) {
                let about = rule.explain(lang);
                (rule.code(), rule.title_in(lang), about)
            } else if let Some(rule) = lint::Rule::parse(number) {
                let code = &rule.code;
                (
                    code.number.to_owned(),
                    code.title_in(lang),
                    rule.explain(lang),
                )
            } else {
                let code = FaultCode::parse(number).ok_or_else(|| unknown(number))?;
                let about = code.explain(lang).to_owned();
                (code.to_string(), code.title(lang), about)
            };
            said!("{code}：{title}\n\n{about}", "{code}: {title}\n\n{about}")
        }
    };
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
