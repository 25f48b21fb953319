//! `ids.rs`: a type for the ids of each entity, if the package has id types.

use super::context::Context;
use crate::package::about;
use fc_spec::model::Type;

/// Generates `ids.rs`.
pub fn ids_file(context: &Context<'_>) -> String {
    let mut out = context.source();
    out.template("ids", &[]);
    for (id, held) in context.ids() {
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
