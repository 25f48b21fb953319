//! Examples of fields and rows of tables.

use super::each::fields;
use super::fields::is_absent_required;
use super::value::{Mismatch, check_field, check_type};
use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::load::draft::Draft;
use crate::load::grammar::{FIELD, TABLE};
use crate::load::resolve::is_derivable;
use crate::model::{Example, Type, TypeRef};

/// Every required field has an example, or one can be derived.
pub(super) fn check_present(draft: &Draft<'_>, faults: &mut Faults) {
    for (_, field, part) in fields(draft) {
        if is_absent_required(field) {
            faults.push(
                Diagnostic::error(
                    FaultCode::AbsentRequired,
                    part.place.at(FIELD.example),
                    format!(
                        "`{}` is never absent, so no example can leave it out",
                        field.wire
                    ),
                )
                .also(part.ty, "a `?` after the type makes it optional"),
            );
        } else if field.example == Example::Derived
            && !is_derivable(&field.ty)
            && !part.borrows_text
        {
            faults.push(
                Diagnostic::error(
                    FaultCode::MissingExample,
                    part.place.name(),
                    format!("`{}` has no example", field.wire),
                )
                .note("numbers and strings need one: documentation, mock and test vectors show it"),
            );
        }
    }
}

/// Examples are values of their type and keep within its bounds.
pub(super) fn check_values(draft: &Draft<'_>, faults: &mut Faults) {
    for (_, field, part) in fields(draft) {
        if let (Example::Given(_), Some(node)) = (&field.example, FIELD.example.of(part.place.node))
        {
            let mut found = Vec::new();
            check_field(draft, field, node, &mut found);
            faults.extend(found.into_iter().map(Mismatch::into_fault));
        }
    }
}

/// Rows of a table are values of its struct.
pub(super) fn check_rows(draft: &Draft<'_>, faults: &mut Faults) {
    for table in &draft.tables {
        let row = Type::Named(TypeRef::clone(&table.item.row));
        for node in TABLE.rows.items(table.place.node) {
            let mut found = Vec::new();
            check_type(draft, &row, node, &mut found);
            for mismatch in found {
                let at = table.place.at(TABLE.row);
                let mismatch = Mismatch {
                    code: FaultCode::RowMismatch,
                    ..mismatch
                };
                faults.push(mismatch.into_fault().also(at, "the struct of a row"));
            }
        }
    }
}
