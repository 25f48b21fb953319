//! `tables.ts` and `defaults.ts`: the tables of the spec and the defaults of fields, as typed constants.

use super::constants::constant;
use super::context::{Context, imported, is_large, own};
use super::group::{Group, has_default};
use super::layout::Layout;
use super::operations::typed;
use super::source::{head, literal, named, nothing};
use crate::package::about;
use crate::sample::Samples;
use fc_spec::model::Value;

pub const DEFAULTS: [&str; 2] = [
    "字段不出现时的含义，用 `withDefaults` 填入。",
    "Defaults of absent fields; `withDefaults` fills them in.",
];

pub fn file(context: &Context<'_>) -> String {
    let mut out = head(context, about::TABLES);
    let tables = &context.package.tables;
    if tables.is_empty() {
        return nothing(out);
    }
    out.line("import * as messages from './messages.ts'");
    for table in tables {
        out.documented(&about::table(context, table.of));
        let head = format!(
            "export const {}: readonly messages.{}[] = ",
            table.name,
            context.name_of(&table.row)
        );
        constant(context, &context.package.rows(table), false).write(&mut out, &head, "");
    }
    out.finish()
}

/// Generates `defaults.ts` of a group: a constant for each struct with defaults.
///
/// A default is the meaning of an absent field.
pub fn defaults(context: &Context<'_>, _: &Samples<'_>, group: &Group<'_, '_>) -> String {
    let mut out = head(context, DEFAULTS);
    named(
        &mut out,
        "import type",
        [imported(context, "DefaultsOf")],
        "../../../src/runtime.ts",
    );
    out.line("import * as messages from '../../messages.ts'");
    for item in group.items() {
        let fields = item.fields().iter().filter(|it| has_default(it));
        let (keys, members): (Vec<String>, Vec<_>) = fields
            .filter_map(|field| {
                let default = Value::from(field.details().default.as_ref()?);
                let value = constant(
                    context,
                    &context.package.held(field, &default),
                    is_large(context, field),
                );
                Some((literal(&field.name), (&*field.name, value)))
            })
            .unzip();
        if keys.is_empty() {
            continue;
        }
        let name = &item.ty.name;
        out.blank();
        out.line(format!("/** {{@link messages.{name}}} */"));
        let types = [format!("messages.{name}"), keys.join(" | ")];
        typed(
            &mut out,
            name,
            &own(context, "DefaultsOf"),
            &types,
            &Layout::object(members),
        );
    }
    out.finish()
}
