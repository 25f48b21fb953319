//! The page of the documentation.

use super::{Language, Section, Target, Text, packages, t, targets_table, without_targets};
use crate::machine::Machine;
use std::fmt::Write as _;

const MARK: &str =
    "<!-- Written by `cargo run --release --manifest-path bench/Cargo.toml -- all --report`; do not edit. -->";

/// The page about performance.
#[must_use]
pub fn page(sections: &[Section], machine: &Machine, quick: bool, language: Language) -> String {
    let get = |text: Text| text.get(language).to_owned();
    let mut out = String::new();
    let _ = write!(
        out,
        "---\noutline: [2, 3]\n---\n\n{MARK}\n\n# {}\n\n{}\n\n{}",
        get(t("性能", "Performance")),
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
    let packages = packages::block(&packages::read().expect("the reports of the packages"), language);
    let _ = write!(out, "{packages}\n## {}\n\n{}\n", get(t("自己测一遍", "Measure it yourself")), get(how()));
    out
}

fn summary(all: usize, missed: usize) -> Text {
    t(
        format!("共 {all} 项目标，{missed} 项未达标。比值都是同一次运行中交替进行的各轮的中位数之比。"),
        format!(
            "{all} targets, {missed} of them missed. Every ratio is one of medians over rounds that took turns within one run."
        ),
    )
}

fn introduction() -> Text {
    t(
        "每一项都与两样东西并排测量：一个下限（同样的字节，除此之外什么也不做），以及同类的其他实现。\
         机器不同、负载不同，绝对时间就不同；**只有同一次运行里的比值有意义**。",
        "Everything is measured beside two things: a floor, which moves the same bytes and does nothing else, and \
         other implementations of the same. Absolute times belong to one machine under one load; **only ratios within \
         one run mean something**.",
    )
}

fn how() -> Text {
    t(
        "`cargo run --release --manifest-path bench/Cargo.toml -- all` 约需十到二十分钟；\
         加 `--quick` 轮数少，只可粗看；`codec`、`calls`、`reports`、`data`、`generator`、`compile` 各跑一组；\
         `all --report` 重写本页。机器应当空闲。指令数的预算由 `bench/budget` 检查，它不受负载影响。",
        "`cargo run --release --manifest-path bench/Cargo.toml -- all` takes ten to twenty minutes; `--quick` runs \
         fewer rounds and gives only a rough idea; `codec`, `calls`, `reports`, `data`, `generator` and `compile` run one \
         group each; `all --report` rewrites this page. The machine should be idle. A budget of instructions, which \
         no load disturbs, is checked by `bench/budget`.",
    )
}
