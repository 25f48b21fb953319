//! `Ids.kt`: a type for the ids of each entity, if the package has id types.

use super::text::type_of;
use crate::package::about;
use crate::package::context::Context;
use crate::package::source::Source;

/// Generates `Ids.kt`. It is empty without id types.
pub fn ids_file(context: &Context<'_>) -> Source {
    let mut out = context.source();
    for (id, held) in context.ids() {
        let (name, held) = (&id.name, type_of(context, held));
        out.documented(&about::id(context, id.of));
        out.line(format!(
            "public class {name}(value: {held}) : Id<{held}>(value)"
        ));
    }
    out
}
