//! `fcproto help-page`: the command line as a page of the reference.

use clap::Command;
use minijinja::syntax::SyntaxConfig;
use minijinja::value::{Serde, Value};
use minijinja::{Environment, Error, context};
use serde::Serialize;

use super::{ArgumentHelp, Part, arguments, described, of, terminal, usage};
use crate::lang::{both, lang, said};
use crate::outcome::{Failure, Status};
use crate::print;

pub fn run() -> Result<Status, Failure> {
    print::result(&page()?)?;
    Ok(Status::Fine)
}

/// Returns the page in the language of the run.
fn page() -> Result<String, Error> {
    let mut root = described();
    root.build();
    let help = of(&[]);
    let statuses = help.as_ref().map(terminal::statuses);
    // The page has a table of the commands, so it needs no examples.
    let mut program = help.map_or_else(Vec::new, |help| help.details);
    program.retain(|it| !matches!(it, Part::Examples(_)));
    let mut commands = Vec::new();
    add_commands(&mut root, &[], &mut commands);
    let (_, global) = arguments(&root);
    let global: Vec<_> = global.iter().map(Row::new).collect();
    let mut syntax = SyntaxConfig::builder();
    // Markdown has `{#id}` behind headings.
    syntax
        .comment_delimiters("{*", "*}")
        .keep_trailing_newline(true);
    let mut environment = Environment::new();
    environment.set_syntax(syntax.build()?);
    environment.add_filter("cell", cell);
    environment.add_function("t", |zh: String, en: String| lang().pick(zh, en));
    environment.add_template("page", include_str!("page.md.j2"))?;
    environment.get_template("page")?.render(context! {
        program => Value::from(Serde(program)),
        statuses,
        commands => Value::from(Serde(commands)),
        global => Value::from(Serde(global)),
    })
}

/// A command on the page.
#[derive(Serialize)]
struct Section {
    name: String,
    id: String,
    summary: &'static str,
    fails: &'static str,
    speaks: &'static str,
    usage: String,
    arguments: Vec<Row>,
    details: Vec<Part>,
}

/// An argument in a table.
#[derive(Serialize)]
struct Row {
    term: String,
    text: String,
    default: String,
    /// The name above the table of the values.
    name: String,
    /// The values with their help.
    values: Vec<(String, String)>,
}

impl Row {
    fn new(shown: &ArgumentHelp<'_>) -> Self {
        let mut text = shown.text.clone();
        let (name, values) = shown.described_values().unwrap_or_default();
        if values.is_empty() && !shown.values.is_empty() {
            let names = shown.values.iter().map(|(name, _)| format!("`{name}`"));
            let names = names.collect::<Vec<_>>().join(both("、", ", "));
            text += &said!("：{names}", ": {names}");
        }
        let is_value = !shown.argument.get_default_values().is_empty();
        let default = match &shown.default {
            Some(default) if is_value => format!("`{default}`"),
            default => default.clone().unwrap_or_default(),
        };
        Self {
            term: format!("`{}`", shown.term.trim()),
            text,
            default,
            name,
            values: values.to_vec(),
        }
    }
}

/// Adds every visible command below this one, in the order of the help.
fn add_commands(command: &mut Command, path: &[&str], sections: &mut Vec<Section>) {
    for below in command.get_subcommands_mut() {
        if below.is_hide_set() || below.get_name() == "help" {
            continue;
        }
        let name = below.get_name().to_owned();
        let path: Vec<&str> = path.iter().copied().chain([name.as_str()]).collect();
        if let Some(help) = of(&path) {
            let usage = usage(below);
            let (own, _) = arguments(below);
            sections.push(Section {
                name: path.join(" "),
                id: path.join("-"),
                summary: help.summary,
                fails: help.fails,
                speaks: help.speaks,
                usage,
                arguments: own.iter().map(Row::new).collect(),
                details: help.details,
            });
        }
        add_commands(below, &path, sections);
    }
}

/// Returns the text of a cell. Empty cells have a dash.
fn cell(text: &str) -> String {
    if text.is_empty() {
        return "—".to_owned();
    }
    text.replace('|', "\\|")
}
