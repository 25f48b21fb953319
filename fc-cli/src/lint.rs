//! `fcproto lint`.

use fc_codegen::target::FILE;
use fc_spec::diagnostic::Faults;
use fc_spec::lint::{faults, lint, settings, waive};
use fc_spec::load::places;

use crate::check::{Denied, Shown};
use crate::lang::{counted, said};
use crate::outcome::{Failure, Status};
use crate::place::Place;
use crate::print;
use crate::project::Project;
use crate::spec::Spec;
use crate::versions::{day, today};

/// Find what is not wrong but could be better.
///
/// Rules are of categories: MINIMAL is what no protocol should have, STANDARD (which contains it) what makes one easy to use, DOCS is about
/// texts, WIRE about values that some receivers cannot keep, SUNSET about dates of what is deprecated. `lint` in fc.yaml sets their
/// levels, and has the rules of the project itself. `fcproto explain FC0802` explains a rule.
///
/// A finding that is to stay is accepted by an entry under `waivers` in the spec, with the id that stands below it, a reason, who
/// has accepted it, and until when. A waiver that has expired, or that accepts nothing, is an error.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  fcproto lint
  fcproto lint --deny warnings     for continuous integration: fails on warnings as well
  fcproto lint --today 2027-01-01  what will have to be gone by then
  fcproto lint --format sarif > fc.sarif

Levels and rules of the project, in fc.yaml:
  lint:
    levels: { WIRE: warning, FC0814: error, full-stop: \"off\" }
    house:
      - id: motion-needs-precondition
        zh: 动作指令要写前置条件
        en: A motion says when it is accepted
        for: command
        where: { effect: motion }
        require: { accepted: present }

Formats and their paths are those of `fcproto check`.")]
pub struct Options {
    /// Output format.
    #[arg(long, value_name = "FORMAT", default_value = "text")]
    format: Shown,
    /// What ends with status 1 although it is not an error.
    #[arg(long, value_name = "WHAT")]
    deny: Option<Denied>,
    /// Judge dates as on this day [default: today]
    #[arg(long, value_name = "DAY", value_parser = day)]
    today: Option<String>,
}

pub fn run(place: &Place, options: &Options) -> Result<Status, Failure> {
    let project = Project::find(place)?;
    let mut wrong = Faults::new();
    let (settings, files) = settings(&project.root, FILE, &mut wrong);
    if !wrong.is_empty() {
        wrong.sort();
        options.format.show(&project, &wrong, &files)?;
        return Ok(Status::Failed);
    }
    let spec = Spec::in_project(&project);
    let Some(model) = &spec.model else {
        options.format.show(&project, &spec.faults, &spec.sources)?;
        return Ok(spec.status());
    };
    let today = today(options.today.as_deref());
    let mut findings = lint(model, &settings, &today);
    waive(&mut findings, &model.waivers, &today);
    let shown = faults(&findings, &settings, || places(&spec.sources));
    options.format.show(&project, &shown, &spec.sources)?;
    if options.format == Shown::Text && shown.is_empty() {
        let waived = findings.iter().filter(|it| it.waived.is_some()).count();
        let waived = match waived {
            0 => String::new(),
            waived => said!("，{waived} 处已接受", ", {waived} waived"),
        };
        let linted = print::good(&said!("检查完毕", "linted"));
        let files = counted(spec.files(), "文件", "file");
        print::done(&said!(
            "{linted}：{files}，没有发现问题{waived}\n",
            "{linted} {files}: nothing found{waived}\n"
        ))?;
    }
    Ok(
        if shown.has_errors() || (options.deny.is_some() && !shown.is_empty()) {
            Status::Faulty
        } else {
            Status::Fine
        },
    )
}
