//! What messages cost in memory, as an allocator counts it.

#![allow(clippy::unwrap_used, reason = "a test may")]

use fc_derive::Message;
use fc_runtime::Extra;
use fc_runtime::json::{decode, to_vec};
use peak_alloc::PeakAlloc;
use std::sync::{Mutex, PoisonError};

#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

/// Tests of one process share its allocator.
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

/// What `work` gives, the most memory that was held during it, and what its result holds, in bytes
/// beyond what was held before.
fn measured<T>(work: impl FnOnce() -> T) -> (T, usize, usize) {
    let before = ALLOCATOR.current_usage();
    ALLOCATOR.reset_peak_usage();
    let result = work();
    let peak = ALLOCATOR.peak_usage().saturating_sub(before);
    let held = ALLOCATOR.current_usage().saturating_sub(before);
    (result, peak, held)
}

const MIB: usize = 1 << 20;

#[derive(Clone, Debug, PartialEq, Message)]
struct Open {
    known: Option<i64>,
    #[fc(extra)]
    extra: Extra,
}

/// An object of `members`, so many that the text has `length` bytes or a few less.
fn object_of(member: &str, length: usize) -> String {
    let members = vec![member; length.saturating_sub(2) / (member.len() + 1)];
    format!("{{{}}}", members.join(","))
}

#[test]
fn unknown_keys_cost_what_their_text_does() {
    let _alone = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
    for member in [
        "\"a\":[]",
        "\"a\":{}",
        "\"\":0",
        "\"\\u0061\":\"b\"",
        "\"\\n\":[1]",
    ] {
        let text = object_of(member, MIB);
        let (open, peak, held) = measured(|| decode::<Open>(text.as_bytes(), 64).unwrap());
        // A buffer that grows lies twice in memory while it is moved.
        assert!(
            held <= text.len() + 1024,
            "{member}: {held} of {}",
            text.len()
        );
        assert!(
            peak <= text.len() * 2 + 1024,
            "{member}: {peak} of {}",
            text.len()
        );
        assert!(to_vec(&open).len() <= text.len());
    }
}
