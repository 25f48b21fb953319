//! `ids.rs`: a type for the ids of each entity, if the package has id types.

use super::context::Context;
use crate::package::about;
use crate::package::docs::Docs;
use fc_spec::model::Type;

/// Generates `ids.rs`.
pub fn ids_file(context: &Context<'_>) -> String {
    let mut out = context.source();
    out.inner_docs(&Docs::said([
        "各种实体的 ID，每种一个类型，不会互相混用。发送的形式与其中的值相同。",
        "The IDs of entities, with one type per entity, so that the compiler keeps them apart. An ID is sent as \
         the value in it.",
    ]));
    out.blank();
    out.import("fc_derive", &["Id"]);
    for id in &context.package.ids {
        let Some(held) = context.model().id_type(id) else {
            continue;
        };
        out.documented(&about::id(context, id.of));
        let mut derives = vec!["Clone"];
        derives.extend((*held != Type::String).then_some("Copy"));
        derives.extend([
            "Debug",
            "PartialEq",
            "Eq",
            "PartialOrd",
            "Ord",
            "Hash",
            "Id",
        ]);
        out.list("#[derive(", &derives, ")]");
        let held = context.rust_type(held);
        out.line(format!("pub struct {}(pub {held});", id.name));
    }
    out.finish()
}
