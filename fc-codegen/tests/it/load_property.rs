//! Any file content gives either errors or a model. It never gives both or neither, and it never panics. A model that
//! passes every check can be emitted.

use crate::good_spec;
use fc_codegen::emit;
use fc_codegen::inspect;
use fc_codegen::target::Targets;
use fc_spec::diagnostic::{Faults, Format, render};
use fc_spec::load::load;
use fc_spec::model::Lang;
use fc_spec::source::Sources;
use proptest::prelude::*;

/// A change of a text.
#[derive(Clone, Debug)]
enum Edit {
    /// Deletes a line.
    Drop(usize),
    /// Repeats a line.
    Repeat(usize),
    /// Swaps two lines.
    Swap(usize, usize),
    /// Replaces a word by another word of the text, or by an odd one.
    Word(usize, usize),
    /// Indents a line.
    Indent(usize),
}

/// Words that are wrong in most places.
const ODD: &[&str] = &[
    "null",
    "{}",
    "[]",
    "-1",
    "0x0101",
    "type",
    "fields",
    "one_of",
    "items",
    "on",
    "017",
    "99999999999999999999",
    "\"\"",
    "unassigned",
    "[Size]",
    "Size?",
    "absent",
    "true",
    "1e400",
    "é",
    "open",
    "Color",
    "string",
    "u8",
];

fn edit() -> impl Strategy<Value = Edit> {
    let at = any::<usize>;
    prop_oneof![
        at().prop_map(Edit::Drop),
        at().prop_map(Edit::Repeat),
        (at(), at()).prop_map(|(a, b)| Edit::Swap(a, b)),
        (at(), at()).prop_map(|(a, b)| Edit::Word(a, b)),
        (at(), at()).prop_map(|(a, b)| Edit::Word(a, b)),
        at().prop_map(Edit::Indent),
    ]
}

fn apply(text: &str, edit: &Edit) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let count = lines.len().max(1);
    match edit {
        Edit::Drop(at) if !lines.is_empty() => drop(lines.remove(at % count)),
        Edit::Repeat(at) => {
            if let Some(line) = lines.get(at % count).cloned() {
                lines.insert(at % count, line);
            }
        }
        Edit::Swap(a, b) if !lines.is_empty() => lines.swap(a % count, b % count),
        Edit::Indent(at) => {
            if let Some(line) = lines.get_mut(at % count) {
                line.insert_str(0, "  ");
            }
        }
        Edit::Word(at, with) => return replace_word(text, *at, *with),
        Edit::Drop(_) | Edit::Swap(..) => {}
    }
    lines.join("\n") + "\n"
}

fn replace_word(text: &str, at: usize, with: usize) -> String {
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let words: Vec<(usize, &str)> = text
        .split(|c| !is_word(c))
        .filter(|word| !word.is_empty())
        .map(|word| (word.as_ptr() as usize - text.as_ptr() as usize, word))
        .collect();
    let Some((start, word)) = words.get(at % words.len().max(1)) else {
        return text.to_owned();
    };
    let choices = ODD.len() + words.len();
    let with = with % choices;
    let replacement = ODD
        .get(with)
        .copied()
        .or_else(|| words.get(with - ODD.len()).map(|(_, word)| *word))
        .unwrap_or_default();
    let mut out = text.to_owned();
    out.replace_range(*start..start + word.len(), replacement);
    out
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_changed_spec_is_refused_or_can_be_emitted(
        protocol in prop::collection::vec(edit(), 0..2),
        group in prop::collection::vec(edit(), 1..4),
    ) {
        let texts = good_spec::FILES.iter().zip([protocol, group]).map(|(path, edits)| {
            let text = edits.iter().fold(good_spec::file(path), |text, edit| apply(&text, edit));
            (format!("spec/{path}"), text)
        });
        let sources = Sources::from_texts(texts);
        let mut faults = Faults::new();
        let model = load(&sources, &mut faults).model();
        prop_assert_eq!(model.is_none(), faults.has_errors());
        for fault in &faults {
            let file = sources.get(fault.primary.span.file).expect("a known file");
            prop_assert!(file.text.get(fault.primary.span.start..fault.primary.span.end).is_some());
        }
        // Rendering visits every label and fix.
        let _ = render(&faults, &sources, Format::Json, Lang::En);
        if let Some(model) = model {
            let _ = inspect::json(&model);
            let _ = emit::generate(&model, &Targets::default()).expect("no audience");
        }
    }
}
