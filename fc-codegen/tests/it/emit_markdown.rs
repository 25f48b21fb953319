//! The reference pages match their golden files, their links and tables are complete, and they contain no code of the
//! spec.

use crate::docs_support::{artifact, fixture, golden, model, project};
use fc_codegen::emit::markdown;
use fc_codegen::inspect;
use fc_codegen::product::Artifact;
use fc_codegen::target::Targets;
use fc_spec::model::{Dump, Value as Json};
use serde_yaml::{Mapping, Value};
use std::collections::{HashMap, HashSet};
use std::path::Path;

/// One page of each kind, and operations with special features.
const GOLDEN: [&str; 18] = [
    "index.md",
    "wire.md",
    "codes.md",
    "types.md",
    "results.md",
    "tables.md",
    "entities.md",
    "places.md",
    "glossary.md",
    "changelog.md",
    "open-questions.md",
    "commands/set_level.md",
    "commands/get_level.md",
    "commands/dim.md",
    "commands/probe.md",
    "reports/level_changed.md",
    "streams/firmware.md",
    "streams/glow.md",
];

#[test]
fn pages_are_as_they_were() {
    let artifacts = markdown::emit(&model(&fixture()), &Targets::default());
    for (language, root) in [
        ("zh", "docs-site/reference"),
        ("en", "docs-site/en/reference"),
    ] {
        for page in GOLDEN {
            let contents = artifact(&artifacts, &format!("{root}/{page}"));
            golden(&format!("{language}/{page}"), contents);
        }
    }
    let navigation = artifact(&artifacts, "docs-site/reference/navigation.json");
    golden("navigation.json", navigation);
}

/// A page shows the state of each fact: confirmed, inferred, stated or open.
#[test]
fn a_page_says_how_sure_each_fact_is() {
    let artifacts = markdown::emit(&model(&fixture()), &Targets::default());
    let page = |name: &str| artifact(&artifacts, &format!("docs-site/en/reference/{name}.md"));
    for (name, says, is_silent_about) in [
        (
            "commands/get_level",
            &[
                "type: confirmed",
                "| type | confirmed | confirmed by",
                "code: inferred",
                "effect: inferred",
                "request body: open",
            ][..],
            &["response body: stated", "all stated"][..],
        ),
        (
            "commands/probe",
            &[
                "unknown effect",
                "| effect | open |",
                "treat it as a command that moves the robot",
            ],
            // The badge of the effect appears once.
            &["effect: open", "all stated", "Reads only", "type: inferred"],
        ),
        (
            "commands/set_level",
            &["all stated", "| effect | stated |"],
            &[": inferred", ": open"],
        ),
        // The command is new in the spec, so it has no source.
        (
            "commands/dim",
            &["code: open"],
            &["all stated", ": stated", "| stated |"],
        ),
    ] {
        let text = page(name).to_lowercase();
        for part in says {
            assert!(text.contains(&part.to_lowercase()), "{name}: no {part:?}");
        }
        for part in is_silent_about {
            assert!(!text.contains(&part.to_lowercase()), "{name}: {part:?}");
        }
    }
}

#[test]
fn both_languages_have_the_same_pages() {
    let artifacts = markdown::emit(&model(&project()), &Targets::default());
    let pages = |root: &str| -> HashSet<String> {
        let paths = artifacts.iter().filter(|artifact| is_page(artifact));
        paths
            .filter_map(|artifact| artifact.path.strip_prefix(root))
            .map(str::to_owned)
            .collect()
    };
    let chinese = pages("docs-site/reference/");
    assert_eq!(chinese, pages("docs-site/en/reference/"));
    assert!(chinese.contains("wire.md"));
}

#[test]
fn every_link_leads_somewhere() {
    for root in [fixture(), project()] {
        let artifacts = markdown::emit(&model(&root), &Targets::default());
        let anchors: HashMap<String, HashSet<String>> = artifacts
            .iter()
            .map(|artifact| (artifact.path.clone(), anchors(&artifact.contents)))
            .chain(spec_files(&root).map(|(path, text)| (path, places(&text))))
            .collect();
        let mut broken = Vec::new();
        for page in artifacts.iter().filter(|artifact| is_page(artifact)) {
            for link in links(&page.contents) {
                if let Err(why) = follow(&anchors, &page.path, &link) {
                    broken.push(format!("{}: {link}: {why}", page.path));
                }
            }
        }
        assert!(broken.is_empty(), "{}", broken.join("\n"));
    }
}

#[test]
fn every_table_is_straight() {
    for page in pages() {
        assert_straight(&page);
    }
}

fn assert_straight(page: &Artifact) {
    let mut columns = None;
    for line in outside_fences(&page.contents) {
        if !line.starts_with('|') {
            columns = None;
            continue;
        }
        let bars = line.replace("\\|", "").matches('|').count();
        let first = *columns.get_or_insert(bars);
        assert_eq!(bars, first, "{}: {line}", page.path);
    }
}

/// Outside of fences, Vue must find no expression. It must find no tags except those that the pages use.
#[test]
fn pages_contain_no_vue_code() {
    for page in pages() {
        assert_no_code(&page);
    }
}

fn assert_no_code(page: &Artifact) {
    const TAGS: [&str; 10] = [
        "<a id=\"",
        "</a>",
        "<br>",
        "<small>",
        "</small>",
        "<!--",
        "<span class=\"fc-badge ",
        "</span>",
        "<div class=\"fc-question\"",
        "</div>",
    ];
    // The front matter is not Markdown.
    let body = page.contents.splitn(3, "---\n").last().unwrap_or_default();
    for line in outside_fences(body) {
        // Vue reads code spans too. It skips fences only.
        assert!(!line.contains("{{"), "{}: {line}", page.path);
        let text = without_code(line);
        let unescaped = text.replace("\\{", "");
        assert!(!unescaped.contains('{'), "{}: {line}", page.path);
        // Markdown would turn two adjacent escapes into `{{`.
        assert!(!text.contains("\\{\\{"), "{}: {line}", page.path);
        for (at, _) in text.match_indices('<') {
            let tag = text.get(at..).unwrap_or_default();
            assert!(
                TAGS.iter().any(|known| tag.starts_with(known)),
                "{}: {line}",
                page.path
            );
        }
    }
}

#[test]
fn every_fence_is_closed() {
    for page in pages() {
        assert_closed(&page);
    }
}

fn assert_closed(page: &Artifact) {
    let mut open: Option<&str> = None;
    for line in page.contents.lines() {
        let ticks = line.len() - line.trim_start_matches('`').len();
        match open {
            Some(fence) if line == fence => open = None,
            None if ticks >= 3 => open = line.get(..ticks),
            _ => {}
        }
    }
    assert_eq!(open, None, "{}", page.path);
    assert!(
        page.contents.ends_with('\n') && !page.contents.ends_with("\n\n"),
        "{}",
        page.path
    );
}

/// Texts that try to break out of Markdown, HTML, Vue or `VitePress`.
const HOSTILE: [&str; 5] = [
    "<!--@include: ../../../secret.txt--> `<!-- @include: ../../../secret.txt -->` </script> {{ 7 * 7 }} {\\{ 7 * 7 }}",
    "<img src=x onerror=alert(1)> &#123;&#123; 7 * 7 }} \\`<b>` a | b ] [ ](x) {0} {1} {2} \"><b> #",
    "ends in \\",
    "`` ` ",
    "a\n\n# b\n::: tip\n---\n[c]: d\n```\n<!--@include: x-->\n```\nb",
];

/// Invisible characters. The reader of a spec may refuse them instead.
const INVISIBLE: &str = "\u{202e}\0\u{1b}[31m\u{2028}\u{fdd0}\u{e0001}";

#[test]
fn hostile_texts_stay_in_their_place() {
    let plain = inspect::value(&model(&fixture()));
    for text in HOSTILE.into_iter().chain([INVISIBLE]) {
        let mut dump = plain.clone();
        spoil(&mut dump, text);
        let read = Dump::read(&dump.to_string());
        let Ok(model) = read else {
            assert_eq!(text, INVISIBLE, "it is refused");
            continue;
        };
        for artifact in markdown::emit(&model, &Targets::default()) {
            let contents = &artifact.contents;
            let hidden = contents.chars().find(|it| {
                it.is_control() && !matches!(it, '\n' | '\t')
                    || "\u{202e}\u{2028}\u{fdd0}\u{e0001}".contains(*it)
            });
            assert_eq!(hidden, None, "{} of {text}", artifact.path);
            if !is_page(&artifact) {
                continue;
            }
            let comments = contents.split("<!--").skip(1);
            let obeyed = comments.filter(|comment| comment.trim_start().starts_with("@include"));
            assert_eq!(obeyed.count(), 0, "{} of {text}", artifact.path);
            let front = contents.split("---\n").nth(1).unwrap_or_default();
            assert!(!front.contains("</") && !front.contains("<!"), "{front}");
            assert_straight(&artifact);
            assert_no_code(&artifact);
            assert_closed(&artifact);
            anchors(contents);
        }
    }
}

/// Appends a text to every text of a dump.
fn spoil(value: &mut Json, text: &str) {
    match value {
        Json::Object(entries) => {
            for (key, value) in entries {
                let is_text = matches!(key.as_str(), "zh" | "en");
                match value {
                    Json::String(words) if is_text => words.extend([" ", text]),
                    value => spoil(value, text),
                }
            }
        }
        Json::Array(items) => items.iter_mut().for_each(|item| spoil(item, text)),
        _ => {}
    }
}

fn is_page(artifact: &Artifact) -> bool {
    Path::new(&artifact.path)
        .extension()
        .is_some_and(|extension| extension == "md")
}

/// Returns the pages of the fixture and of the project.
fn pages() -> Vec<Artifact> {
    let all = [fixture(), project()].map(|root| markdown::emit(&model(&root), &Targets::default()));
    all.into_iter().flatten().filter(is_page).collect()
}

/// Returns the lines of a page that are not code, neither in a fence nor in HTML.
fn outside_fences(contents: &str) -> impl Iterator<Item = &str> {
    let mut open: Option<&str> = None;
    let mut in_html = false;
    contents.lines().filter(move |line| {
        let ticks = line.len() - line.trim_start_matches('`').len();
        let was_open = open.is_some();
        match open {
            Some(fence) if *line == fence => open = None,
            None if ticks >= 3 && !in_html => open = line.get(..ticks),
            _ => {}
        }
        in_html |= !was_open && line.starts_with("<pre v-pre>");
        let is_code = was_open || open.is_some() || in_html;
        in_html &= !line.ends_with("</pre>");
        !is_code
    })
}

/// Removes the code spans of a line. An escaped backtick starts no span.
fn without_code(line: &str) -> String {
    let mut out = String::new();
    let mut rest = line;
    while let Some(start) = rest.find(['`', '\\']) {
        let (before, from) = rest.split_at(start);
        out.push_str(before);
        if from.starts_with('\\') {
            let escaped = 1 + from.chars().nth(1).map_or(0, char::len_utf8);
            let (escaped, behind) = from.split_at(escaped);
            out.push_str(escaped);
            rest = behind;
            continue;
        }
        let ticks = from.len() - from.trim_start_matches('`').len();
        let (marker, inside) = from.split_at(ticks);
        rest = inside.split_once(marker).map_or("", |(_, after)| after);
    }
    out + rest
}

/// Returns the targets of a page's links.
fn links(contents: &str) -> Vec<String> {
    let mut links = Vec::new();
    for line in outside_fences(contents) {
        for part in line.split("](").skip(1) {
            let target = part.split(')').next().unwrap_or_default();
            links.push(target.to_owned());
        }
    }
    links
}

/// Returns the anchors of a page.
fn anchors(contents: &str) -> HashSet<String> {
    let ids = contents.split("<a id=\"").skip(1);
    let mut anchors = HashSet::new();
    for id in ids.filter_map(|rest| rest.split('"').next()) {
        assert!(anchors.insert(id.to_owned()), "{id} is there twice");
    }
    anchors
}

fn follow(
    anchors: &HashMap<String, HashSet<String>>,
    from: &str,
    link: &str,
) -> Result<(), String> {
    let (path, anchor) = link.split_once('#').unwrap_or((link, ""));
    let target = if path.is_empty() {
        from.to_owned()
    } else {
        resolve(from, path)?
    };
    let ids = anchors.get(&target).ok_or("no such file")?;
    if anchor.is_empty() || ids.contains(anchor) {
        Ok(())
    } else {
        Err("no such anchor".to_owned())
    }
}

/// Returns the spec's files with their paths from the root.
fn spec_files(root: &Path) -> impl Iterator<Item = (String, Value)> + use<> {
    let spec = root.join("spec");
    let files =
        ["", "commands"].map(|folder| std::fs::read_dir(spec.join(folder)).expect("the spec"));
    let paths = files
        .into_iter()
        .flatten()
        .map(|file| file.expect("a file").path());
    let root = root.to_owned();
    paths
        .filter(|path| {
            path.extension()
                .is_some_and(|extension| extension == "yaml")
        })
        .map(move |path| {
            let text = std::fs::read_to_string(&path).expect("a file of the spec");
            let name = path.strip_prefix(&root).expect("below the root");
            let name = name.to_str().expect("a path in Unicode").replace('\\', "/");
            (
                name,
                serde_yaml::from_str(&text).expect("a file that parses"),
            )
        })
}

/// Returns the names of places in a file of the spec: its sections, their entries and the IDs of its answers.
fn places(file: &Value) -> HashSet<String> {
    let mut names = HashSet::new();
    for (section, entries) in file.as_mapping().into_iter().flatten() {
        let section = section.as_str().unwrap_or_default();
        names.insert(section.to_owned());
        for key in entries.as_mapping().into_iter().flat_map(Mapping::keys) {
            let key = match key {
                Value::Number(number) => number.to_string(),
                key => key.as_str().unwrap_or_default().to_owned(),
            };
            names.insert(format!("{section}.{key}"));
        }
    }
    let mut counts = HashMap::new();
    answered(file, &mut |id| {
        let count = counts.entry(id.to_owned()).or_insert(0);
        *count += 1;
        names.insert(match *count {
            1 => id.to_owned(),
            count => format!("{id}.{count}"),
        });
    });
    names
}

/// Finds the first ID of each answer.
fn answered(value: &Value, found: &mut impl FnMut(&str)) {
    match value {
        Value::Mapping(entries) => {
            if let Some(id) = value["ids"][0].as_str() {
                found(id);
            }
            entries.values().for_each(|value| answered(value, found));
        }
        Value::Sequence(items) => items.iter().for_each(|value| answered(value, found)),
        _ => {}
    }
}

/// Resolves a relative path of a page to a path from the root.
fn resolve(from: &str, path: &str) -> Result<String, String> {
    let mut parts: Vec<&str> = from.split('/').collect();
    parts.pop();
    for part in path.split('/') {
        match part {
            ".." => {
                parts.pop().ok_or("leads out of the project")?;
            }
            part => parts.push(part),
        }
    }
    Ok(parts.join("/"))
}
