//! Obligations over one wire: a robot must answer every request that it starts, unless the wire prevents it, and an app
//! must not lose an arrived response.

use std::collections::{HashMap, HashSet};
use std::sync::{Arc, Mutex};
use tokio::time::Instant;

/// By message id; the numbers are those of the calls.
#[derive(Default)]
pub struct Ledger {
    begun: HashMap<u32, u32>,
    answered: HashSet<u32>,
    arrived: HashSet<u32>,
    /// The robot is cut off by then.
    pub cut_off: Option<Instant>,
    /// The fault that ends the app's direction, if any.
    pub deafened: Option<&'static str>,
    /// Number of responses after that.
    pub answered_deaf: u64,
    /// The fault in the robot's direction after which bytes cannot be split into frames.
    pub garbled: bool,
    /// Violations.
    pub faults: Vec<String>,
}

pub type Shared = Arc<Mutex<Ledger>>;

impl Ledger {
    /// A handler has begun with a request.
    pub fn begins(&mut self, id: u32, number: u32) {
        if self.begun.insert(id, number).is_some() {
            self.faults.push(format!(
                "call {number} was carried out twice on one connection"
            ));
        }
    }

    /// The robot has written an answer.
    pub fn answers(&mut self, id: u32) {
        if self.begun.contains_key(&id) && self.answered.insert(id) && self.deafened.is_some() {
            self.answered_deaf += 1;
        }
    }

    /// The app has read an answer.
    pub fn arrives(&mut self, id: u32) {
        if self.begun.contains_key(&id) {
            self.arrived.insert(id);
        }
    }

    /// The robot has closed the connection though it could have answered.
    pub fn closes(&mut self) {
        if self.cut_off.is_some_and(|at| at <= Instant::now()) {
            return;
        }
        for (id, number) in &self.begun {
            if !self.answered.contains(id) {
                self.faults
                    .push(format!("call {number} was carried out and never answered"));
            }
        }
    }

    /// The calls whose answers have come.
    pub fn arrived(&self) -> impl Iterator<Item = u32> + '_ {
        self.arrived
            .iter()
            .filter_map(|id| self.begun.get(id).copied())
    }
}
