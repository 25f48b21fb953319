//! Work on one thread, measured in its CPU time.

use crate::report::median;
use cpu_time::ThreadTime;
use std::time::Duration;

/// Something to be measured.
pub struct Case<'a> {
    run: Box<dyn FnMut() + 'a>,
    iterations: u32,
    seconds: Vec<f64>,
}

impl<'a> Case<'a> {
    /// `run` is done many times.
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

    /// Finds out how many iterations take as long as a batch should.
    fn calibrate(&mut self, batch: Duration) {
        // Buffers grow, and what is decided once is decided.
        self.batch();
        while self.batch() < batch / 2 {
            self.iterations = self.iterations.saturating_mul(2);
        }
    }
}

/// How long to measure.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Rounds of all cases.
    pub rounds: usize,
    /// Least CPU time of a batch.
    pub batch: Duration,
}

impl Effort {
    /// For a look or for a report.
    #[must_use]
    pub fn of(quick: bool) -> Self {
        Self { rounds: if quick { 15 } else { 101 }, batch: Duration::from_millis(1) }
    }
}

/// Median seconds of one iteration of each case. The cases take turns, each round in another order.
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
