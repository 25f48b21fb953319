//! `fc.yaml`: the settings of a project.

use super::common::TEXT;
use super::form::{Bool, Entries, Int, Json, LangName, LevelName, List, Str, TestedKind};
use super::key::Key;
use super::kind::{Doc, Kind, Said};
use crate::syntax::Node;

/// The name of the crate. `crate` is no identifier, so the table of targets cannot declare it.
pub(crate) const CRATE: Key<Str> = Key::new(
    "crate",
    false,
    Doc::new("The name of the Rust package.", "Rust 包的名称。"),
    Said {
        default: Some("fc_generated"),
        example: Some("robot_protocol"),
        faults: &[],
    },
);

grammar! {
    /// The settings of a project: the directory of its spec, and the targets to generate.
    /// 项目的设置：规范所在的目录，以及要生成的目标。
    PROJECT: Project = "project" "项目" {
        /// The directory of the spec, relative to this file.
        /// 规范的目录，相对于这个文件。
        optional spec: Str, default "spec", example "spec";
        /// The languages that each text of the spec must have.
        /// 规范中每处文字必须有的语言。
        optional languages: List<LangName, 1>, default "[zh, en]", example "[en]";
        /// The targets to generate, by name. Without this key, all products.
        /// 要生成的目标，以名称为键；不写时生成所有产物。
        optional targets: Entries<Str, Target>;
        /// The levels and the rules of `fcproto lint`.
        /// `fcproto lint` 的级别和规则。
        optional lint: Lint;
    }

    /// The settings of `fcproto lint`.
    /// `fcproto lint` 的设置。
    LINT: Lint = "lint settings" "检查设置" {
        /// The levels of rules and categories, by their codes or names.
        /// 规则和类别的级别，以编号或名称为键。
        optional levels: Entries<Str, LevelName>;
        /// The rules of the project, and files with such rules.
        /// 项目自己的规则，以及存放规则的文件。
        optional house: List<RuleOrFile>, example "[rules/naming.yaml]";
    }

    /// A rule of the project: a requirement for things of the spec. Paths and values are those of `fcproto inspect`.
    /// 项目的一条规则：对规范内容的要求；路径和值与 `fcproto inspect` 的输出一致。
    HOUSE_RULE: HouseRule = "rule" "规则" {
        /// The name of the rule, also a key of `levels`.
        /// 规则的名称，也是 `levels` 的键。
        required id: Str, example "motion-needs-precondition";
        use TEXT.zh, TEXT.en;
        /// The level, unless `levels` sets another.
        /// 级别；`levels` 的设置优先。
        optional level: LevelName, default "warning";
        /// The kind of things that the rule tests.
        /// 规则适用的对象。
        required r#for: TestedKind;
        /// The rule applies only to things that pass this test.
        /// 只有符合此判断的对象才适用。
        optional r#where: Json, example "{ effect: motion }";
        /// The test that each thing must pass.
        /// 对象应当符合的判断。
        required require: Json, example "{ accepted: present }";
    }

    /// A target: a product of the generator, or the output of a plugin.
    /// 目标：生成器的一种产物，或插件的输出。
    TARGET: Target = "target" "目标" {
        /// The directory of the files, relative to the project.
        /// 文件所在的目录，相对于项目。
        optional out: Str, example "fc-generated";
        /// The languages of the pages or of the comments.
        /// 页面或注释的语言。
        optional languages: List<LangName, 1>, example "[en]";
        use CRATE;
        /// Adds an id type for each entity, in all packages.
        /// 为每种实体生成 ID 类型，对所有包生效。
        optional newtypes: Bool, default "false";
        /// The program that generates the files: a name, or a path with a `/`.
        /// 生成文件的程序：名称，或含 `/` 的路径。
        optional plugin: Str, example "tools/handbook.py";
        /// The programming language that must be able to use the names of the spec.
        /// 规范中的名称必须能用于这种编程语言。
        optional names: Str, example "kotlin";
        /// The audience whose part of the protocol the target contains.
        /// 只包含这个受众的那部分协议。
        optional audience: Str, example "product_app";
        /// The maximum run time of the plugin, in milliseconds.
        /// 插件的最长运行时间，单位毫秒。
        optional timeout_ms: Int<u64, 1, 3_600_000>, default "60000", example "60000";
        /// The maximum output of the plugin, in bytes.
        /// 插件输出的上限，单位字节。
        optional output_bytes: Int<u64, 1, { 1 << 30 }>, default "67108864", example "67108864";
        /// The options that are passed to the plugin.
        /// 传给插件的选项。
        optional options: Json, example "{ title: Robots }";
    }
}

forms! {
    /// A rule of the project, or the name of a file with rules.
    RuleOrFile: Kind::Either(&[Kind::Text, HouseRule::KIND]) => Node<'a>, Some;
}
