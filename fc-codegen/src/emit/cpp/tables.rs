//! The spec's tables of constants. Each is a function that returns its rows as typed values.

use super::fields::enumerators;
use super::layout::{Includes, float, header_file, integer, literal, raw, source_file};
use super::types::field_type_in;
use crate::package::about;
use crate::package::context::Context;
use crate::package::expr::{Expr, Record};
use crate::package::joined::Joined;

/// Generates `tables.hpp`.
pub fn header(context: &Context<'_>) -> String {
    let includes = Includes::new(context, &["vector"], &["messages"], &[]);
    header_file(context, &includes, |out| {
        for table in &context.package.tables {
            out.documented(&about::table(context, table.of));
            let row = context.name_of(&table.row);
            out.line(format!(
                "[[nodiscard]] const std::vector<{row}>& {}();",
                table.name
            ));
        }
    })
}

/// Generates `tables.cpp`.
pub fn source(context: &Context<'_>) -> String {
    let package = &context.package;
    let before = "// A line for each row.\n";
    source_file(context, "tables.hpp", before, |out| {
        for table in &package.tables {
            let row = context.name_of(&table.row);
            out.blank();
            out.enclose(
                &format!("const std::vector<{row}>& {}() {{", table.name),
                "}",
                |out| {
                    out.enclose(
                        &format!("static const std::vector<{row}> rows = {{"),
                        "};",
                        |out| {
                            for values in &table.rows {
                                out.line(format!(
                                    "{},",
                                    record(context, "", &package.record(&table.row, values))
                                ));
                            }
                        },
                    );
                    out.line("return rows;");
                },
            );
        }
    })
}

/// Returns a struct with all of its fields.
fn record(context: &Context<'_>, space: &str, of: &Record<'_>) -> String {
    let members = of.members.iter().map(|(field, value)| match value {
        Some(value) => spelled_in(context, space, value, &field_type_in(context, space, field)),
        None => "std::nullopt".to_owned(),
    });
    let members = members.chain(["{}".to_owned()]).joined(", ");
    format!("{space}{}{{{members}}}", of.item.ty.name)
}

/// Returns a constant of the C++ type `ty`, with `space` before each name of the package, such as `fc::`.
pub fn spelled_in(context: &Context<'_>, space: &str, expr: &Expr<'_>, ty: &str) -> String {
    match expr {
        Expr::Bool(value) => value.to_string(),
        Expr::Int(value) => integer(*value),
        Expr::Float(value) if ty == "float" => format!("{}F", float(*value)),
        Expr::Float(value) => float(*value),
        Expr::Text(text) => literal(text),
        Expr::Bytes(bytes) => {
            let bytes: Vec<String> = bytes.iter().map(|byte| format!("0x{byte:02X}")).collect();
            format!("fc_runtime::Bytes{{{}}}", bytes.join(", "))
        }
        Expr::Json(text) => {
            format!(
                "fc_runtime::Json::parse({}).value_or(fc_runtime::Json())",
                raw(text)
            )
        }
        Expr::Id(id, value) => format!("{space}{id}({})", spelled_in(context, space, value, ty)),
        Expr::List(items) => {
            let inner = item_of(ty);
            let items = items.iter().map(|it| spelled_in(context, space, it, inner));
            format!("{ty}{{{}}}", items.joined(", "))
        }
        Expr::Record(of) | Expr::Choice(_, _, of) => record(context, space, of),
        Expr::Value(item, value) => format!("{space}{}::{}", enumerators(item), value.name),
        Expr::Unlisted(item, value) => match &**value {
            Expr::Text(text) => format!("{space}{}({})", item.ty.name, literal(text)),
            value => format!(
                "static_cast<{space}{}>({})",
                item.ty.name,
                spelled_in(context, space, value, ty)
            ),
        },
    }
}

/// Returns the C++ type of the items of a list.
pub fn item_of(list: &str) -> &str {
    let items = list.strip_prefix("std::vector<");
    items.and_then(|it| it.strip_suffix('>')).unwrap_or(list)
}
