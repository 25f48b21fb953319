//! Compares the source breaks that `diff` reports with the packages of both versions.

use crate::declared::{Declared, declared};
use crate::support::{base, edits, model, with};
use fc_codegen::emit::generate;
use fc_codegen::product::Product;
use fc_codegen::target::Targets;
use fc_diff::{Language, Packages, diff_for};
use fc_spec::model::Model;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::sync::OnceLock;

/// Generates the packages of a project.
fn packages(model: &Model, id_types: bool) -> BTreeMap<Language, Declared> {
    let all = Targets::of([
        Product::Rust,
        Product::TypeScript,
        Product::Python,
        Product::Kotlin,
        Product::Cpp,
    ]);
    let targets = if id_types { all.with_newtypes() } else { all };
    declared(&generate(model, &targets).expect("every package can be made"))
}

/// A change of `edits.txt` in one direction.
struct Change {
    name: String,
    /// Languages in which `diff` reports a source break.
    said: BTreeSet<Language>,
    /// Names that vanish, by language.
    gone: BTreeMap<Language, Vec<String>>,
    /// Reasons why programs may not compile, by language.
    broken: BTreeMap<Language, Vec<String>>,
}

/// All changes in both directions, with and without ID types.
fn changes() -> &'static [Change] {
    static CHANGES: OnceLock<Vec<Change>> = OnceLock::new();
    CHANGES.get_or_init(|| {
        let base = base();
        let old = model(&base).expect("the spec");
        let mut changes = Vec::new();
        for id_types in [false, true] {
            let before = packages(&old, id_types);
            for edit in edits().1 {
                let new = model(&edit.apply(&base));
                let new = new.unwrap_or_else(|faults| panic!("{}: {faults}", edit.name));
                let after = packages(&new, id_types);
                let ids = if id_types { " (ID types)" } else { "" };
                for (way, models, [one, other]) in [
                    (">", [&old, &new], [&before, &after]),
                    ("<", [&new, &old], [&after, &before]),
                ] {
                    let found = diff_for(models[0], models[1], Packages { id_types });
                    let languages = || one.keys().copied();
                    let mut gone: BTreeMap<_, _> = languages()
                        .map(|it| (it, one[&it].gone_in(&other[&it])))
                        .collect();
                    if let (Some(one), Some(other)) =
                        (one.get(&Language::Kotlin), other.get(&Language::Kotlin))
                    {
                        let gone_compiled = one.compiled().gone_in(&other.compiled());
                        gone.insert(Language::JvmBinary, gone_compiled);
                    }
                    changes.push(Change {
                        name: format!("{way} {}{ids}", edit.name),
                        said: found
                            .iter()
                            .flat_map(|it| it.source.iter())
                            .copied()
                            .collect(),
                        gone,
                        broken: languages()
                            .map(|it| (it, one[&it].broken_by(&other[&it])))
                            .collect(),
                    });
                }
            }
        }
        changes
    })
}

/// Formats a failure.
fn line(change: &Change, language: Language, why: &[String]) -> String {
    let mut line = format!("{}: {}", change.name, language.name());
    for why in why.iter().take(3) {
        // Writing to a String cannot fail.
        let _ = write!(line, "\n    {why}");
    }
    line
}

#[test]
#[ignore = "takes long"]
fn name_gone_is_a_source_break() {
    let mut unsaid = Vec::new();
    for change in changes() {
        for (language, gone) in &change.gone {
            if !gone.is_empty() && !change.said.contains(language) {
                unsaid.push(line(change, *language, gone));
            }
        }
    }
    assert!(unsaid.is_empty(), "{}", unsaid.join("\n"));
}

#[test]
#[ignore = "takes long"]
fn source_break_is_visible_in_a_package() {
    let mut wrong = Vec::new();
    for change in changes() {
        for (language, broken) in &change.broken {
            if broken.is_empty() == change.said.contains(language) {
                wrong.push(line(change, *language, broken));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A name of each kind in each language. Without this list, a parser that finds no names would pass.
const KNOWN: [(Language, &[&str]); 5] = [
    (
        Language::Rust,
        &[
            "Lamp",
            "Client::set_level",
            "blocking::Client::get_level",
            "Reporter::alarm",
            "Robot::set_level",
            "FrameHeader::layout_version",
            "ResponseEnvelope::sent_at",
            "ResultCode::NoBulb",
            "StreamCode::Firmware",
            "Streams::subscribe_glow",
            "AnyReport::Alarm",
            "tables::colours",
            "descriptors::COMMANDS",
            "for_each_command!",
            "messages::lamp::SetLevelRequestData::title",
            "messages::lamp::SetLevelRequestDataFields",
            "messages::lamp::SetLevelRequest: SetsOff<Alarm>",
            "messages::lamp::SetLevelRequest: AcceptedIn<Mood>",
            "messages::lamp::SetLevelError::NoBulb",
            "messages::types::Colour::gamma_or_default",
            "messages::types::Colour::with_gamma",
            "messages::types::Phase::is_final",
            "messages::types::Goal::ByTime",
        ],
    ),
    (
        Language::Typescript,
        &[
            "Lamp",
            "Client",
            "LampCalls.setLevel",
            "LampPartialRobot.setLevel",
            "LampReporter.alarm",
            "LampStreams.subscribeGlow",
            "RequestEnvelope.sentAt",
            "ResultCode.NoBulb",
            "SetLevelError|\"NoBulb\"",
            "SetLevelRequestData.title",
            "Phase.Burning",
            "Goal|Tagged<\"ByTime\", GoalByTime>",
            "commands.setLevel",
            "schemas.Colour",
            "defaults.Colour.gamma",
            "tables.colours",
        ],
    ),
    (
        Language::Python,
        &[
            "lamp.protocol.LAMP",
            "lamp.protocol.ResultCode.NO_BULB",
            "lamp.protocol.ResponseEnvelope.sent_at",
            "lamp.groups.lamp.SET_LEVEL",
            "lamp.groups.lamp.LampCalls.set_level",
            "lamp.groups.lamp.LampHandlers.set_level",
            "lamp.groups.lamp.SetLevelError.NO_BULB",
            "lamp.groups.lamp.SetLevelRequestData.title",
            "lamp.groups.types.Colour.DEFAULT_GAMMA",
            "lamp.groups.types.Colour.gamma_or_default",
            "lamp.groups.types.Phase.BURNING",
            "lamp.groups.types.Phase.process",
            "lamp.tables.colours",
        ],
    ),
    (
        Language::Kotlin,
        &[
            "lamp.Lamp",
            "lamp.LampClient.setLevel(request: SetLevelRequest, options: CallOptions = CallOptions())",
            "lamp.LampHandlers.setLevel(context: Context, request: SetLevelRequest)",
            "lamp.LampOperations.setLevel",
            "lamp.ResultCode.Companion.NO_BULB",
            "lamp.SetLevelRequestData.title",
            "lamp.Colour.gammaOrDefault",
            "lamp.Phase.Companion.BURNING",
            "lamp.Goal:GoalByTime",
            "lamp.Tables.colours()",
        ],
    ),
    (
        Language::Cpp,
        &[
            "lamp::const fc_runtime::Protocol& protocol()",
            "lamp::ResultCode::NoBulb",
            "lamp::SetLevelError::NoBulb",
            "lamp::SetLevelRequestData::title",
            "lamp::Phase::Burning",
            "lamp::Goal",
            "lamp::Colour::float gamma_or_default() const",
            "lamp::bool is_final(Phase value) noexcept",
            "lamp::groups::LampCommands",
            "lamp::const std::vector<Colour>& colours()",
        ],
    ),
];

#[test]
fn parsers_find_every_kind_of_name() {
    let model = model(&base()).expect("the spec");
    let made = packages(&model, false);
    let mut missing = Vec::new();
    for (language, names) in KNOWN {
        let declared = &made[&language].names;
        let of = names.iter().filter(|name| !declared.contains_key(**name));
        missing.extend(of.map(|name| format!("{}: {name}", language.name())));
        println!("{}: {} names", language.name(), declared.len());
    }
    if std::env::var_os("FC_SHOW").is_some() {
        println!("{made:#?}");
    }
    assert!(missing.is_empty(), "{missing:#?}");
    let with_ids = packages(&model, true);
    assert!(with_ids[&Language::Rust].names.contains_key("ids::SceneId"));
    assert!(
        with_ids[&Language::Python]
            .names
            .contains_key("lamp.groups.ids.SceneId")
    );
}

#[test]
fn entity_renamed_breaks_sources_only() {
    let base = base();
    let renamed = with(&base, "protocol.yaml", "  shade: {", "  hood: {");
    let renamed = with(
        &renamed,
        "commands/lamp.yaml",
        "refers: shade",
        "refers: hood",
    );
    let [old, new] = [&base, &renamed].map(|it| model(it).expect("a spec"));
    for (id_types, expected) in [
        (false, Vec::new()),
        (
            true,
            vec![
                Language::Rust,
                Language::Kotlin,
                Language::JvmBinary,
                Language::Cpp,
                Language::Python,
                Language::Typescript,
            ],
        ),
    ] {
        let found = diff_for(&old, &new, Packages { id_types });
        let source: Vec<Language> = found
            .iter()
            .flat_map(|it| it.source.iter())
            .copied()
            .collect();
        assert_eq!(source, expected);
        assert!(found.iter().all(|it| it.wire.is_empty() && !it.behaviour));
    }
}
