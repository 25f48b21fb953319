//! Slips made by a script. Each must cause exactly one error, at the slip.
//!
//! `makers` has a small function for each kind of slip. It finds a place in a spec by its shape, such as "a field in
//! brackets with a built-in type" or "a `zh:` in a block". It returns the change and the places where an error is
//! right. A hash of the path selects a few places for each kind, so the same spec always gives the same slips.
//!
//! The spec in `spec/` is a copy of a part of the real one. Edits of the real spec must not decide if this test passes,
//! and a whole spec per slip would take minutes. `SLIPS_OF=FOLDER` makes the slips from another spec, such as the real
//! one, and only prints the results.
//!
//! **The rule.** An error hits if its primary place touches the change, or another place that the maker names. Such a
//! place is the parent of a missing key, or the user of a removed type. The error must not begin before the first line
//! of that place. After a change of punctuation or indentation, the place is the whole line, because any of its marks
//! may be the wrong one. Warnings count like errors. A slip passes if there is exactly one error and it hits.

mod change;
mod makers;
mod place;

use change::{Change, Slip, hits};
use fc_spec::diagnostic::{Diagnostic, Faults};
use fc_spec::load::load;
use fc_spec::source::Sources;
use place::Spec;
use rayon::iter::{IntoParallelRefIterator as _, ParallelIterator as _};
use std::collections::{BTreeMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

/// Maximum number of slips of each kind.
const OF_A_KIND: usize = 2;
/// Minimum numbers of slips and of their kinds, so that the shares are meaningful.
const SLIPS: usize = 300;
const KINDS: usize = 40;
/// Minimum share in percent: of slips with one error in the right place, and of pairs with both errors found.
const SHARE: f64 = 95.0;
/// Number of pairs of slips.
const PAIRS: usize = 100;

/// Minimum distance in bytes between the two slips of a pair in one file.
const APART: usize = 1000;
/// Kinds of slips that hide other errors of the file until they are fixed. Many of them split the file or cut it off.
const HIDES: &[&str] = &[
    "a conflict of two sides",
    "a conflict around an operation",
    "the beginning of a conflict left",
    "the middle of a conflict left",
    "the end of a conflict left",
    "one side of a conflict and its end left",
    "a second document in the middle",
    "a second document between operations",
    "the end of a document in the middle",
    "an alias left",
    "an alias left in brackets",
    "a merge key",
    "a file cut behind a key",
    "a file cut in a row in brackets",
    "a file cut in a quoted text",
    "a file cut in a key",
    "a file without a word",
];

/// The result of a slip.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Verdict {
    /// One error, in the right place.
    One,
    /// One error, elsewhere.
    Elsewhere,
    /// Several errors.
    Several,
    /// No error.
    Unnoticed,
}

fn spec() -> Spec {
    Spec::read(
        &other()
            .unwrap_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/slips_made/spec")),
    )
}

/// Returns the folder of another spec, if `SLIPS_OF` names one.
fn other() -> Option<PathBuf> {
    std::env::var_os("SLIPS_OF").map(PathBuf::from)
}

/// The spec, its slips, the result of each, and the kinds that fit no place.
struct Corpus {
    spec: Spec,
    slips: Vec<Slip>,
    judged: Vec<(Verdict, String)>,
    without: Vec<&'static str>,
}

static CORPUS: LazyLock<Corpus> = LazyLock::new(|| {
    let spec = spec();
    let (slips, without) = slips(&spec);
    let judged = slips.par_iter().map(|slip| judge(&spec, slip)).collect();
    Corpus {
        spec,
        slips,
        judged,
        without,
    }
});

/// FNV-1a: the same on every machine and in every version.
fn hash(text: &str) -> u64 {
    text.bytes().fold(0xCBF2_9CE4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01B3)
    })
}

/// Returns the slips, and the kinds that fit no place of the spec.
fn slips(spec: &Spec) -> (Vec<Slip>, Vec<&'static str>) {
    let (mut slips, mut without) = (Vec::new(), Vec::new());
    let mut known = HashSet::new();
    for maker in makers::all() {
        let mut candidates: Vec<(String, Change)> = spec
            .each()
            .filter_map(|at| {
                Some((
                    format!("{} {}", spec.files[at.file].0, at.path.join(".")),
                    (maker.make)(at)?,
                ))
            })
            .collect();
        candidates.sort_by_key(|(path, _)| hash(&format!("{}{path}", maker.kind)));
        let before = slips.len();
        for (title, change) in candidates {
            if slips.len() == before + OF_A_KIND {
                break;
            }
            let files = change.apply(spec);
            let whole: String = files.iter().map(|(_, text)| text.as_str()).collect();
            if files != spec.files && known.insert(hash(&whole)) {
                let kind = maker.kind;
                slips.push(Slip {
                    kind,
                    title,
                    change,
                });
            }
        }
        if slips.len() == before {
            without.push(maker.kind);
        }
    }
    (slips, without)
}

fn faults(sources: &Sources) -> Faults {
    let mut faults = Faults::new();
    let _ = load(sources, &mut faults);
    faults.sort();
    faults
}

fn judge(spec: &Spec, slip: &Slip) -> (Verdict, String) {
    let sources = slip.sources(spec);
    let targets = slip.change.targets(spec, &slip.change);
    let faults = faults(&sources);
    let is_hit = |fault: &Diagnostic| hits(&sources, fault.primary.span, &targets);
    let verdict = match faults.iter().as_slice() {
        [] => Verdict::Unnoticed,
        [one] if is_hit(one) => Verdict::One,
        [_] => Verdict::Elsewhere,
        _ => Verdict::Several,
    };
    let mut told = format!("{verdict:?}: {} at {}\n", slip.kind, slip.title);
    for (file, at) in &targets {
        if let Some((id, _)) = sources.iter().nth(*file) {
            let at = sources.line_col(fc_spec::source::Span::point(id, at.start));
            told += &format!("    should be at {}:{}\n", at.line, at.column);
        }
    }
    for fault in faults.iter().take(12) {
        let at = sources.line_col(fault.primary.span);
        let mark = if is_hit(fault) { "*" } else { " " };
        told += &format!(
            "  {mark} {} {}:{}:{} {}\n",
            fault.code,
            sources.path(fault.primary.span),
            at.line,
            at.column,
            fault.message.en
        );
    }
    if faults.len() > 12 {
        told += &format!("    and {} more\n", faults.len() - 12);
    }
    (verdict, told)
}

fn share(part: usize, whole: usize) -> f64 {
    100.0 * part as f64 / whole.max(1) as f64
}

#[test]
fn the_spec_has_no_fault_before() {
    let sources = spec().sources();
    let faults = faults(&sources);
    let all: Vec<_> = faults
        .iter()
        .map(|fault| {
            format!(
                "{} {} {}",
                fault.code,
                sources.path(fault.primary.span),
                fault.message.en
            )
        })
        .collect();
    assert!(all.is_empty(), "{all:#?}");
}

#[test]
#[ignore = "takes long"]
fn a_slip_is_one_error_at_its_place() {
    let Corpus {
        slips,
        judged,
        without,
        ..
    } = &*CORPUS;
    let mut table: BTreeMap<&str, [usize; 4]> = BTreeMap::new();
    for (slip, (verdict, _)) in slips.iter().zip(judged) {
        table.entry(slip.kind).or_default()[*verdict as usize] += 1;
    }
    println!(
        "{:<55} {:>4} {:>9} {:>7} {:>4}",
        "kind", "one", "elsewhere", "several", "none"
    );
    for (kind, [one, elsewhere, several, none]) in &table {
        println!("{kind:<55} {one:>4} {elsewhere:>9} {several:>7} {none:>4}");
    }
    println!("\nThe rest:");
    for (verdict, told) in judged {
        if *verdict != Verdict::One {
            println!("{told}");
        }
    }
    println!("without a place in this spec: {without:?}");
    let count = |wanted: Verdict| {
        judged
            .iter()
            .filter(|(verdict, _)| *verdict == wanted)
            .count()
    };
    let share = share(count(Verdict::One), slips.len());
    println!(
        "{} slips of {} kinds: {} one fault in the right place ({share:.1} %), {} elsewhere, {} several, {} unnoticed",
        slips.len(),
        table.len(),
        count(Verdict::One),
        count(Verdict::Elsewhere),
        count(Verdict::Several),
        count(Verdict::Unnoticed)
    );
    if other().is_none() {
        assert!(
            slips.len() >= SLIPS && table.len() >= KINDS,
            "too few slips"
        );
        assert!(
            share >= SHARE,
            "only {share:.1} % of the slips are one fault in the right place; --nocapture lists the rest"
        );
    }
}

/// Two slips that are far apart cause two errors. Neither hides the other.
#[test]
#[ignore = "takes long"]
fn two_slips_are_two_faults() {
    let Corpus {
        spec,
        slips,
        judged,
        ..
    } = &*CORPUS;
    let told = slips.iter().zip(judged);
    let told =
        told.filter(|(slip, (verdict, _))| *verdict == Verdict::One && !HIDES.contains(&slip.kind));
    let mut alone: Vec<&Slip> = told.map(|(slip, _)| slip).collect();
    alone.sort_by_key(|slip| hash(&slip.title));
    let mut pairs = Vec::new();
    for step in 1..alone.len() {
        for (first, second) in alone.iter().zip(alone.iter().cycle().skip(step)) {
            let is_taken = pairs.len() == PAIRS || !first.change.is_apart(&second.change, APART);
            // Half of the pairs are in one file.
            let wanted = pairs.len() % 2 == 0;
            if !is_taken && first.change.shares_file(&second.change) == wanted {
                pairs.push((*first, *second));
            }
        }
    }
    let judged: Vec<_> = pairs
        .par_iter()
        .map(|(first, second)| {
            let both = first.change.with(&second.change);
            let sources = Sources::from_texts(both.apply(spec));
            let faults = faults(&sources);
            let is_found = |slip: &Slip| {
                let targets = slip.change.targets(spec, &both);
                faults
                    .iter()
                    .any(|fault| hits(&sources, fault.primary.span, &targets))
            };
            (is_found(first), is_found(second))
        })
        .collect();
    for ((first, second), found) in pairs.iter().zip(&judged) {
        if *found != (true, true) {
            println!(
                "{found:?}: {} at {}\n    and {} at {}",
                first.kind, first.title, second.kind, second.title
            );
        }
    }
    let both = judged
        .iter()
        .filter(|found| **found == (true, true))
        .count();
    let share = share(both, pairs.len());
    println!("{} pairs: both found of {both} ({share:.1} %)", pairs.len());
    if other().is_none() {
        assert_eq!(pairs.len(), PAIRS);
        assert!(
            share >= SHARE,
            "of only {share:.1} % of the pairs both are found"
        );
    }
}
