//! Example messages and frames, composed from the model.
