//! `samples.ts` and `tables.ts`: the examples and the tables of the spec as typed constants.

use super::constants::constant;
use super::context::{Context, page_of};
use super::source::file;
use crate::emit::stub::docs::Docs;
use crate::emit::stub::facts;
use crate::sample::{Profile, Samples};
use crate::surface::expr::{Expr, Expressions};
use fc_spec::model::Direction;

/// `samples.ts`.
pub fn samples(context: &Context<'_>, samples: &Samples<'_>) -> String {
    let mut out = file();
    let mut docs = Docs::default();
    docs.raw("每个消息的示例，与文档中的相同。");
    docs.raw("An example of each message, as the documentation shows it.");
    docs.raw("@module");
    out.docs(&docs);
    out.blank();
    out.line("import * as messages from './messages/index.ts'");
    let expressions = Expressions::new(&context.package, samples);
    for operation in &context.model().operations {
        for direction in [Direction::Request, Direction::Response] {
            let Some(body) = operation.body(direction) else {
                continue;
            };
            let value = samples.body(operation, direction, Profile::Example);
            let record = Expr::Record(expressions.record(&body.ty, &value));
            let name = context.name_of(&body.ty);
            let mut docs = facts::side_docs(operation, direction);
            if let Some(page) = context.page(&page_of(operation)) {
                docs.paragraph(page);
            }
            out.blank();
            out.docs(&docs);
            let head = format!("export const {name}: messages.{name} = ");
            constant(context, &record, false).write(&mut out, &head, "");
        }
    }
    out.finish()
}

/// `tables.ts`.
pub fn tables(context: &Context<'_>, samples: &Samples<'_>) -> String {
    let mut out = file();
    let mut docs = Docs::default();
    docs.raw("规范公布的常量表。");
    docs.raw("Tables of constants that the spec publishes.");
    docs.raw("@module");
    out.docs(&docs);
    out.blank();
    out.line("import * as messages from './messages/index.ts'");
    let expressions = Expressions::new(&context.package, samples);
    for table in &context.package.tables {
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
