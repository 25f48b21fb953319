//! fc-generated
