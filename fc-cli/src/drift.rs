//! `fcproto drift`.

use std::io;

use fc_reflect::Reflector;
use fc_workshop::drift::{self, Deviation, Drift, Report};

use crate::help::{Help, Part};
use crate::lang::{both, counted, lang, said};
use crate::outcome::{Failure, Status};
use crate::place::Place;
use crate::print;
use crate::recording::{Recording, Shown};
use crate::spec::Spec;

/// Options of `fcproto drift`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[command(flatten)]
    recording: Recording,
    #[arg(
        long,
        value_name = "FORMAT",
        default_value = "text",
        help = both("输出格式", "Output format")
    )]
    format: Shown,
    #[arg(
        long,
        help = both("显示能消除偏差的 YAML 修改", "Show the edits of the YAML that would settle deviations")
    )]
    suggest: bool,
}

pub fn help() -> Help {
    Help {
        summary: both(
            "对照规范检查录下的通信",
            "Compare recorded traffic with the spec",
        ),
        details: vec![
            Part::Text(both(
                "找出设备与规范不一致之处：未知的功能码、键、枚举值和结果码，错误的类型和取值范围，缺少的键，缺少的响应和应答，\
                 状态的顺序，上报的时机。同一处只列一次，附次数和第一帧的位置。",
                "Finds where devices differ from the spec: unknown codes, keys, enum values and results, wrong types and ranges, missing \
                 keys. With times, also missing responses and acknowledgements, wrong states, and reports at wrong times. Each place is listed once, with \
                 its count and its first frame.",
            )),
            Part::Text(both(
                "`--suggest` 给出按第一帧修改规范的 diff，不写入文件。规范正确时，应当修改设备。",
                "`--suggest` prints a diff that makes the spec agree with the first frame, and writes nothing. If the spec is right, change \
                 the device instead.",
            )),
            Part::Examples(vec![
                ("fcproto drift capture.pcapng", ""),
                ("fcproto drift --suggest capture.pcapng", ""),
                (
                    "sudo tcpdump -U -w - tcp | fcproto drift --format json",
                    both(
                        "检查实时通信，结束后输出",
                        "Check live traffic, and print at its end",
                    ),
                ),
            ]),
        ],
        fails: both("规范有错误，或有偏差", "Errors in the spec, or deviations"),
        speaks: both("`text` 格式", "`text`"),
    }
}

pub fn run(place: &Place, options: &Options) -> Result<Status, Failure> {
    let spec = Spec::read(place)?;
    let Some(model) = &spec.model else {
        spec.show_faults()?;
        return Ok(spec.status());
    };
    let reflector = Reflector::new(model);
    let mut found = Drift::new(model);
    options.recording.read(&reflector, &mut |record| {
        found.observe(record);
        Ok(())
    })?;
    let report = found.finish();
    for deviation in &report.deviations {
        show(&spec, options, deviation)?;
    }
    if options.format == Shown::Text {
        print::done(&summary(&report))?;
    }
    Ok(if report.deviations.is_empty() {
        Status::Fine
    } else {
        Status::Faulty
    })
}

fn show(spec: &Spec, options: &Options, deviation: &Deviation<'_>) -> io::Result<()> {
    if options.format == Shown::Json {
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
