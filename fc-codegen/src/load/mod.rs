//! From the syntax tree to the resolved model.
