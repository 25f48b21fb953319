//! What no grammar can say.

use super::draft::Draft;
use crate::diagnostic::Faults;

pub(super) fn check(_draft: &Draft<'_>, _whole: bool, _faults: &mut Faults) {}
