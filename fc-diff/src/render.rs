//! Renders findings for people and for other programs.

use crate::finding::{Deployment, Finding, Spot};
use crate::rule::{Language, pick};
use crate::version::Version;
use fc_spec::index::DefSite;
use fc_spec::model::Lang;
use fc_spec::model::Waiver;
use fc_spec::source::Span;
use serde::Serialize;
use std::fmt::Write as _;

/// An output format of findings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Text for a terminal, with the places of both versions.
    Text,
    /// A list of objects with stable keys.
    Json,
    /// A Markdown table for a pull request or a changelog.
    Markdown,
    /// Annotations of a GitHub pull request, at the places of the new version.
    Github,
    /// A SARIF 2.1.0 log.
    Sarif,
}

/// Renders the findings of [`diff`](crate::diff) on two versions.
#[must_use]
pub fn render(
    findings: &[Finding],
    [old, new]: [&Version; 2],
    format: Format,
    lang: Lang,
) -> String {
    match format {
        Format::Text => text(findings, old, new, lang),
        Format::Json => json(findings, lang),
        Format::Markdown => markdown(findings, lang),
        Format::Github => github(findings, new, lang),
        Format::Sarif => sarif(findings, new, lang),
    }
}

/// Returns `true` if the subject of a finding is in this file, in either version. A subject without a place counts as
/// being where its owner is.
pub(crate) fn stands_in(finding: &Finding, path: &str, [old, new]: [&Version; 2]) -> bool {
    let owner = |version: &Version| {
        finding.subject.split('.').find_map(|name| {
            let name = name.to_owned();
            place(&[Spot { kind: "", name }], version)
        })
    };
    let is_there = |(spots, version): (&Vec<Spot>, &Version)| {
        let found = place(spots, version).or_else(|| owner(version));
        found.is_some_and(|(file, _)| file == path)
    };
    [(&finding.old, old), (&finding.new, new)]
        .into_iter()
        .any(is_there)
}

/// A line of a version: `-` or `+`, the file, the line number and the line.
type Excerpt<'v> = (char, &'v str, usize, &'v str);

/// Returns a line of each version that shows the finding. Prefers the first line that contains the changed value and is
/// not in the other version. The line with the name is the fallback.
fn excerpts<'v>(finding: &Finding, [old, new]: [&'v Version; 2]) -> Vec<Excerpt<'v>> {
    let side = |spots: &[Spot], version: &'v Version| {
        let place = place_of(spots, version);
        place.map(|place| (place.key, lines(place.whole, version), version))
    };
    let (was, is) = (side(&finding.old, old), side(&finding.new, new));
    let [from, to] = &finding.values;
    let sides = [('-', &was, &is, from), ('+', &is, &was, to)];
    let excerpts = sides.into_iter().filter_map(|(sign, side, other, value)| {
        let (key, own, version) = side.as_ref()?;
        let others = other.as_ref().map(|(_, lines, _)| lines);
        let is_new = |line: &str| !others.into_iter().flatten().any(|(_, it)| *it == line);
        let shows = |line: &str| !value.is_empty() && line.contains(value) && is_new(line);
        let named = version.sources.line(*key);
        let line = own.iter().find(|(_, line)| shows(line));
        let (number, line) = line.or_else(|| own.iter().find(|(number, _)| *number == named))?;
        Some((sign, version.sources.path(*key), *number, *line))
    });
    excerpts.collect()
}

/// Returns the lines of a span with their numbers, trimmed.
fn lines(span: Span, version: &Version) -> Vec<(usize, &str)> {
    let Some(file) = version.sources.get(span.file) else {
        return Vec::new();
    };
    let (first, last) = (file.line(span.start), file.line(span.end));
    let text = file.lines(first, last);
    let text = text.and_then(|(start, end)| file.text.get(start..end));
    let lines = text.unwrap_or_default().lines().map(str::trim);
    (first..).zip(lines).collect()
}

/// Returns the file and line of a place.
fn place(spots: &[Spot], version: &Version) -> Option<(String, usize)> {
    let found = place_of(spots, version)?.key;
    Some((
        version.sources.path(found).to_owned(),
        version.sources.line(found),
    ))
}

fn place_of<'v>(spots: &[Spot], version: &'v Version) -> Option<&'v DefSite> {
    spots.iter().find_map(|spot| spot.place(&version.places))
}

/// Returns a short description of the effects.
fn breaks(finding: &Finding, lang: Lang) -> String {
    let mut parts: Vec<String> = Vec::new();
    parts.extend(finding.wire.iter().map(|it| it.words(lang).to_owned()));
    if !finding.source.is_empty() {
        let names: Vec<_> = finding.source.iter().map(|it| it.name()).collect();
        let of = pick(lang, ["sources in ", "源代码："]);
        parts.push(format!("{of}{}", names.join(", ")));
    }
    if finding.behaviour {
        parts.push(pick(lang, ["programs behave differently", "程序行为"]).to_owned());
    }
    if finding.silent {
        parts.push(pick(lang, ["without an error", "不报错"]).to_owned());
    }
    parts.join(pick(lang, ["; ", "；"]))
}

/// Returns the message of a finding with its effects.
fn sentence(finding: &Finding, lang: Lang) -> String {
    let message = lang.text(&finding.message);
    match breaks(finding, lang).as_str() {
        "" => message.to_owned(),
        breaks => format!("{message} ({breaks})"),
    }
}

fn text(findings: &[Finding], old: &Version, new: &Version, lang: Lang) -> String {
    let mut text = String::new();
    for finding in findings {
        let message = lang.text(&finding.message);
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{} {message}", finding.rule.code());
        let breaks = breaks(finding, lang);
        if !breaks.is_empty() {
            let _ = writeln!(text, "    {}{breaks}", pick(lang, ["breaks: ", "影响："]));
            let label = pick(lang, ["waiver: ", "豁免编号："]);
            let _ = match &finding.waived {
                Some(waiver) => writeln!(text, "    {}", waived(waiver, lang)),
                None => writeln!(text, "    {label}{}", finding.waiver_id()),
            };
        }
        for (sign, path, line, written) in excerpts(finding, [old, new]) {
            let _ = writeln!(text, "  {sign} {path}:{line}: {written}");
        }
    }
    let open = || findings.iter().filter(|it| it.waived.is_none());
    let count = |is: &dyn Fn(&Finding) -> bool| open().filter(|it| is(it)).count();
    let wire = count(&|it| !it.wire.is_empty());
    let source = count(&|it| !it.source.is_empty());
    let behaviour = count(&|it| it.behaviour);
    let all = findings.len();
    let _ = match lang {
        _ if findings.is_empty() => writeln!(text, "{}", pick(lang, ["no changes", "没有变更"])),
        Lang::En => writeln!(
            text,
            "\n{all} {} from {} to {}: {wire} on the wire, {source} in sources, {behaviour} in behaviour",
            if all == 1 { "change" } else { "changes" },
            old.name,
            new.name
        ),
        Lang::Zh => writeln!(
            text,
            "\n{} → {}：共 {all} 处变更，影响报文 {wire} 处，影响源代码 {source} 处，影响行为 {behaviour} 处",
            old.name, new.name
        ),
    };
    let waived = all - open().count();
    if waived > 0 {
        let _ = match lang {
            Lang::En => writeln!(text, "{waived} of them waived, which do not count"),
            Lang::Zh => writeln!(text, "其中 {waived} 处已豁免，不计入影响"),
        };
    }
    text
}

/// Returns a sentence with the person, the end and the reason of a waiver.
fn waived(waiver: &Waiver, lang: Lang) -> String {
    let Waiver { by, until, .. } = waiver;
    let reason = lang.text(&waiver.reason);
    match lang {
        Lang::En => format!("waived by {by} until {until}: {reason}"),
        Lang::Zh => format!("{by} 已豁免至 {until}：{reason}"),
    }
}

/// A finding with stable keys for other programs.
#[derive(Serialize)]
struct JsonFinding<'f> {
    rule: &'static str,
    number: u8,
    subject: &'f str,
    wire: &'f [Deployment],
    source: &'f [Language],
    behaviour: bool,
    silent: bool,
    message: &'f str,
    fingerprint: &'f str,
    #[serde(skip_serializing_if = "Option::is_none")]
    waived: Option<&'f Waiver>,
}

fn json(findings: &[Finding], lang: Lang) -> String {
    let shown = findings.iter().map(|finding| JsonFinding {
        rule: finding.rule.name,
        number: finding.rule.number,
        subject: &finding.subject,
        wire: &finding.wire,
        source: &finding.source,
        behaviour: finding.behaviour,
        silent: finding.silent,
        message: lang.text(&finding.message),
        fingerprint: &finding.fingerprint,
        waived: finding.waived.as_ref(),
    });
    // Texts and flags always serialize.
    serde_json::to_string_pretty(&shown.collect::<Vec<_>>()).unwrap_or_default() + "\n"
}

fn markdown(findings: &[Finding], lang: Lang) -> String {
    if findings.is_empty() {
        return pick(lang, ["No changes.\n", "没有变更。\n"]).to_owned();
    }
    let head = pick(
        lang,
        ["| rule | change | breaks |\n", "| 规则 | 变更 | 影响 |\n"],
    );
    let mut text = format!("{head}|---|---|---|\n");
    for finding in findings {
        let cell = |text: &str| text.replace('|', "\\|").replace('<', "&lt;");
        let message = cell(lang.text(&finding.message));
        let breaks = match &finding.waived {
            Some(waiver) => format!("{} ({})", breaks(finding, lang), waived(waiver, lang)),
            None => breaks(finding, lang),
        };
        let _ = writeln!(
            text,
            "| {} | {message} | {} |",
            finding.rule.code(),
            cell(&breaks)
        );
    }
    text
}

fn github(findings: &[Finding], new: &Version, lang: Lang) -> String {
    let escape = |text: &str| {
        text.replace('%', "%25")
            .replace('\r', "%0D")
            .replace('\n', "%0A")
    };
    let property = |text: &str| escape(text).replace(':', "%3A").replace(',', "%2C");
    let mut text = String::new();
    for finding in findings {
        let level = if finding.is_fault() {
            "error"
        } else if finding.wire.is_empty() || finding.waived.is_some() {
            "notice"
        } else {
            "warning"
        };
        let at = place(&finding.new, new)
            .map(|(path, line)| format!("file={},line={line},", property(&path)));
        let _ = writeln!(
            text,
            "::{level} {}title={}::{}",
            at.unwrap_or_default(),
            finding.rule.code(),
            escape(&sentence(finding, lang))
        );
    }
    text
}

fn sarif(findings: &[Finding], new: &Version, lang: Lang) -> String {
    use serde_json::json;
    let mut rules: Vec<_> = findings.iter().map(|it| it.rule).collect();
    rules.sort_by_key(|rule| rule.number);
    rules.dedup_by_key(|rule| rule.number);
    let rules: Vec<_> = rules
        .iter()
        .map(|rule| json!({ "id": rule.code(), "name": rule.name, "shortDescription": { "text": pick(lang, rule.title) } }))
        .collect();
    let results: Vec<_> = findings
        .iter()
        .map(|finding| {
            let at = place(&finding.new, new);
            let at = at.map(|(path, line)| {
                json!({ "physicalLocation": {
                    "artifactLocation": { "uri": path },
                    "region": { "startLine": line },
                } })
            });
            json!({
                "ruleId": finding.rule.code(),
                "level": if finding.is_fault() { "error" } else if finding.wire.is_empty() { "note" } else { "warning" },
                "message": { "text": sentence(finding, lang) },
                "locations": at.into_iter().collect::<Vec<_>>(),
                "partialFingerprints": { "fc/v1": finding.fingerprint },
                // Code hosts then mark the finding as accepted and do not count it.
                "suppressions": finding.waived.iter().map(|waiver| json!({
                    "kind": "external",
                    "justification": waived(waiver, lang),
                })).collect::<Vec<_>>(),
            })
        })
        .collect();
    let log = json!({
        "$schema": "https://json.schemastore.org/sarif-2.1.0.json",
        "version": "2.1.0",
        "runs": [{ "tool": { "driver": { "name": "fcproto diff", "rules": rules } }, "results": results }],
    });
    serde_json::to_string_pretty(&log).unwrap_or_default() + "\n"
}
