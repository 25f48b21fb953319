//! Faults and how they are shown.
