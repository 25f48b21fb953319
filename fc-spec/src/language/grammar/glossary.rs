//! `glossary:`: the terms of the protocol.

use super::common::BothLanguages;
use super::form::{List, Str};

grammar! {
    /// A term of the protocol, in both languages. The pages link its first use to its meaning.
    /// 一条术语，中英文都写。各页中第一次出现时链接到它的解释。
    TERM: Term = "term" "术语" {
        /// In Chinese.
        /// 中文。
        required zh: Str, example "充电桩", faults [SharedWord, EmptyText, TextSpacing, NotChinese, Placeholder];
        /// In English.
        /// 英文。
        required en: Str, example "dock", faults [SharedWord, EmptyText, TextSpacing, SameText, NotEnglish, Placeholder];
        /// Other forms of it, which are linked as well: synonyms, plurals.
        /// 别的写法，出现时同样链接：同义词、英文复数。
        optional also: OtherForms;
        /// Its meaning.
        /// 含义。
        required means: BothLanguages;
    }

    /// Other forms of a term, in one language or both.
    /// 术语别的写法，只写一种语言也可以。
    OTHER_FORMS: OtherForms = "other forms" "别的写法" {
        /// In Chinese.
        /// 中文。
        optional zh: List<Str, 1>, example "[充电座]", faults [SharedWord, EmptyText, TextSpacing];
        /// In English.
        /// 英文。
        optional en: List<Str, 1>, example "[docks, docking stations]", faults [SharedWord, EmptyText, TextSpacing];
    }
}
