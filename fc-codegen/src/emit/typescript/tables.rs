//! `tables.ts`: the tables of the spec as typed constants.

use super::constants::constant;
use super::context::Context;
use super::source::{head, nothing};
use crate::emit::stub::docs::Docs;
use crate::emit::stub::facts;
use crate::sample::Samples;
use crate::surface::expr::{Expr, Expressions};

/// The file.
pub fn file(context: &Context<'_>, samples: &Samples<'_>) -> String {
    let mut out = head(
        "规范公布的常量表。",
        "Tables of constants that the spec publishes.",
    );
    let tables = &context.package.tables;
    if tables.is_empty() {
        return nothing(out);
    }
    out.line("import * as messages from './messages/index.ts'");
    let expressions = Expressions::new(&context.package, samples);
    for table in tables {
        let mut docs = Docs::of(&table.title);
        docs.text(&table.about);
        if let Some(store) = &table.kept {
            docs.paragraph(facts::kept(store));
        }
        docs.paragraph(context.links(&table.location, "reference/tables.md"));
        out.blank();
        out.docs(&docs);
        let rows = table.rows.iter();
        let rows = rows.map(|row| Expr::Record(expressions.record(&table.row, row)));
        let head = format!(
            "export const {}: readonly messages.{}[] = ",
            table.name,
            context.name_of(&table.row)
        );
        constant(context, &Expr::List(rows.collect()), false).write(&mut out, &head, "");
    }
    out.finish()
}
