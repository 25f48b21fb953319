//! `ids.ts`: a type for the ids of each entity, if the package has id types.

use super::context::{Context, is_64_bit, type_of};
use super::source::{head, literal, named};
use crate::package::about;

/// Generates `ids.ts`.
pub fn file(context: &Context<'_>) -> String {
    let mut out = head(
        context,
        [
            "各种实体的 ID，每种一个类型，编译器不会让它们互相混用。发送的形式与其中的值相同。",
            "The IDs of entities, with one type per entity, so that the compiler keeps them apart. An ID is sent as\n\
             the value in it.",
        ],
    );
    named(&mut out, "import type", ["Id"], "../src/runtime.ts");
    for (id, held) in context.ids() {
        let (name, held) = (&id.name, type_of(context, held, is_64_bit(held)));
        out.documented(&about::id(context, id.of));
        let values = [
            ("name", &**name),
            ("held", &held),
            ("literal", &literal(name)),
        ];
        out.template("id", &values);
    }
    out.finish()
}
