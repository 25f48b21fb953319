//! Measures work on one thread by its CPU time.

use crate::report::median;
use cpu_time::ThreadTime;
use std::time::Duration;

/// A function to measure.
pub struct Case<'a> {
    run: Box<dyn FnMut() + 'a>,
    iterations: u32,
    seconds: Vec<f64>,
}

impl<'a> Case<'a> {
    /// Creates a case that calls `run` many times.
    pub fn new(run: impl FnMut() + 'a) -> Self {
        Self { run: Box::new(run), iterations: 1, seconds: Vec::new() }
    }

    fn batch(&mut self) -> Duration {
        let start = ThreadTime::now();
        for _ in 0..self.iterations {
            (self.run)();
        }
        start.elapsed()
    }

    /// Doubles the iterations until they take at least half of `batch`.
    fn calibrate(&mut self, batch: Duration) {
        // This first batch lets buffers grow and runs all one-time work.
        self.batch();
        while self.batch() < batch / 2 {
            self.iterations = self.iterations.saturating_mul(2);
        }
    }
}

/// Number of rounds and length of a batch.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Rounds, each with one batch of every case.
    pub rounds: usize,
    /// Intended CPU time of a batch. A batch takes at least half of it.
    pub batch: Duration,
}

impl Effort {
    /// Returns the effort for a quick look or for a report.
    #[must_use]
    pub fn of(quick: bool) -> Self {
        Self { rounds: if quick { 15 } else { 101 }, batch: Duration::from_millis(1) }
    }
}

/// Returns the median seconds of one iteration of each case. The cases take turns, in a new random order each round.
#[must_use]
pub fn measure(mut cases: Vec<Case<'_>>, effort: Effort) -> Vec<f64> {
    for case in &mut cases {
        case.calibrate(effort.batch);
    }
    let mut order: Vec<usize> = (0..cases.len()).collect();
    let mut state = 0x2545_F491_4F6C_DD1D_u64;
    for _ in 0..effort.rounds {
        for index in (1..order.len()).rev() {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            order.swap(index, (state % (index as u64 + 1)) as usize);
        }
        for &index in &order {
            let case = &mut cases[index];
            let seconds = case.batch().as_secs_f64() / f64::from(case.iterations);
            case.seconds.push(seconds);
        }
    }
    cases.into_iter().map(|case| median(case.seconds)).collect()
}
