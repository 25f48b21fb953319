//! Checks lists of distinct values of one type.

use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::language::scalar;
use crate::model::Text;
use crate::source::Span;
use crate::syntax::Node;
use crate::text;

/// The error codes and messages for a list of values.
pub(super) struct ValueList {
    /// The code for a value of the wrong type.
    pub wrong: FaultCode,
    /// The place of the type, if the error shows it.
    pub ty: Option<(Span, Text)>,
    /// The code for a repeated value.
    pub repeated: FaultCode,
    /// The message for a repeated value.
    pub message: Text,
}

impl ValueList {
    /// Reports repeated values, and values with mismatches from `check`.
    pub fn check<'t>(
        &self,
        values: impl Iterator<Item = Node<'t>>,
        check: impl Fn(Node<'t>) -> Vec<Diagnostic>,
        faults: &mut Faults,
    ) {
        let mut earlier: Vec<Node<'_>> = Vec::new();
        for node in values {
            faults.extend(check(node).into_iter().map(|fault| {
                let code = self.wrong;
                let fault = Diagnostic { code, ..fault };
                match &self.ty {
                    Some((span, text)) => fault.also(*span, text.clone()),
                    None => fault,
                }
            }));
            let wire = scalar::scalar(node);
            match earlier.iter().find(|it| scalar::scalar(**it) == wire) {
                Some(first) => {
                    let message = self.message.clone();
                    let fault = Diagnostic::error(self.repeated, node.span(), message);
                    faults.push(fault.also(first.span(), text!("第一次在这里", "first here")));
                }
                None => earlier.push(node),
            }
        }
    }
}
