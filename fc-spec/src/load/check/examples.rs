//! Checks examples of fields and rows of tables.

use super::fields::is_absent_required;
use super::iter::fields;
use super::value::{check_field, check_type};
use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::language::grammar::{FIELD, TABLE};
use crate::load::draft::Draft;
use crate::load::resolve::is_derivable;
use crate::model::{Example, Type, TypeRef};
use crate::text;

/// Checks that every required field has an example or a derivable one.
pub(super) fn check_present(draft: &Draft<'_>, faults: &mut Faults) {
    for (_, field, part) in fields(draft) {
        if is_absent_required(field) {
            let message = text!(
                "`{field}` 是必填，示例不能省略它",
                "`{field}` is required, so an example cannot leave it out",
                field = field.wire
            );
            let span = part.origin.at(FIELD.example);
            let fault = Diagnostic::error(FaultCode::AbsentRequired, span, message);
            faults.push(fault.also(
                part.ty,
                text!(
                    "写上示例，或者在类型后面加 `?` 改为可选",
                    "write an example, or add `?` to the type to make it optional"
                ),
            ));
        } else if field.example == Example::Derived
            && !is_derivable(&field.ty)
            && !part.borrows_text
        {
            let message = text!(
                "`{field}` 没有示例",
                "`{field}` has no example",
                field = field.wire
            );
            let fault = Diagnostic::error(FaultCode::MissingExample, part.origin.name(), message);
            faults.push(fault.note(text!(
                "写上 `example`：文档、示例机器人和标准帧都要用",
                "write `example`: the documentation, the example robot and the golden frames use it"
            )));
        }
    }
}

/// Checks that examples match their type and its bounds.
pub(super) fn check_values(draft: &Draft<'_>, faults: &mut Faults) {
    for (_, field, part) in fields(draft) {
        if let (Example::Given(_), Some(node)) =
            (&field.example, FIELD.example.of(part.origin.node))
        {
            faults.extend(check_field(draft, field, node));
        }
    }
}

/// Checks that rows of a table match its struct.
pub(super) fn check_rows(draft: &Draft<'_>, faults: &mut Faults) {
    for table in &draft.tables {
        let row = Type::Named(TypeRef::clone(&table.item.row));
        for node in TABLE.rows.items(table.origin.node) {
            for fault in check_type(draft, &row, node) {
                let code = FaultCode::RowMismatch;
                let at = table.origin.at(TABLE.row);
                let fault = Diagnostic { code, ..fault };
                faults.push(fault.also(at, text!("一行的结构", "the struct of a row")));
            }
        }
    }
}
