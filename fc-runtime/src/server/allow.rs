//! Access rules by network and effect.

use super::network::Network;
use crate::operation::Effect;
use std::net::IpAddr;

/// A set of effects.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Effects(u8);

impl Effects {
    pub(super) const ALL: Self = Self(0b1111);

    fn bit(effect: Effect) -> u8 {
        match effect {
            Effect::Read => 1,
            Effect::Config => 1 << 1,
            Effect::Motion => 1 << 2,
            Effect::Unknown => 1 << 3,
        }
    }

    pub(super) fn has(self, effect: Effect) -> bool {
        self.0 & Self::bit(effect) != 0
    }
}

impl FromIterator<Effect> for Effects {
    fn from_iter<I: IntoIterator<Item = Effect>>(effects: I) -> Self {
        Self(effects.into_iter().map(Self::bit).fold(0, |a, b| a | b))
    }
}

/// The networks that apps may connect from. If the list is empty, all may connect.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Allowed(Vec<(Network, Effects)>);

impl Allowed {
    /// Adds a network, or replaces its effects.
    pub(super) fn add(&mut self, network: Network, effects: Effects) {
        self.0.retain(|(named, _)| *named != network);
        self.0.push((network, effects));
    }

    /// Returns the allowed effects for an address, or `None` if it may not connect.
    pub(super) fn effects(&self, address: IpAddr) -> Option<Effects> {
        if self.0.is_empty() {
            return Some(Effects::ALL);
        }
        let holding = self
            .0
            .iter()
            .filter(|(network, _)| network.contains(address));
        let smallest = holding.max_by_key(|(network, _)| network.prefix());
        smallest.map(|(_, effects)| *effects)
    }
}
