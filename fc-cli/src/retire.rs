//! `fcproto retire`.

use std::fmt::Write as _;

use fc_codegen::output::replace_spec_file;
use fc_spec::model::Text;
use fc_spec::retire::retire;

use crate::lang::said;
use crate::outcome::{Failure, Status};
use crate::place::Place;
use crate::print;
use crate::project::Project;
use crate::spec::Spec;

/// Take a command, report or stream out of the spec, and make sure that its code is never assigned again.
///
/// Its code goes among the retired ones with the reason, and types that nothing else uses go with it. The spec is
/// only changed if it has no errors before and after: what else names the operation has to be changed first, and
/// the gaps of the source that it answers have to be answered elsewhere.
/// An app or robot that still uses it is refused from then on; to warn beforehand, write `deprecated` first.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  fcproto retire get_battery --zh 由状态上报代替 --en 'Replaced by the status report'
  fcproto retire get_battery --zh 由状态上报代替 --en 'Replaced by the status report' --dry-run")]
pub struct Options {
    /// Its name, such as `get_battery`.
    #[arg(value_name = "NAME")]
    name: String,
    /// Why, in Chinese.
    #[arg(long, value_name = "TEXT")]
    zh: String,
    /// Why, in English.
    #[arg(long, value_name = "TEXT")]
    en: String,
    /// Show what would change and write nothing.
    #[arg(long)]
    dry_run: bool,
}

pub fn run(place: &Place, options: &Options) -> Result<Status, Failure> {
    let project = Project::find(place)?;
    let spec = Spec::in_project(&project);
    let Some(model) = &spec.model else {
        spec.show_faults()?;
        return Ok(spec.status());
    };
    let why = Text {
        zh: options.zh.clone(),
        en: options.en.clone(),
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
        said!("将停用", "would retire")
    } else {
        said!("已停用", "retired")
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
    for ((_, before), (_, file)) in spec.sources.iter().zip(after.sources.iter()) {
        if file.text != before.text {
            replace_spec_file(&project.root, &file.path, &file.text)?;
        }
    }
    print::done(
        &(text
            + &said!(
                "\n运行 `fcproto generate`，把它从由规范生成的所有内容中去掉\n",
                "\nrun `fcproto generate` to take it out of everything that is made of the spec\n"
            )),
    )?;
    Ok(Status::Fine)
}
