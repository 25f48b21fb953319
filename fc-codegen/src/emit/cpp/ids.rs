//! `ids.hpp`: a type for the ids of each entity, if the package has id types.

use super::layout::{Includes, header_file};
use super::types::{name_of, namespace};
use crate::package::about;
use crate::package::context::Context;
use fc_spec::model::Type;

/// Returns the path of the header, relative to the includes.
pub fn path(context: &Context<'_>) -> String {
    format!("{}/ids.hpp", namespace(context))
}

/// Generates `ids.hpp`.
pub fn header(context: &Context<'_>) -> String {
    let ids: Vec<_> = context.ids().collect();
    let mut includes = Includes::new(context, &["functional"], &[], &["id"]);
    for (_, held) in &ids {
        includes.standard(if **held == Type::String {
            "string"
        } else {
            "cstdint"
        });
    }
    let space = &namespace(context);
    let mut out = header_file(context, &includes, |out| {
        for (id, held) in &ids {
            out.documented(&about::id(context, id.of));
            let base = format!("fc_runtime::Id<{}, {}>", id.name, name_of(context, held));
            out.line(out.class(&id.name, &[format!("public {base}")]));
            out.line(" public:\n  using Id::Id;\n};");
        }
    });
    let mut hashes = context.source();
    for (id, _) in &ids {
        let name = &id.name;
        hashes.line(format!(
            "template <>\nstruct std::hash<{space}::{name}> : fc_runtime::HashOfId {{}};"
        ));
    }
    out.push('\n');
    out + &hashes.finish()
}
