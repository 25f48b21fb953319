//! What is owed over one wire: whatever a robot begins to carry out it has to answer, unless something
//! that it cannot help keeps it from that; and an app must not lose an answer that has come.

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
    /// What has been done to the app's direction that ends it, if something has.
    pub deafened: Option<&'static str>,
    /// How many were answered after that.
    pub answered_deaf: u64,
    /// The same of the robot's direction: what comes after it cannot be told into frames.
    pub garbled: bool,
    /// What must not be.
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
