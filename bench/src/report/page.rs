//! The results page of the documentation.

use super::{Language, Section, Target, Text, packages, t, targets_table, without_targets};
use crate::machine::Machine;
use std::fmt::Write as _;

const MARK: &str =
    "<!-- Written by `cargo run --release --manifest-path bench/Cargo.toml -- all --report`; do not edit. -->";

/// Returns the page with all results. The summary, `performance.md`, is written by hand.
#[must_use]
pub fn page(sections: &[Section], machine: &Machine, quick: bool, language: Language) -> String {
    let get = |text: Text| text.get(language).to_owned();
    let mut out = String::new();
    let _ = write!(
        out,
        "---\noutline: [2, 3]\n---\n\n{MARK}\n\n# {}\n\n{}\n\n{}",
        get(t("性能测试结果", "Performance results")),
        get(introduction()),
        machine.table().markdown(language),
    );
    if quick {
        let _ = write!(
            out,
            "\n{}\n",
            get(t(
                "> 本页来自 `--quick`：轮数少，数字粗略。",
                "> This page comes from `--quick`: few rounds, rough figures."
            ))
        );
    }
    let targets: Vec<Target> = sections.iter().flat_map(|section| section.targets.clone()).collect();
    let missed = targets.iter().filter(|target| !target.is_met() && !target.value.is_nan()).count();
    let _ = write!(
        out,
        "\n## {}\n\n{}\n\n{}\n",
        get(t("一览", "At a glance")),
        get(summary(targets.len(), missed)),
        targets_table(&targets).markdown(language),
    );
    for section in sections {
        out.push_str(&without_targets(section, language));
    }
    out.push_str(&packages::block(&packages::read().expect("the reports of the packages"), language));
    out
}

fn summary(all: usize, missed: usize) -> Text {
    t(
        format!("共 {all} 项目标，{missed} 项未达标。比值是同一次运行中交替进行的各轮的中位数之比。"),
        format!(
            "{all} targets, {missed} of them missed. Each ratio compares medians over rounds that took turns within one run."
        ),
    )
}

fn introduction() -> Text {
    t(
        "每一项都与一个**下限**和同类的其他实现一起测量。下限收发同样的字节，除此之外什么也不做。[性能](performance.md)\
         页给出摘要，并说明怎样测量。\n\n\
         只比较同一次运行中的比值：绝对时间取决于机器和负载。",
        "Each measurement runs next to a **floor**, which only moves the same bytes, and next to other implementations \
         of the same function. [Performance](performance.md) has a summary and explains how to measure.\n\n\
         Compare only ratios within one run: absolute times depend on the machine and its load.",
    )
}
