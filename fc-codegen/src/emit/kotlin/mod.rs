//! The generated part of the Kotlin package: messages, operations, both sides and tables.
//!
//! Messages use the descriptors of the runtime. All code is in one package, so that no file imports another. The
//! emitter lays out the text directly.

mod client;
mod expr;
mod group;
mod ids;
mod java;
mod messages;
mod operations;
mod protocol;
mod robot;
pub mod samples;
mod streams;
mod tables;
mod text;

use crate::package::context::Context;
use crate::package::group::Group;
use crate::package::language::{KOTLIN, Role};
use crate::package::name::free;
use crate::product::{Artifact, Product};
use crate::target::Targets;
use fc_spec::model::Model;
use std::collections::HashSet;
use text::STYLE;

/// Generates all files of the generated part.
#[must_use]
pub fn emit(model: &Model, targets: &Targets) -> Vec<Artifact> {
    let context =
        &Context::new(model, targets.naming(&KOTLIN), &STYLE).of_target(targets, Product::Kotlin);
    // A keyword cannot be the name of a package either.
    let package = KOTLIN.spelled(Role::Module, &model.protocol.id);
    let groups = Group::all(&context.package);
    let wholes = [
        ("Protocol", protocol::protocol_file(context, &groups)),
        ("Operations", operations::operations_file(context, &groups)),
        ("Client", client::client_file(context, &groups)),
        ("Ids", ids::ids_file(context)),
        ("Robot", robot::robot_file(context, &groups)),
        ("Tables", tables::tables_file(context)),
    ];
    let own = groups.iter().map(|group| {
        let names = wholes.iter().map(|it| it.0).chain([SHARED]);
        let is_taken = |name: &str| names.clone().any(|it| it.eq_ignore_ascii_case(name));
        let name = match group.of {
            Some(_) => {
                let wishes = ["", "Group"].map(|end| group::part_name(group, end));
                free(&[&*wishes[0], &*wishes[1]], is_taken)
            }
            None => SHARED.to_owned(),
        };
        (name, group::group_file(context, group))
    });
    let own: Vec<_> = own.collect();
    let wholes = wholes.into_iter();
    let wholes = wholes.map(|(name, body)| (name.to_owned(), body));
    let folder = format!("generated/src/main/kotlin/{package}");
    let whole = |path: &str, body: &str, further: &[&str]| {
        let contents = format!("{}{body}", head(context, &package, body, further));
        targets.artifact(Product::Kotlin, path, contents)
    };
    let files = wholes.chain(own);
    let files = files.map(|(name, body)| (name, body.finish()));
    // A group may contain only operations without a code.
    let files = files.filter(|(_, body)| !body.is_empty());
    let files = files.map(|(name, body)| whole(&format!("{folder}/{name}.kt"), &body, &[]));
    let samples = whole(
        samples::SHOWN.file,
        &samples::samples_file(context).finish(),
        samples::IMPORTED,
    );
    files.chain([samples]).collect()
}

/// The file of the types that several groups share.
const SHARED: &str = "SharedTypes";

/// The imports of the package. Names in a spec must differ from them.
const IMPORTED: &[&str] = &[
    "fc.runtime.AckPolicy",
    "fc.runtime.Acknowledgement",
    "fc.runtime.Audience",
    "fc.runtime.Bytes",
    "fc.runtime.Cadence",
    "fc.runtime.CallOptions",
    "fc.runtime.ChoiceType",
    "fc.runtime.ClientConfig",
    "fc.runtime.Command",
    "fc.runtime.Connection",
    "fc.runtime.ConnectionState",
    "fc.runtime.Content",
    "fc.runtime.Context",
    "fc.runtime.DataConnection",
    "fc.runtime.DeclaredError",
    "fc.runtime.Defaults",
    "fc.runtime.DigestAlgorithm",
    "fc.runtime.Effect",
    "fc.runtime.EnumType",
    "fc.runtime.EnvelopeRole",
    "fc.runtime.Following",
    "fc.runtime.HeaderField",
    "fc.runtime.HeaderLayout",
    "fc.runtime.HeaderRole",
    "fc.runtime.Id",
    "fc.runtime.IntEnumType",
    "fc.runtime.IntValue",
    "fc.runtime.Json",
    "fc.runtime.Limits",
    "fc.runtime.Loss",
    "fc.runtime.Message",
    "fc.runtime.MessageBuilder",
    "fc.runtime.MessageType",
    "fc.runtime.Protocol",
    "fc.runtime.RawRequest",
    "fc.runtime.Refusal",
    "fc.runtime.Report",
    "fc.runtime.Reports",
    "fc.runtime.ResultText",
    "fc.runtime.Results",
    "fc.runtime.Server",
    "fc.runtime.Service",
    "fc.runtime.State",
    "fc.runtime.StateOrder",
    "fc.runtime.Steps",
    "fc.runtime.Subscription",
    "fc.runtime.TextEnumType",
    "fc.runtime.TextValue",
    "fc.runtime.Types",
    "fc.runtime.sameOrUnsaid",
    "java.math.BigInteger",
    "java.util.concurrent.CompletableFuture",
    "java.util.concurrent.CompletionStage",
    "kotlinx.coroutines.flow.Flow",
];

/// Returns the head of a file. `further` are additional imports.
///
/// The head suppresses deprecation warnings, because the package still contains deprecated items.
fn head(context: &Context<'_>, package: &str, body: &str, further: &[&str]) -> String {
    let is_code = |line: &&str| !line.trim_start().starts_with('*');
    let is_part = |c: char| c.is_alphanumeric() || c == '_';
    let code = body.lines().filter(is_code);
    let words: HashSet<&str> = code.flat_map(|line| line.split(|c| !is_part(c))).collect();
    let mut out = context.source();
    out.line("// @generated by `fcproto generate` from the spec. Edit the YAML instead.");
    if body.contains("@Deprecated(") || body.contains("(Operations.") || !further.is_empty() {
        out.line("@file:Suppress(\"DEPRECATION\")");
    }
    out.blank();
    out.line(format!("package {package}"));
    out.blank();
    for path in IMPORTED.iter().chain(further) {
        let name = path.rsplit('.').next().unwrap_or_default();
        if words.contains(name) {
            out.line(format!("import {path}"));
        }
    }
    out.blank();
    out.finish()
}

/// Returns a stream's name as a part of a method name: `MapImage` in `SubscribeMapImage`.
fn method_of(stream: &crate::package::items::Spelled<'_, fc_spec::model::Operation>) -> String {
    KOTLIN.spelled(Role::Type, &stream.of.name).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An import takes precedence over the types of the package, so no type of a spec may have its name.
    #[test]
    fn imported_names_are_reserved() {
        for path in IMPORTED {
            let name = path.rsplit('.').next().unwrap_or_default();
            let is_type = name.starts_with(|first: char| first.is_ascii_uppercase());
            let is_kept = KOTLIN.spelling(Role::Type, name).is_err();
            assert!(is_kept || !is_type, "{name}");
        }
    }
}
