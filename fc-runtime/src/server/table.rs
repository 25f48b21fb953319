//! The connections of one port by address, and the choice of a connection to be replaced.

use super::connection_id::ConnectionId;
use std::cmp::Reverse;
use std::collections::HashMap;
use std::net::IpAddr;

/// The connections of one port by id.
pub(super) struct Table<T> {
    connections: HashMap<ConnectionId, (IpAddr, T)>,
    addresses: HashMap<IpAddr, usize>,
}

impl<T> Default for Table<T> {
    fn default() -> Self {
        Self {
            connections: HashMap::new(),
            addresses: HashMap::new(),
        }
    }
}

impl<T> Table<T> {
    pub(super) fn len(&self) -> usize {
        self.connections.len()
    }

    /// Returns the number of connections from `address`.
    pub(super) fn from(&self, address: IpAddr) -> usize {
        self.addresses.get(&address).copied().unwrap_or(0)
    }

    /// Removes a connection to make room, among those for which `goes` returns `true`: the oldest one of the address
    /// with the most connections.
    pub(super) fn displace(
        &mut self,
        mut goes: impl FnMut(IpAddr, &T) -> bool,
    ) -> Option<(ConnectionId, IpAddr, T)> {
        let crowd = |address: &IpAddr| self.addresses.get(address).copied().unwrap_or(0);
        let (_, Reverse(id)) = self
            .connections
            .iter()
            .filter(|(_, (address, connection))| goes(*address, connection))
            .map(|(id, (address, _))| (crowd(address), Reverse(*id)))
            .max()?;
        let (address, connection) = self.take(id)?;
        Some((id, address, connection))
    }

    pub(super) fn insert(&mut self, id: ConnectionId, address: IpAddr, connection: T) {
        self.connections.insert(id, (address, connection));
        *self.addresses.entry(address).or_default() += 1;
    }

    pub(super) fn remove(&mut self, id: ConnectionId) {
        self.take(id);
    }

    fn take(&mut self, id: ConnectionId) -> Option<(IpAddr, T)> {
        let (address, connection) = self.connections.remove(&id)?;
        if let Some(count) = self.addresses.get_mut(&address) {
            *count -= 1;
            if *count == 0 {
                self.addresses.remove(&address);
            }
        }
        Some((address, connection))
    }

    pub(super) fn clear(&mut self) {
        self.connections.clear();
        self.addresses.clear();
    }

    pub(super) fn get(&self, id: ConnectionId) -> Option<&T> {
        self.connections.get(&id).map(|(_, connection)| connection)
    }

    pub(super) fn get_mut(&mut self, id: ConnectionId) -> Option<&mut T> {
        let entry = self.connections.get_mut(&id);
        entry.map(|(_, connection)| connection)
    }

    /// Returns the connections from `host`.
    pub(super) fn of_mut(&mut self, host: IpAddr) -> impl Iterator<Item = &mut T> {
        let connections = self.connections.values_mut();
        connections
            .filter_map(move |(address, connection)| (*address == host).then_some(connection))
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = (ConnectionId, IpAddr, &T)> {
        let connections = self.connections.iter();
        connections.map(|(id, (address, connection))| (*id, *address, connection))
    }

    pub(super) fn values(&self) -> impl Iterator<Item = &T> {
        self.connections.values().map(|(_, connection)| connection)
    }
}
