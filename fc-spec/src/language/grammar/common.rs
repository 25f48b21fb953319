//! Keys with the same meaning in every mapping.

use super::available::Available;
use super::coordinates::Store;
use super::form::{Bool, Date, Entries, List, Name, Scalar, Str};
use super::kind::Kind;
use super::refers::{AnyOperation, Ref};
use crate::model;
use crate::syntax::Node;
use crate::vocabulary::{AnswerKind, Severity};

grammar! {
    /// A text in both languages.
    /// 中英文各写一份的文本。
    TEXT: Text = "text" "文本" {
        /// In Chinese.
        /// 中文。
        required zh: Str, example "电池电量", faults [EmptyText, HiddenCharacter, TextSpacing, NotChinese, Placeholder];
        /// In English.
        /// 英文。
        required en: Str, example "Battery level", faults [EmptyText, HiddenCharacter, TextSpacing, SameText, NotEnglish, Placeholder];
    }

    /// Keys that many mappings share.
    /// 多种映射共用的键。
    COMMON: Common = "common key" "通用键" {
        /// Longer description, as Markdown paragraphs.
        /// 详细说明，用 Markdown 分段书写。
        optional about: BothLanguages;
        /// When it first appeared.
        /// 最早出现的时间。
        optional since: Date;
        /// The audiences, machines and releases that have it; all of them if left out.
        /// 面向谁、哪些机型、哪些版本；不写时不作限制。
        optional available: Available, faults [LimitsNothing, LimitedButRequired];
        /// Its dated changes.
        /// 历次变更，各有日期。
        optional changes: List<Change>;
        /// The spec's answers to gaps and mistakes of the source document.
        /// 对源文档中缺失和错误之处的答复。
        optional answers: List<Answer>, faults [AnswerToNothing];
        /// Other words that readers know it by; shown on its page and found by the search.
        /// 别的叫法：显示在它的页面上，也能用来搜索。
        optional aliases: Aliases;
        /// Name in code, if the one derived from the wire key is not suitable.
        /// 代码中的名称；由键名得出的名称不合适时才写。
        optional name: Name, example "battery_level";
        /// Store in which it is kept, declared under `stores`. For an operation: the store that it reads and sets.
        /// 内容的存储位置，在 `stores` 中声明。接口则指它读写的存储位置。
        optional kept: Ref<Store>, example "config_file", faults [UnknownStore];
    }

    /// Other words for it, in both languages.
    /// 别的叫法，中英文都写。
    ALIASES: Aliases = "list of aliases" "别名" {
        /// In Chinese.
        /// 中文。
        required zh: List<Str, 1>, example "[电量, 剩余电量]", faults [EmptyText, HiddenCharacter, TextSpacing];
        /// In English.
        /// 英文。
        required en: List<Str, 1>, example "[charge, state of charge]", faults [EmptyText, HiddenCharacter, TextSpacing];
    }

    /// A dated change.
    /// 一次变更。
    CHANGE: Change = "change" "变更" {
        /// When.
        /// 日期。
        required date: Date;
        use TEXT.zh, TEXT.en;
    }

    /// An answer of the spec to gaps and slips of the source.
    /// 对源文档中缺失和笔误的答复。
    ANSWER: Answer = "answer" "答复" {
        /// Ids of the conflicts it answers. An answer without ids names its facts in `about`.
        /// 所答复的疑问的编号；没有编号的答复在 `about` 中写明涉及的内容。
        optional ids: List<Ref<Conflict>, 1>, faults [UnknownConflict];
        /// Kind of answer.
        /// 答复的种类。
        required r#as: AnswerKind;
        /// The facts it governs, each with its state in the spec until the owner has answered: `code: open`, `request: inferred`, or a path of keys with a value, such as `response.data.x.unit: absent`.
        /// 它涉及的内容，以及负责人答复之前规范中的写法：`code: open`、`request: inferred`，或从此处起的键路径和值，例如 `response.data.x.unit: absent`。
        optional about: Entries<Str, Scalar, 1>, example "{ code: open }", faults [GovernsNothing, GovernedFact];
        /// `true` if it describes the runtime: no value of the spec changes that.
        /// 写 `true` 表示描述的是运行库的做法，规范中没有可改的值。
        optional runtime: Bool, default "false";
        /// The owner's confirmation, which settles it.
        /// 负责人的确认；有了它，疑问即告解决。
        optional confirmed: Confirmed, faults [SettledButUntouched];
        use TEXT.zh, TEXT.en;
    }

    /// The confirmation of the protocol owner.
    /// 协议负责人的确认。
    CONFIRMED: Confirmed = "confirmation" "确认" {
        /// Name of the person who confirmed it.
        /// 确认人。
        required by: Str, example "Li Wei";
        use CHANGE.date;
        /// Reference, such as a mail or a ticket.
        /// 凭据，例如邮件、工单。
        optional reference: Str, example "mail of 2024-05-06";
        /// The owner's words, in the original language.
        /// 原话，照录。
        optional reply: Str, example "单位是毫米";
    }

    /// A gap or slip of the source document.
    /// 源文档中的一处缺失或笔误。
    CONFLICT: Conflict = "conflict" "疑问" {
        /// Its topic, such as `frame`, `codes`, `fields`.
        /// 涉及什么，例如 `frame`、`codes`、`fields`。
        required category: Str, example "fields";
        /// Its severity.
        /// 严重程度。
        required severity: Severity;
        use TEXT.zh, TEXT.en;
    }

    /// Deprecated: the reason, and the replacement.
    /// 已弃用：原因，以及改用什么。
    FIELD_DEPRECATED: FieldDeprecated = "field deprecation" "字段弃用" {
        /// Date since which it is deprecated.
        /// 从什么时候起弃用。
        optional since: Date, faults [DatesOutOfOrder];
        /// Last day or month in which it works.
        /// 保留到哪一天或哪个月为止。
        optional sunset: Date;
        use TEXT.zh, TEXT.en;
    }

    /// Deprecated: the reason, and the replacement.
    /// 已弃用：原因，以及改用什么。
    DEPRECATED: Deprecated = "deprecation" "弃用" {
        use FIELD_DEPRECATED.since, FIELD_DEPRECATED.sunset, TEXT.zh, TEXT.en;
        /// Operation to use instead.
        /// 改用的接口。
        optional replaced_by: Ref<AnyOperation>, example "get_battery", faults [UnknownOperation];
    }
}

forms! {
    /// A text in both languages.
    BothLanguages: Kind::Map(Text::TABLE) => model::Text, |node| Some(both_languages(node));
}

/// Returns `zh` and `en` of a mapping. A missing text is a copy of the other. Both are empty if both are missing.
pub(crate) fn both_languages(node: Node<'_>) -> model::Text {
    let text = model::Text {
        zh: TEXT.zh.read(node).unwrap_or_default(),
        en: TEXT.en.read(node).unwrap_or_default(),
    };
    text.completed()
}
