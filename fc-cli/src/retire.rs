//! `fcproto retire`.

use std::fmt::Write as _;

use fc_spec::model::{Lang, Text};
use fc_spec::retire::retire;

use crate::lang::{both, said};
use crate::outcome::{Failure, Status};
use crate::print;
use crate::spec::Spec;

/// Options of `fcproto retire`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[arg(
        value_name = "NAME",
        help = both("要退役的接口，例如 `get_battery`", "Operation to retire, such as `get_battery`")
    )]
    name: String,
    #[arg(long, value_name = "TEXT", help = both("理由，中文", "Reason in Chinese"))]
    zh: Option<String>,
    #[arg(long, value_name = "TEXT", help = both("理由，英文", "Reason in English"))]
    en: Option<String>,
    #[arg(
        long,
        help = both("显示修改，什么也不写", "Show the changes and write nothing")
    )]
    dry_run: bool,
}

pub fn run(spec: &Spec, options: &Options) -> Result<Status, Failure> {
    let model = spec.valid()?;
    for (lang, option, reason) in [
        (Lang::Zh, "--zh", &options.zh),
        (Lang::En, "--en", &options.en),
    ] {
        if reason.is_none() && spec.texts().include(lang) {
            return Err(said!(
                "缺少 `{option}`：`fc.yaml` 的 `languages` 要求用这种语言写理由",
                "`{option}` is missing: `languages` in `fc.yaml` requires a reason in this language"
            )
            .into());
        }
    }
    let why = Text {
        zh: options.zh.clone().unwrap_or_default(),
        en: options.en.clone().unwrap_or_default(),
    };
    let retired = retire(model, &spec.sources, &options.name, &why)?;
    let after = spec.instead(retired.sources);
    if after.model.is_none() {
        let (name, objection) = (&options.name, after.objection());
        return Err(said!(
            "去掉 `{name}` 之后{objection}",
            "without `{name}` {objection}"
        )
        .into());
    }
    let mut text = String::new();
    for (path, diff) in &retired.diffs {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{path}\n{}", print::diff(diff).trim_end());
    }
    let what = if options.dry_run {
        said!("将退役", "would retire")
    } else {
        said!("已退役", "retired")
    };
    let _ = write!(text, "{} {}", print::good(&what), options.name);
    if let Some(code) = &retired.code {
        text += &said!(" 及其功能码 {code}", " and its code {code}");
    }
    if !retired.with_it.is_empty() {
        text += &said!(
            "，连同 {with_it}",
            ", with {with_it}",
            with_it = Text::listed(&retired.with_it)
        );
    }
    if options.dry_run {
        print::result(&(text + "\n"))?;
        return Ok(Status::Fine);
    }
    spec.project.write_changes(&spec.sources, &after.sources)?;
    text += &said!(
        "\n运行 `fcproto generate`，把它从由规范生成的所有内容中去掉\n",
        "\nrun `fcproto generate` to remove it from the generated files\n"
    );
    print::done(&text)?;
    Ok(Status::Fine)
}
