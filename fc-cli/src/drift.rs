//! `fcproto drift`.

use std::io;

use fc_reflect::Reflector;
use fc_workshop::drift::{self, Deviation, Drift, Report};

use crate::lang::{both, counted, lang, said};
use crate::outcome::{Failure, Status};
use crate::output::Output;
use crate::print;
use crate::recording::{OutputFormat, Recording};
use crate::spec::Spec;

/// Options of `fcproto drift`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[command(flatten)]
    recording: Recording,
    #[command(flatten)]
    output: Output<OutputFormat>,
    #[arg(
        long,
        help = both("显示能消除偏差的 YAML 修改", "Show the edits of the YAML that would settle deviations")
    )]
    suggest: bool,
}

pub fn run(spec: &Spec, options: &Options) -> Result<Status, Failure> {
    let model = spec.valid()?;
    let reflector = Reflector::new(model);
    let mut found = Drift::new(model);
    options.recording.read(&reflector, &mut |record| {
        found.observe(record);
        Ok(())
    })?;
    let report = found.finish();
    for deviation in &report.deviations {
        show(spec, options, deviation)?;
    }
    if options.output.format == OutputFormat::Text {
        print::done(&summary(&report))?;
    }
    Ok(Status::fine_if(report.deviations.is_empty()))
}

fn show(spec: &Spec, options: &Options, deviation: &Deviation<'_>) -> io::Result<()> {
    if options.output.format == OutputFormat::Json {
        return print::result(&(drift::json(deviation) + "\n"));
    }
    let mut text = drift::text(deviation, lang()) + "\n";
    let edit = spec.model.as_ref().filter(|_| options.suggest);
    if let Some(edit) = edit.and_then(|model| drift::suggest(&spec.sources, model, deviation)) {
        text += &print::diff(&format!("--- {}\n{}", edit.path, edit.diff));
    }
    print::result(&text)
}

/// Returns the number of frames and deviations.
fn summary(report: &Report<'_>) -> String {
    let frames = counted(report.frames, "帧", "frame");
    let places = counted(report.deviations.len(), "偏差", "deviation");
    match report.uncounted {
        0 => said!("{frames}，{places}\n", "{frames}, {places}\n"),
        more => said!(
            "{frames}，{places}，另有 {more} 次未列出\n",
            "{frames}, {places}, and {more} more that are not listed\n"
        ),
    }
}
