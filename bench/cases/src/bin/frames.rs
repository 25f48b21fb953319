//! Writes the frames that the benchmarks of all languages use.

use fc_bench_cases::frames;

fn main() {
    for (name, bytes) in frames::all() {
        std::fs::write(frames::directory().join(name), bytes).expect("the frame is written");
    }
}
