//! fc-derive
