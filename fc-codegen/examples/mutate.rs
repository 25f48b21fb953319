//! Finds lines of the spec that have no effect.
//!
//! Changes every scalar of every spec file in memory, keys included, one at a time. The checks must refuse each change,
//! or at least one generated file must become stale. The program lists changes without effect and then exits with
//! status 1.
//!
//! ```text
//! cargo run --release --example mutate [PART/PARTS]
//! ```
//!
//! A run takes minutes. `3/8` selects the third of eight parts, each with every eighth scalar.

use fc_codegen::emit;
use fc_codegen::product::Artifact;
use fc_codegen::target::Targets;
use fc_spec::diagnostic::Faults;
use fc_spec::load::Trees;
use fc_spec::model::{Languages, Model};
use fc_spec::source::{FileId, SourceFile};
use fc_spec::syntax::{self, Node, NodeKind, Style};
use std::collections::HashMap;
use std::path::Path;
use std::process::ExitCode;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

/// A scalar to change: file, byte range and replacement.
struct Mutation {
    file: FileId,
    start: usize,
    end: usize,
    text: String,
}

/// The outcome of a change.
enum Outcome {
    Refused,
    Stale,
    Dead,
}

/// The products other than the pages.
const PRODUCTS: [fn(&Model, &Targets) -> Vec<Artifact>; 2] =
    [emit::rust::emit, emit::vectors::emit];

/// The output for the unchanged spec.
struct Baseline {
    trees: Trees,
    targets: Targets,
    /// The pages by their paths.
    pages: HashMap<String, Artifact>,
    others: Vec<Vec<Artifact>>,
}

impl Baseline {
    /// Returns `true` if the output for `model` differs from the baseline. Pages come first, because most changes show
    /// there. It stops at the first page that differs.
    fn differs(&self, model: &Model) -> bool {
        let mut pages = 0;
        let are_same = emit::markdown::emit_while(model, &self.targets, |page| {
            pages += 1;
            self.pages.get(&page.path) == Some(&page)
        });
        let mut others = PRODUCTS.iter().zip(&self.others);
        !are_same
            || pages < self.pages.len()
            || others.any(|(emit, was)| emit(model, &self.targets) != *was)
    }
}

fn main() -> ExitCode {
    let told = std::env::args().nth(1);
    let Some((part, parts)) = part(told.as_deref().unwrap_or("1/1")) else {
        eprintln!("which part? such as 3/8");
        return ExitCode::from(2);
    };
    let mut faults = Faults::default();
    let sources = syntax::read_dir(Path::new("."), Path::new("spec"), &mut faults);
    let trees = Trees::new(&sources);
    let Some(model) = trees.load(Languages::All, &mut faults).model() else {
        eprintln!("the spec has faults; run `fcproto check`");
        return ExitCode::from(2);
    };
    let mutations = mutations(&trees).into_iter();
    let mutations: Vec<_> = mutations.skip(part - 1).step_by(parts).collect();
    let targets = Targets::default();
    let pages = emit::markdown::emit(&model, &targets).into_iter();
    let baseline = Baseline {
        trees,
        pages: pages.map(|page| (page.path.clone(), page)).collect(),
        others: PRODUCTS.map(|emit| emit(&model, &targets)).into(),
        targets,
    };

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
                        mine.push((index, try_one(mutation, &baseline)));
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
        if let Some(SourceFile { path, text, .. }) = sources.get(mutation.file) {
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
    // If a thread panics, its outcomes are missing.
    if dead.is_empty() && outcomes.len() == mutations.len() {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

/// Parses `3/8`. The first number counts from 1 to the second.
fn part(text: &str) -> Option<(usize, usize)> {
    let (part, parts) = text.split_once('/')?;
    let (part, parts) = (part.parse().ok()?, parts.parse().ok()?);
    (1..=parts).contains(&part).then_some((part, parts))
}

fn count(outcomes: &[(usize, Outcome)], wanted: fn(&Outcome) -> bool) -> usize {
    outcomes
        .iter()
        .filter(|(_, outcome)| wanted(outcome))
        .count()
}

fn try_one(mutation: &Mutation, baseline: &Baseline) -> Outcome {
    let mut sources = baseline.trees.sources().clone();
    if let Some(file) = sources.get(mutation.file) {
        let mut text = file.text.clone();
        text.replace_range(mutation.start..mutation.end, &mutation.text);
        let file = SourceFile::new(file.path.as_str(), text);
        sources.replace(file);
    }
    let mut faults = Faults::default();
    match baseline
        .trees
        .with(&sources)
        .load(Languages::All, &mut faults)
        .model()
    {
        None => Outcome::Refused,
        Some(model) if baseline.differs(&model) => Outcome::Stale,
        Some(_) => Outcome::Dead,
    }
}

fn mutations(trees: &Trees) -> Vec<Mutation> {
    let mut mutations = Vec::new();
    for (id, file) in trees.sources().iter() {
        if let Some(tree) = trees.tree(id) {
            collect(tree.root(), id, file, &mut mutations);
        }
    }
    mutations
}

fn collect(node: Node<'_>, file: FileId, source: &SourceFile, into: &mut Vec<Mutation>) {
    match node.kind() {
        NodeKind::Null => {}
        NodeKind::Scalar(scalar) => {
            let (start, end) = (node.span().start, node.span().end);
            let written = source.text.get(start..end).unwrap_or_default();
            let text = match scalar.style {
                Style::Plain | Style::Block => other(written),
                // The quotes stay.
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

/// Returns the nearest other value: the next number, the opposite boolean, or the text with one more letter.
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
