//! The errors of the spec's checks and the rules of the lint, with the texts of `fcproto explain`.

use super::shared::{Desk, list};
use fc_spec::diagnostic::FaultCode;
use fc_spec::lint;
use minijinja::{Value, context};

pub(in crate::emit::markdown) fn errors(desk: Desk<'_, '_>) -> Value {
    let wrong = desk.lang.pick("错误：", "Wrong:");
    let right = desk.lang.pick("正确：", "Right:");
    let error = |code: &FaultCode| {
        context! {
            code => code.as_str(),
            title => code.title(desk.lang),
            text => told(code.explain(desk.lang), wrong, right),
        }
    };
    let rule = |rule: &lint::Rule| {
        let [en, zh] = rule.setting();
        context! {
            code => rule.code.number,
            title => rule.code.title_in(desk.lang),
            setting => desk.lang.pick(zh, en),
            text => rule.code.text_in(desk.lang),
        }
    };
    context! {
        rules => list(lint::Rule::all().map(rule)),
        errors => list(FaultCode::ALL.iter().map(error)),
    }
}

/// Adds a heading for right or wrong to the examples of a text. Outside of the terminal, the words after the language
/// of a fence are invisible.
fn told(text: &str, wrong: &str, right: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for line in text.lines() {
        let fence = line.starts_with("```").then_some(line);
        let example = fence.and_then(|fence| {
            let (fence, word) = fence.rsplit_once(' ')?;
            match word {
                "bad" => Some((fence, wrong)),
                "good" => Some((fence, right)),
                _ => None,
            }
        });
        if let Some((fence, word)) = example {
            out.push_str(word);
            out.push_str("\n\n");
            out.push_str(fence);
        } else {
            out.push_str(line);
        }
        out.push('\n');
    }
    out
}

#[cfg(test)]
mod tests {
    use super::told;

    #[test]
    fn bad_and_good_examples_are_marked() {
        let text = "Why.\n\n```yaml bad\na: 1\n```\n\n```yaml good\na: 2\n```\n";
        let want = "Why.\n\nNo:\n\n```yaml\na: 1\n```\n\nYes:\n\n```yaml\na: 2\n```\n";
        assert_eq!(told(text, "No:", "Yes:"), want);
    }
}
