//! Errors for people.

use std::ops::Range;

use annotate_snippets::{
    Annotation, AnnotationKind, Group, Level, Origin, Patch, Renderer, Snippet,
};

use super::super::{Diagnostic, Faults, Fix, Label, Severity};
use crate::model::Lang;
use crate::source::{FileId, Sources, Span};

/// The maximum length of a shown line. For longer lines, the output names only the place.
const LINE_BYTES: usize = 2000;
/// The maximum distance in lines between places in one snippet.
const NEAR: usize = 20;

pub(super) fn render(faults: &Faults, sources: &Sources, colored: bool, lang: Lang) -> String {
    let renderer = if colored {
        Renderer::styled()
    } else {
        Renderer::plain()
    };
    let mut out = String::new();
    for fault in faults {
        out.push_str(&renderer.render(&report(fault, sources, lang)));
        out.push_str("\n\n");
    }
    out
}

fn report<'a>(fault: &'a Diagnostic, sources: &'a Sources, lang: Lang) -> Vec<Group<'a>> {
    let level = match fault.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
    };
    let mut main = level
        .with_name(fault.severity.word(lang))
        .primary_title(lang.text(&fault.message))
        .id(fault.code.as_str())
        .elements([] as [Snippet<'_, Annotation<'_>>; 0]);
    for cluster in clusters(fault, sources) {
        main = cluster.show(main, sources, lang);
    }
    for note in &fault.notes {
        main = main.element(note_level(lang).message(untrusted(lang.text(note))));
    }
    std::iter::once(main)
        .chain(fault.fixes.iter().map(|fix| help(fix, sources, lang)))
        .collect()
}

/// Nearby places of one file.
struct Cluster<'a> {
    file: FileId,
    /// First and last line, counted from 1.
    lines: Range<usize>,
    labels: Vec<(AnnotationKind, &'a Label)>,
}

/// Groups the nearby places of an error, with the primary place first.
fn clusters<'a>(fault: &'a Diagnostic, sources: &Sources) -> Vec<Cluster<'a>> {
    let primary = std::iter::once((AnnotationKind::Primary, &fault.primary));
    let secondary = fault
        .secondary
        .iter()
        .map(|label| (AnnotationKind::Context, label));
    let mut clusters: Vec<Cluster<'a>> = Vec::new();
    for (kind, label) in primary.chain(secondary) {
        let line = sources.line_col(label.span).line;
        let near = clusters.iter_mut().find(|cluster| {
            cluster.file == label.span.file
                && line + NEAR >= cluster.lines.start
                && line <= cluster.lines.end + NEAR
        });
        match near {
            Some(cluster) => {
                cluster.lines.start = cluster.lines.start.min(line);
                cluster.lines.end = cluster.lines.end.max(line);
                cluster.labels.push((kind, label));
            }
            None => clusters.push(Cluster {
                file: label.span.file,
                lines: line..line,
                labels: vec![(kind, label)],
            }),
        }
    }
    clusters
}

impl<'a> Cluster<'a> {
    fn show(&self, group: Group<'a>, sources: &'a Sources, lang: Lang) -> Group<'a> {
        let Some(excerpt) = Excerpt::new(sources, self.file, &self.lines) else {
            return self.name(group, sources, lang);
        };
        let annotations = self.labels.iter().map(|(kind, label)| {
            let text = (!label.text.is_empty()).then(|| lang.text(&label.text));
            kind.span(excerpt.range(label.span)).label(text)
        });
        let snippet = Snippet::source(excerpt.text)
            .path(excerpt.path)
            .line_start(self.lines.start)
            .annotations(annotations);
        group.element(snippet)
    }

    /// Renders only the positions of the places.
    fn name(&self, mut group: Group<'a>, sources: &'a Sources, lang: Lang) -> Group<'a> {
        for (_, label) in &self.labels {
            let mut origin = Origin::path(sources.path(label.span));
            if sources
                .get(label.span.file)
                .is_some_and(|file| !file.text.is_empty())
            {
                let at = sources.line_col(label.span);
                origin = origin.line(at.line).char_column(at.column);
            }
            group = group.element(origin);
            if !label.text.is_empty() {
                group = group.element(note_level(lang).message(untrusted(lang.text(&label.text))));
            }
        }
        group
    }
}

/// Returns the level of a note.
fn note_level(lang: Lang) -> Level<'static> {
    match lang {
        Lang::Zh => Level::NOTE.with_name("说明"),
        Lang::En => Level::NOTE,
    }
}

fn help<'a>(fix: &'a Fix, sources: &'a Sources, lang: Lang) -> Group<'a> {
    let title = Level::HELP
        .with_name(lang.pick("建议", "help"))
        .secondary_title(untrusted(lang.text(&fix.message)));
    let first = sources.line_col(fix.span).line;
    let last = sources.end_line_col(fix.span).line;
    let excerpt = Excerpt::new(sources, fix.span.file, &(first..last));
    match excerpt.and_then(|excerpt| Some((excerpt.exact(fix.span)?, excerpt))) {
        Some((range, excerpt)) => title.element(
            Snippet::source(excerpt.text)
                .path(excerpt.path)
                .line_start(first)
                .patch(Patch::new(range, fix.replacement.as_str())),
        ),
        None => Group::with_title(title),
    }
}

/// Removes terminal control characters from a text that may come from the spec.
fn untrusted(text: &str) -> String {
    annotate_snippets::normalize_untrusted_str(text)
}

/// Some lines of a file.
struct Excerpt<'a> {
    path: &'a str,
    text: &'a str,
    /// The byte of the file at which they start.
    start: usize,
}

impl<'a> Excerpt<'a> {
    /// Returns the lines `lines.start` to `lines.end`, both included. Returns `None` if they are empty or one of them
    /// is too long.
    fn new(sources: &'a Sources, file: FileId, lines: &Range<usize>) -> Option<Self> {
        let file = sources.get(file)?;
        let (start, end) = file.lines(lines.start, lines.end)?;
        let text = file.text.get(start..end)?;
        let fits = !file.text.is_empty() && text.lines().all(|line| line.len() <= LINE_BYTES);
        fits.then_some(Self {
            path: &file.path,
            text,
            start,
        })
    }

    /// Returns a span relative to the excerpt, cut off at the end of its first line. The first line is enough to
    /// identify a mapping.
    fn range(&self, span: Span) -> Range<usize> {
        let end = span.end.min(self.start + self.text.len());
        let range = self.exact(Span { end, ..span }).unwrap_or_default();
        let text = self.text.get(range.clone()).unwrap_or_default();
        let line = text.lines().next().unwrap_or_default();
        range.start..range.start + line.trim_end().len()
    }

    /// Returns a span relative to the excerpt, or `None` if it exceeds it.
    fn exact(&self, span: Span) -> Option<Range<usize>> {
        let range = span.start.checked_sub(self.start)?..span.end.checked_sub(self.start)?;
        self.text.get(range.clone()).map(|_| range)
    }
}
