//! `fcproto explain`.

use fc_diff::{Explanation, explain, titles};

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
            let lines = titles(lang).map(|(code, title)| format!("{code}  {title}\n"));
            lines.collect::<Vec<_>>().concat()
        }
        Some(code) => {
            let Explanation { code, title, about } = explain(code, lang)?;
            said!("{code}：{title}\n\n{about}", "{code}: {title}\n\n{about}")
        }
    };
    print::result(&text)?;
    Ok(Status::Fine)
}
