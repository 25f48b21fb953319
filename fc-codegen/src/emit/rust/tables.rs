//! `tables.rs`: the spec's tables of constants. Each is a function that returns its rows as typed values.

use super::constants::{ConstantScope, spelled};
use super::context::Context;
use super::source::Source;
use crate::package::about;
use crate::package::docs::Docs;
use crate::package::expr::{Expr, Record};
use crate::package::items::Spelled;
use fc_spec::model::Table;
use std::collections::BTreeSet;

/// Generates `tables.rs`.
pub fn tables_file(context: &Context<'_>) -> String {
    let mut rows = context.source();
    let mut used = Used::default();
    for table in &context.package.tables {
        rows.blank();
        table_function(&mut rows, &mut used, context, table);
    }

    let mut out = context.source();
    out.inner_docs(&Docs::said(about::TABLES));
    out.blank();
    out.import("super::ids", &used.ids.iter().collect::<Vec<_>>());
    out.import("super::messages", &used.types.iter().collect::<Vec<_>>());
    out.import("fc_runtime", &used.runtime.iter().collect::<Vec<_>>());
    out.blank();
    out.append(&rows);
    out.finish()
}

/// The imports of the file.
#[derive(Default)]
struct Used {
    ids: BTreeSet<String>,
    types: BTreeSet<String>,
    runtime: BTreeSet<&'static str>,
}

impl Used {
    /// Adds the types that a constant names.
    fn all_in(&mut self, expr: &Expr<'_>) {
        match expr {
            Expr::Bool(_) | Expr::Int(_) | Expr::Float(_) | Expr::Text(_) => {}
            Expr::Bytes(_) => self.runtime.extend(["Bytes64"]),
            Expr::Json(_) => self.runtime.extend(["Json"]),
            Expr::Id(ty, value) => {
                self.ids.insert((*ty).to_owned());
                self.all_in(value);
            }
            Expr::List(items) => items.iter().for_each(|item| self.all_in(item)),
            Expr::Record(record) => self.record(record),
            Expr::Choice(item, _, record) => {
                self.types.insert(item.ty.name.to_string());
                self.record(record);
            }
            Expr::Value(item, _) | Expr::Unlisted(item, _) => {
                self.types.insert(item.ty.name.to_string());
            }
        }
    }

    fn record(&mut self, record: &Record<'_>) {
        self.types.insert(record.item.ty.name.to_string());
        self.runtime.insert("Extra");
        let values = record
            .members
            .iter()
            .filter_map(|(_, value)| value.as_ref());
        values.for_each(|value| self.all_in(value));
    }
}

fn table_function(
    out: &mut Source,
    used: &mut Used,
    context: &Context<'_>,
    table: &Spelled<'_, Table>,
) {
    out.docs(&about::table(context, table.of));
    out.line("#[must_use]");
    let package = &context.package;
    let row = &package.item(&table.row).ty.name;
    used.types.insert(row.to_string());
    out.block(format!("pub fn {}() -> Vec<{row}>", table.name), |out| {
        let rows = package.rows(table);
        used.all_in(&rows);
        out.line(spelled(&rows, ConstantScope::Package, 4));
    });
}
