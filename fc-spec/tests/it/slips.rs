//! Slips that owners make in a spec, and the errors that each causes: `slips/*.txt`.
//!
//! A slip changes the small valid spec in `good/`. It has a title (`# …`) and a file (`@ …`, by default
//! `commands/demo.yaml`). Its new lines (`+…`) replace the old ones (`-…`), or go to the end of the file if there are
//! none. The lines with `>` are all errors. `BLESS=1` writes them.

use crate::both_languages;
use crate::declared_faults;
use crate::syntax_support;
use std::fmt::Write as _;
use std::path::Path;

use fc_spec::diagnostic::{Diagnostic, Faults, Severity};
use fc_spec::load::load;
use fc_spec::source::Sources;

const FILES: [&str; 2] = ["protocol.yaml", "commands/demo.yaml"];

#[derive(Default)]
struct Slip {
    title: String,
    file: Option<String>,
    old: String,
    new: String,
}

impl Slip {
    fn all(text: &str) -> Vec<Self> {
        let mut slips: Vec<Self> = Vec::new();
        for line in text.lines().filter(|line| !line.starts_with('>')) {
            if let Some(title) = line.strip_prefix("# ") {
                slips.push(Self {
                    title: title.to_owned(),
                    ..Self::default()
                });
                continue;
            }
            let Some(slip) = slips.last_mut() else {
                continue;
            };
            match line.split_at_checked(1) {
                Some(("@", file)) => slip.file = Some(file.trim().to_owned()),
                Some(("-", line)) => slip.old += &format!("{line}\n"),
                Some(("+", line)) => slip.new += &format!("{line}\n"),
                None => {}
                Some(_) => panic!("{line:?}"),
            }
        }
        slips
    }

    fn file(&self) -> &str {
        self.file.as_deref().unwrap_or("commands/demo.yaml")
    }

    /// Returns the good spec with the slip.
    fn sources(&self) -> Sources {
        let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/good");
        let files = FILES.map(|file| {
            let text =
                std::fs::read_to_string(directory.join(file)).expect("a file of the good spec");
            let text = match (file == self.file(), self.old.as_str()) {
                (false, _) => text,
                (true, "") => text + &self.new,
                (true, old) => {
                    assert!(text.contains(old), "{}: no such lines", self.title);
                    text.replacen(old, &self.new, 1)
                }
            };
            (format!("spec/{file}"), text)
        });
        Sources::from_texts(files)
    }
}

fn faults(sources: &Sources) -> Faults {
    let mut faults = Faults::new();
    let _ = load(sources, &mut faults);
    faults.sort();
    faults
}

/// Renders an error in the notation of `slips/*.txt`: its main points in few lines.
fn show(sources: &Sources, fault: &Diagnostic) -> String {
    let at = sources.line_col(fault.primary.span);
    let path = sources.path(fault.primary.span).trim_start_matches("spec/");
    let level = match fault.severity {
        Severity::Error => "",
        Severity::Warning => " (warning)",
    };
    let mut out = String::new();
    let _ = writeln!(
        out,
        "> {}{level} {path}:{}:{} {}",
        fault.code, at.line, at.column, fault.message.en
    );
    for label in &fault.secondary {
        let at = sources.line_col(label.span);
        let _ = writeln!(out, ">   {}:{} {}", at.line, at.column, label.text.en);
    }
    for note in &fault.notes {
        let _ = writeln!(out, ">   note: {}", note.en);
    }
    for fix in &fault.fixes {
        let old = sources.slice(fix.span);
        let _ = writeln!(
            out,
            ">   {}: {old:?} -> {:?}",
            fix.message.en, fix.replacement
        );
    }
    out
}

fn each_file(mut visit: impl FnMut(&Path, &str)) {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/slips");
    for path in syntax_support::files(&directory, "txt") {
        visit(&path, &std::fs::read_to_string(&path).expect("slips"));
    }
}

#[test]
fn every_slip_has_the_right_error() {
    each_file(|path, text| {
        let mut actual = String::new();
        for slip in Slip::all(text) {
            if !actual.is_empty() {
                actual.push('\n');
            }
            let _ = writeln!(actual, "# {}", slip.title);
            if let Some(file) = &slip.file {
                let _ = writeln!(actual, "@ {file}");
            }
            for (sign, lines) in [('-', &slip.old), ('+', &slip.new)] {
                for line in lines.lines() {
                    let _ = writeln!(actual, "{sign}{line}");
                }
            }
            let sources = slip.sources();
            let faults = faults(&sources);
            for fault in &faults {
                actual += &show(&sources, fault);
            }
            if faults.is_empty() {
                actual += "> nothing\n";
            }
        }
        syntax_support::golden(path, &actual);
    });
}

#[test]
fn every_slip_is_named_in_both_languages() {
    let mut objections = Vec::new();
    each_file(|_, text| {
        for slip in Slip::all(text) {
            let faults = faults(&slip.sources());
            objections.extend(both_languages::objections(&slip.title, &faults));
        }
    });
    assert!(objections.is_empty(), "{}", objections.join("\n"));
}

#[test]
fn slips_lie_at_the_keys_that_declare_them() {
    let mut wrong = Vec::new();
    each_file(|_, text| {
        for slip in Slip::all(text) {
            let sources = slip.sources();
            let (faults, mut raised) = (faults(&sources), declared_faults::Raised::new());
            wrong.extend(declared_faults::undeclared(
                &slip.title,
                &sources,
                &faults,
                &mut raised,
            ));
        }
    });
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The first fix is the likeliest. With it, the line of the error has no error.
#[test]
fn the_first_fix_mends_a_slip() {
    each_file(|_, text| {
        for slip in Slip::all(text) {
            let sources = slip.sources();
            for fault in &faults(&sources) {
                let Some(fix) = fault.fixes.first() else {
                    continue;
                };
                let texts = sources.iter().map(|(id, file)| {
                    let mut text = file.text.clone();
                    if id == fix.span.file {
                        text.replace_range(fix.span.start..fix.span.end, &fix.replacement);
                    }
                    (file.path.clone(), text)
                });
                let mended = Sources::from_texts(texts);
                let found = faults(&mended);
                let is_there = |other: &&Diagnostic| {
                    other.severity == Severity::Error
                        && mended.line(other.primary.span) == sources.line(fault.primary.span)
                };
                if let Some(other) = found.iter().find(is_there) {
                    panic!(
                        "{}: {} gives\n{}",
                        slip.title,
                        fix.message.en,
                        show(&mended, other)
                    );
                }
            }
        }
    });
}
