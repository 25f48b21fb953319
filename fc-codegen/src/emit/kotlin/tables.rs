//! The spec's tables of constants. Each is a function that returns its rows as messages.

use super::expr::{self, Form};
use crate::package::about;
use crate::package::context::Context;
use crate::package::docs::Docs;
use crate::package::source::Source;
use fc_spec::model::Type;

/// Generates `Tables.kt`.
pub fn tables_file(context: &Context<'_>) -> Source {
    let mut out = context.source();
    out.docs(&Docs::said(about::TABLES));
    out.block("public object Tables", |out| {
        for table in &context.package.tables {
            out.documented(&about::table(context, table.of));
            out.line("@JvmStatic");
            let row = context.name_of(&table.row);
            out.enclose(
                &format!("public fun {}(): List<{row}> =", table.name),
                "",
                |out| {
                    let rows = context.package.rows(table);
                    expr::laid_out(out, "", &rows, &Type::Json, "", Form::Chain);
                },
            );
        }
    });
    out
}
