//! Checks for every text of an error.

use fc_spec::diagnostic::{Diagnostic, Faults};
use fc_spec::model::Text;
use regex_lite::Regex;

/// Beginnings of messages that quote the English text of the YAML parser, the regular expression library or the
/// operating system.
const PASSED_ON: [&str; 3] = ["不是 YAML：", "正则表达式库的说明：", "无法读取 `"];

/// Returns an objection for each text that is missing in one language, or that names different things in the two.
pub fn objections(whose: &str, faults: &Faults) -> Vec<String> {
    faults
        .iter()
        .flat_map(|fault| said(fault).filter_map(|text| Some((text, objection(text)?))))
        .map(|(text, why)| format!("{whose}: {why}\n  {}\n  {}", text.zh, text.en))
        .collect()
}

/// Returns all texts of an error.
fn said(fault: &Diagnostic) -> impl Iterator<Item = &Text> {
    let labels = std::iter::once(&fault.primary).chain(&fault.secondary);
    let labels = labels.map(|label| &label.text);
    std::iter::once(&fault.message)
        .chain(labels.filter(|text| !text.is_empty()))
        .chain(&fault.notes)
        .chain(fault.fixes.iter().map(|fix| &fix.message))
}

/// Returns the objection to a text, if there is one.
fn objection(text: &Text) -> Option<&'static str> {
    let [(zh_names, zh), (en_names, en)] = [&text.zh, &text.en].map(|text| parts(text));
    let is = |pattern: &str, text: &str| Regex::new(pattern).is_ok_and(|it| it.is_match(text));
    let passes_on = PASSED_ON.iter().any(|start| text.zh.starts_with(start));
    if zh_names != en_names {
        Some("not the same names in both")
    } else if !is("[一-鿿]", &zh) {
        Some("the Chinese is none")
    } else if is("[一-鿿]", &en) {
        Some("Chinese in the English")
    } else if !passes_on && is("[A-Za-z]{2,} [a-z]+ ", &(zh.clone() + " ")) {
        Some("English in the Chinese")
    } else if is("[一-鿿][A-Za-z0-9`]|[A-Za-z0-9`][一-鿿]", &zh) {
        Some("no blank between Chinese and Latin")
    } else if is("[：，；。、（）“”？] |[一-鿿] [一-鿿]|  ", &zh) {
        Some("a blank where Chinese has none")
    } else {
        None
    }
}

/// Returns the names between backticks, sorted, and the sentence with `x` in their place.
fn parts(text: &str) -> (Vec<&str>, String) {
    let mut names: Vec<_> = text.split('`').skip(1).step_by(2).collect();
    names.sort_unstable();
    let rest: Vec<_> = text.split('`').step_by(2).collect();
    (names, rest.join("`x`"))
}
