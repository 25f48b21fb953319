//! Is there a dead line in the spec?
//!
//! Changes every scalar of every spec file, keys included, one at a time, in memory. Each change
//! must either be refused by the checks or make at least one generated file stale; whatever can be
//! changed without effect is listed, and the exit status is 1.
//!
//! ```text
//! cargo run --release -p fc-codegen --example mutate [SPEC_DIR]
//! ```

use fc_codegen::emit;
use fc_codegen::product::Artifact;
use fc_codegen::target::Targets;
use fc_spec::diagnostic::Faults;
use fc_spec::load;
use fc_spec::model::Model;
use fc_spec::syntax::{self, Node, NodeKind, SourceFile, Sources, Style};
use std::path::Path;
use std::process::ExitCode;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

/// A scalar to change: file, byte range, and the text to put there.
struct Mutation {
    file: usize,
    start: usize,
    end: usize,
    text: String,
}

/// What came of a change.
enum Outcome {
    Refused,
    Stale,
    Dead,
}

/// The products one by one, those first that notice most and cost least.
const PRODUCTS: [fn(&Model, &Targets) -> Vec<Artifact>; 3] =
    [emit::markdown::emit, emit::rust::emit, emit::vectors::emit];

fn main() -> ExitCode {
    let spec = std::env::args().nth(1).unwrap_or_else(|| "spec".to_owned());
    let mut faults = Faults::default();
    let sources = syntax::read_dir(Path::new("."), Path::new(&spec), &mut faults);
    let Some(model) = load::load(&sources, &mut faults).model() else {
        eprintln!("the spec has faults; run `fc check`");
        return ExitCode::from(2);
    };
    let baseline: Vec<Vec<Artifact>> = PRODUCTS
        .iter()
        .map(|emit| emit(&model, &Targets::default()))
        .collect();
    let files: Vec<(String, String)> = sources
        .iter()
        .map(|(_, file)| (file.path.clone(), file.text.clone()))
        .collect();
    let mutations = mutations(&sources);

    let started = Instant::now();
    let next = AtomicUsize::new(0);
    let workers = std::thread::available_parallelism().map_or(1, usize::from);
    let outcomes: Vec<(usize, Outcome)> = std::thread::scope(|scope| {
        let handles: Vec<_> = (0..workers)
            .map(|_| {
                scope.spawn(|| {
                    let mut mine = Vec::new();
                    loop {
                        let index = next.fetch_add(1, Ordering::Relaxed);
                        let Some(mutation) = mutations.get(index) else {
                            return mine;
                        };
                        mine.push((index, try_one(&files, mutation, &baseline)));
                        if index % 500 == 499 {
                            eprintln!("{} of {} tried", index + 1, mutations.len());
                        }
                    }
                })
            })
            .collect();
        handles
            .into_iter()
            .flat_map(|handle| handle.join().unwrap_or_default())
            .collect()
    });

    let refused = count(&outcomes, |outcome| matches!(outcome, Outcome::Refused));
    let stale = count(&outcomes, |outcome| matches!(outcome, Outcome::Stale));
    let mut dead: Vec<usize> = outcomes
        .iter()
        .filter(|(_, outcome)| matches!(outcome, Outcome::Dead))
        .map(|(index, _)| *index)
        .collect();
    dead.sort_unstable();
    for mutation in dead.iter().filter_map(|index| mutations.get(*index)) {
        if let Some((path, text)) = files.get(mutation.file) {
            let before = text.get(..mutation.start).unwrap_or_default();
            let line = before.matches('\n').count() + 1;
            let was = text.get(mutation.start..mutation.end).unwrap_or_default();
            println!("{path}:{line}: no effect: {was:?} → {:?}", mutation.text);
        }
    }
    println!(
        "{} scalars changed one at a time: {refused} refused, {stale} made an output stale, {} without effect ({} s)",
        outcomes.len(),
        dead.len(),
        started.elapsed().as_secs()
    );
    // A thread that died took its outcomes with it.
    if dead.is_empty() && outcomes.len() == mutations.len() {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

fn count(outcomes: &[(usize, Outcome)], wanted: fn(&Outcome) -> bool) -> usize {
    outcomes
        .iter()
        .filter(|(_, outcome)| wanted(outcome))
        .count()
}

fn try_one(files: &[(String, String)], mutation: &Mutation, baseline: &[Vec<Artifact>]) -> Outcome {
    let sources = Sources::from_texts(files.iter().enumerate().map(|(index, (path, text))| {
        let mut text = text.clone();
        if index == mutation.file {
            text.replace_range(mutation.start..mutation.end, &mutation.text);
        }
        (path.clone(), text)
    }));
    let mut faults = Faults::default();
    let Some(model) = load::load(&sources, &mut faults).model() else {
        return Outcome::Refused;
    };
    let changed = PRODUCTS
        .iter()
        .zip(baseline)
        .any(|(emit, before)| emit(&model, &Targets::default()) != *before);
    if changed {
        Outcome::Stale
    } else {
        Outcome::Dead
    }
}

fn mutations(sources: &Sources) -> Vec<Mutation> {
    let mut mutations = Vec::new();
    for (index, (id, file)) in sources.iter().enumerate() {
        let mut faults = Faults::default();
        if let Some(tree) = syntax::parse(id, &file.text, &mut faults) {
            collect(tree.root(), index, file, &mut mutations);
        }
    }
    mutations
}

fn collect(node: Node<'_>, file: usize, source: &SourceFile, into: &mut Vec<Mutation>) {
    match node.kind() {
        NodeKind::Null => {}
        NodeKind::Scalar(scalar) => {
            let (start, end) = (node.span().start, node.span().end);
            let written = source.text.get(start..end).unwrap_or_default();
            let text = match scalar.style {
                Style::Plain | Style::Block => other(written),
                // Inside the quotes.
                Style::Quoted => {
                    let quote = written.get(..1).unwrap_or_default();
                    let inside = 1..written.len().saturating_sub(1);
                    let inner = written.get(inside).unwrap_or_default();
                    format!("{quote}{}{quote}", other(inner))
                }
            };
            into.push(Mutation {
                file,
                start,
                end,
                text,
            });
        }
        NodeKind::Sequence(items) => {
            for item in items {
                collect(item, file, source, into);
            }
        }
        NodeKind::Mapping(entries) => {
            for entry in entries {
                collect(entry.key, file, source, into);
                collect(entry.value, file, source, into);
            }
        }
    }
}

/// The nearest other value: a number counts up, a truth value flips, a text grows by a letter.
fn other(text: &str) -> String {
    if let Some(digits) = text.strip_prefix("0x")
        && let Ok(number) = u64::from_str_radix(digits, 16)
    {
        return format!("0x{:0width$X}", number + 1, width = digits.len());
    }
    if let Ok(number) = text.parse::<i128>() {
        return (number + 1).to_string();
    }
    match text {
        "true" => "false".to_owned(),
        "false" => "true".to_owned(),
        _ if text.chars().last().is_some_and(|last| !last.is_ascii()) => format!("{text}改"),
        _ => format!("{text}x"),
    }
}
