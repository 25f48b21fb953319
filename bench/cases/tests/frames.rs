//! Checks that the files in `bench/frames` equal the frames that the spec produces now.

use fc_bench_cases::frames;

#[test]
fn frames_for_all_languages_are_those_of_now() {
    let all = frames::all();
    assert!(!all.is_empty());
    for (name, bytes) in all {
        let there = std::fs::read(frames::directory().join(name)).expect("a frame");
        assert!(there == bytes, "bench/frames/{name} is stale; run the program `frames` of fc-bench-cases");
    }
}
