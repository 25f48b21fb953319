//! Runs a target on many random changes of its corpus.
//!
//! It has no coverage instrumentation, which takes most of the time of a fuzzer. The fuzzer finds new paths and keeps
//! them in the corpus. This program then tries many more inputs near them. A seed makes a run repeatable.
//!
//! ```text
//! cargo run --release --example many -- memory 100000000 [SEED]
//! ```

use std::fs;
use std::path::Path;
use std::process::ExitCode;
use std::time::{Duration, Instant};

/// The target `memory` reads its counts.
#[global_allocator]
static ALLOCATOR: peak_alloc::PeakAlloc = fc_fuzz::COUNTING;

/// Longest input, in bytes.
const LONGEST: usize = 1024;
/// Time between two lines of progress.
const PROGRESS: Duration = Duration::from_secs(10);

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let (name, count, seed) = match words.as_slice() {
        [name, count] => (name, count.parse(), Ok(1)),
        [name, count, seed] => (name, count.parse(), seed.parse()),
        _ => return usage(),
    };
    let target = fc_fuzz::TARGETS.iter().find(|(known, _)| known == name);
    let (Some((_, target)), Ok(count), Ok(seed)) = (target, count, seed) else {
        return usage();
    };
    let corpus = corpus(name);
    if corpus.is_empty() {
        eprintln!("corpus/{name} is empty: cargo run --release --example seed");
        return ExitCode::FAILURE;
    }
    let mut random = Random(seed);
    let (started, mut told) = (Instant::now(), Instant::now());
    let mut input = Vec::with_capacity(2 * LONGEST);
    for done in 0_u64..count {
        random.change(&corpus, &mut input);
        target(&input);
        if done % 1024 == 0 && told.elapsed() >= PROGRESS {
            told = Instant::now();
            eprintln!("{name}: {done} of {count} after {:.0?}", started.elapsed());
        }
    }
    println!(
        "{name}: {count} inputs of seed {seed} from a corpus of {}, nothing found",
        corpus.len()
    );
    ExitCode::SUCCESS
}

fn usage() -> ExitCode {
    eprintln!("usage: many TARGET COUNT [SEED]");
    ExitCode::from(2)
}

/// Returns the inputs in the corpus of a target, sorted by file name, without those above [`LONGEST`].
fn corpus(name: &str) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("corpus")
        .join(name);
    let files = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut paths: Vec<_> = files.map(|file| file.path()).collect();
    paths.sort();
    let inputs = paths.iter().filter_map(|path| fs::read(path).ok());
    inputs.filter(|input| input.len() <= LONGEST).collect()
}

/// A random number generator, Marsaglia's xorshift64.
struct Random(u64);

impl Random {
    fn below(&mut self, bound: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        usize::try_from(self.0 >> 33).unwrap_or(0) % bound.max(1)
    }

    /// Makes an input from one or two inputs of the corpus, with up to eight changes.
    fn change(&mut self, corpus: &[Vec<u8>], input: &mut Vec<u8>) {
        input.clear();
        input.extend_from_slice(&corpus[self.below(corpus.len())]);
        if self.below(4) == 0 {
            let other = &corpus[self.below(corpus.len())];
            input.truncate(self.below(input.len() + 1));
            input.extend_from_slice(&other[self.below(other.len() + 1)..]);
        }
        for _ in 0..self.below(9) {
            let at = self.below(input.len() + 1);
            let byte = self.byte();
            match self.below(5) {
                0 => input.insert(at, byte),
                1 if at < input.len() => drop(input.remove(at)),
                2 => {
                    let end = (at + self.below(16)).min(input.len());
                    input.extend_from_within(at..end);
                }
                _ => input
                    .get_mut(at)
                    .into_iter()
                    .for_each(|place| *place = byte),
            }
        }
        input.truncate(LONGEST);
    }

    /// Returns an arbitrary byte, or in half of all cases one that is common in JSON.
    fn byte(&mut self) -> u8 {
        const JSON: &[u8] = br#"{}[]",:\0123456789eE+-.truefalsn "#;
        match self.below(2) {
            0 => JSON[self.below(JSON.len())],
            _ => u8::try_from(self.below(256)).unwrap_or(0),
        }
    }
}
