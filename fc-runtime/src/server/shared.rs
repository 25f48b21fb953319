//! The state that all tasks of a server share: its connections, their limits, and the shutdown.

use super::allow::Effects;
use super::budget::{ConnectionMemory, MemoryBudget};
use super::config::Settings;
use super::connection_id::ConnectionId;
use super::counters::Counters;
use super::data::{DataEntry, DataPeer, Inbox, Outgoing, Owner, QUEUE};
use super::detached::DetachedHandlers;
use super::driver::Driver;
use super::gate::Gate;
use super::handshake::shake;
use super::peer::Peer;
use super::push::{Audience, PushError};
use super::service::Service;
use super::table::Table;
use crate::frame::{FrameId, Prepared};
use crate::link::Transport;
use crate::metrics::{Gauge, Held};
use crate::protocol::Protocol;
use crate::sync::lock;
use std::cell::OnceCell;
use std::collections::HashSet;
use std::future::poll_fn;
use std::io;
use std::marker::PhantomData;
use std::net::{IpAddr, SocketAddr};
use std::pin::pin;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, Weak};
use std::time::Instant;
use tokio::sync::{Notify, mpsc, oneshot, watch};
use tokio::task::JoinSet;
use tokio::time::sleep_until;

/// The lifecycle of a server.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Life {
    Running,
    /// Ends at this time at the latest.
    Stopping(Instant),
    Over,
}

/// The state behind all handles and tasks of a server.
pub(super) struct Shared<P: Protocol> {
    pub(super) settings: Arc<Settings>,
    service: Arc<dyn Service<P>>,
    pub(super) counters: Arc<Counters>,
    pub(super) peers: Mutex<Table<Arc<Peer<P>>>>,
    data_peers: Mutex<Table<DataEntry<P>>>,
    pub(super) inbox: Arc<Inbox>,
    detached: Arc<DetachedHandlers>,
    gate: Gate,
    pub(super) budget: MemoryBudget,
    tasks: Mutex<JoinSet<()>>,
    next_connection: AtomicU64,
    life: watch::Sender<Life>,
}

/// The reason of a replaced connection, for the log.
const DISPLACED: &str = "another has taken its place";

impl<P: Protocol> Shared<P> {
    pub(super) fn new(settings: Settings, service: Arc<dyn Service<P>>) -> Arc<Self> {
        Arc::new(Self {
            detached: Arc::new(DetachedHandlers::new(settings.abandoned_handlers)),
            budget: MemoryBudget::new(settings.memory),
            settings: Arc::new(settings),
            service,
            counters: Arc::new(Counters::of::<P>()),
            peers: Mutex::default(),
            data_peers: Mutex::default(),
            inbox: Arc::default(),
            gate: Gate::default(),
            tasks: Mutex::new(JoinSet::new()),
            next_connection: AtomicU64::new(1),
            life: watch::Sender::new(Life::Running),
        })
    }

    /// Returns the allowed effects for an address. If it may not connect, counts and logs that and returns `None`.
    fn allowed(&self, address: SocketAddr) -> Option<Effects> {
        let effects = self.settings.allowed.effects(address.ip());
        if effects.is_none() {
            self.counters.connections_forbidden.increment();
            if let Some(held) = self.counters.limiters.forbidden.admit() {
                let (protocol, peer, held) = (P::NAME, address.ip(), held.shown());
                tracing::warn!(protocol, %peer, held, "refused: the address is not allowed");
            }
        }
        effects
    }

    /// Serves a new command connection, or closes it if it is forbidden or there are too many.
    pub(super) fn serve<S: Transport>(
        self: &Arc<Self>,
        handshake: impl Future<Output = io::Result<S>> + Send + 'static,
        address: SocketAddr,
    ) -> Option<ConnectionId> {
        let effects = self.allowed(address)?;
        let id = self.next_id();
        let settings = Arc::clone(&self.settings);
        let (counters, detached) = (Arc::clone(&self.counters), Arc::clone(&self.detached));
        let peer = Arc::new_cyclic(|peer: &Weak<Peer<P>>| {
            let memory = self.budget.open(id, peer.clone());
            Peer::new(id, address, effects, settings, counters, detached, memory)
        });
        let silent = |_: IpAddr, peer: &Arc<Peer<P>>| !peer.is_heard();
        let admitted = self.admit(&self.peers, id, address, Arc::clone(&peer), silent);
        if let Some(displaced) = admitted.ok()? {
            displaced.give_way(DISPLACED);
        }
        for data in lock(&self.data_peers).of_mut(address.ip()) {
            data.owner.note(id);
        }
        self.counters.connections.increment();
        let (service, gate) = (Arc::clone(&self.service), self.gate.clone());
        let registered = self.registered(id, &self.counters.gauges.connections);
        self.spawn(async move {
            let _registered = registered;
            let (limit, whose) = (peer.settings.header_timeout, (peer.id, peer.address));
            let stream =
                shake::<P, S>(handshake, peer.sent_away(), limit, &peer.counters, whose).await;
            if let Some(stream) = stream {
                Driver::new(stream, peer, service, gate).run().await;
            }
        });
        Some(id)
    }

    /// Serves a new data connection, or closes it if it is forbidden or there are too many.
    pub(super) fn serve_data<S: Transport>(
        self: &Arc<Self>,
        handshake: impl Future<Output = io::Result<S>> + Send + 'static,
        address: SocketAddr,
    ) -> Option<ConnectionId> {
        self.allowed(address)?;
        let id = self.next_id();
        let (sender, outbox) = mpsc::channel(QUEUE);
        let (entered, left) = oneshot::channel();
        let peer = Arc::new_cyclic(|peer: &Weak<DataPeer<P>>| DataPeer {
            id,
            address,
            settings: Arc::clone(&self.settings),
            counters: Arc::clone(&self.counters),
            inbox: Arc::clone(&self.inbox),
            answers: sender.downgrade(),
            gate: self.gate.clone(),
            memory: Arc::new(self.budget.open(id, peer.clone())),
            evicted: Notify::new(),
            heard: AtomicBool::new(false),
            protocol: PhantomData,
        });
        // An app that only receives is known by its command connection. The list is created once, and only if there are
        // too many connections.
        let speakers = OnceCell::new();
        let silent = |from: IpAddr, data: &DataEntry<P>| {
            !data.peer.heard.load(Ordering::Relaxed)
                && !speakers.get_or_init(|| self.speakers()).contains(&from)
        };
        let entry = DataEntry {
            sender,
            peer: Arc::clone(&peer),
            owner: Owner::Nobody,
            _entered: entered,
        };
        // A replaced connection ends when its entry is dropped.
        drop(
            self.admit(&self.data_peers, id, address, entry, silent)
                .ok()?,
        );
        // Look only after the entry has been added: later connections note themselves in it.
        let apps: Vec<_> = lock(&self.peers)
            .iter()
            .filter(|(_, from, _)| *from == address.ip())
            .map(|(app, _, _)| app)
            .collect();
        if let Some(entry) = lock(&self.data_peers).get_mut(id) {
            for app in apps {
                entry.owner.note(app);
            }
        }
        self.counters.data_connections.increment();
        let registered = self.registered(id, &self.counters.gauges.data_connections);
        self.spawn(async move {
            let _registered = registered;
            let gone = async {
                let _ = left.await;
            };
            let (limit, whose) = (peer.settings.header_timeout, (peer.id, peer.address));
            let stream = shake::<P, S>(handshake, gone, limit, &peer.counters, whose).await;
            if let Some(stream) = stream {
                peer.run(stream, outbox).await;
            }
        });
        Some(id)
    }

    /// Returns the addresses from which data has arrived at the command port.
    fn speakers(&self) -> HashSet<IpAddr> {
        let peers = lock(&self.peers);
        let heard = peers.iter().filter(|(_, _, peer)| peer.is_heard());
        heard.map(|(_, address, _)| address).collect()
    }

    fn next_id(&self) -> ConnectionId {
        ConnectionId(self.next_connection.fetch_add(1, Ordering::Relaxed))
    }

    /// Adds a connection to a table. If the table is full or has too many connections of the address, a `silent` one is
    /// replaced and returned. Without a silent one, the new connection is refused.
    fn admit<T>(
        &self,
        table: &Mutex<Table<T>>,
        id: ConnectionId,
        address: SocketAddr,
        connection: T,
        silent: impl Fn(IpAddr, &T) -> bool,
    ) -> Result<Option<T>, NotAdmitted> {
        let settings = &self.settings;
        let address = address.ip();
        let mut table = lock(table);
        // Check under the lock, because a shutdown looks at the table afterwards.
        if *self.life.borrow() != Life::Running {
            return Err(NotAdmitted);
        }
        let (why, limit, displaced) = if table.from(address) >= settings.connections_per_address {
            let displaced = table.displace(|from, entry| from == address && silent(from, entry));
            let why = "too many connections from one address";
            (why, settings.connections_per_address, displaced)
        } else if table.len() >= settings.limits.connections {
            let why = "too many connections";
            (why, settings.limits.connections, table.displace(silent))
        } else {
            table.insert(id, address, connection);
            return Ok(None);
        };
        let displaced = displaced.map(|(gone, from, entry)| {
            table.insert(id, address, connection);
            (gone, from, entry)
        });
        drop(table);
        let protocol = P::NAME;
        let Some((gone, from, entry)) = displaced else {
            self.counters.connections_refused.increment();
            if let Some(held) = self.counters.limiters.refused.admit() {
                let held = held.shown();
                tracing::warn!(protocol, peer = %address, limit, held, "refused: {why}");
            }
            return Err(NotAdmitted);
        };
        if self.counters.connections_displaced.increment_sampled() {
            let (peer, by, connection) = (from, address, gone.0);
            tracing::warn!(protocol, %peer, connection, %by, limit, "closed a silent connection: {why}");
        }
        Ok(Some(entry))
    }

    fn registered(self: &Arc<Self>, id: ConnectionId, open: &Gauge) -> Registered<P> {
        Registered {
            shared: Arc::clone(self),
            id,
            _open: open.hold(),
        }
    }

    fn spawn(&self, task: impl Future<Output = ()> + Send + 'static) {
        let mut tasks = lock(&self.tasks);
        // Check under the lock, because a task spawned after the end would never be aborted.
        if *self.life.borrow() == Life::Over {
            return;
        }
        // Remove ended tasks, because they take memory.
        while tasks.try_join_next().is_some() {}
        tasks.spawn(task);
    }

    /// Resolves when the server is to stop.
    pub(super) async fn stop_requested(&self) {
        let mut life = self.life.subscribe();
        // An error would mean that the server no longer exists.
        let _ = life.wait_for(|life| *life != Life::Running).await;
    }

    /// Accepts no more connections and requests, and lets existing ones end until `deadline`. Of several deadlines the
    /// earliest applies.
    pub(super) fn stop(&self, deadline: Instant) {
        self.life.send_if_modified(|life| {
            let sooner = match *life {
                Life::Running => true,
                Life::Stopping(before) => deadline < before,
                Life::Over => false,
            };
            if *life == Life::Running {
                tracing::info!(protocol = P::NAME, "shutting down");
            }
            if sooner {
                *life = Life::Stopping(deadline);
            }
            sooner
        });
        let peers: Vec<_> = lock(&self.peers).values().cloned().collect();
        for peer in peers {
            peer.drain();
        }
        // Data connections end when their queued frames are sent.
        lock(&self.data_peers).clear();
    }

    /// Waits until all connections and handlers have ended, and aborts them at the deadline.
    pub(super) async fn drain(&self) {
        let all = std::future::poll_fn(|cx| {
            let mut tasks = lock(&self.tasks);
            while std::task::ready!(tasks.poll_join_next(cx)).is_some() {}
            drop(tasks);
            // Without connections, no more handlers are detached.
            self.detached.poll_ended(cx)
        });
        self.over(all).await;
    }

    /// Waits for `all`, for the end of the server, or for the deadline, at which it ends the server.
    pub(super) async fn over(&self, all: impl Future<Output = ()>) {
        let mut life = self.life.subscribe();
        let mut all = pin!(all);
        loop {
            let Life::Stopping(deadline) = *life.borrow_and_update() else {
                return;
            };
            tokio::select! {
                () = &mut all => return,
                () = sleep_until(deadline.into()) => {
                    tracing::warn!(
                        protocol = P::NAME,
                        "connections or handlers were cut off at the end of the grace"
                    );
                    return self.abort();
                }
                _ = life.changed() => {}
            }
        }
    }

    /// Ends all connections at once.
    pub(super) fn abort(&self) {
        let mut tasks = lock(&self.tasks);
        tasks.abort_all();
        self.life.send_replace(Life::Over);
        drop(tasks);
        self.detached.abort();
        *lock(&self.inbox) = None;
    }

    pub(super) fn audience(&self, audience: Audience) -> Result<Vec<Arc<Peer<P>>>, PushError> {
        let peers = lock(&self.peers);
        match audience {
            Audience::All => Ok(peers.values().cloned().collect()),
            Audience::One(id) => match peers.get(id) {
                Some(peer) => Ok(vec![Arc::clone(peer)]),
                None => Err(PushError::NoConnection(id)),
            },
        }
    }
}

impl<P: Protocol> Shared<P> {
    /// Returns the data connections of an audience.
    pub(super) fn data_audience(&self, audience: Audience) -> Result<Vec<Outbox>, PushError> {
        let Audience::One(id) = audience else {
            let data_peers = lock(&self.data_peers);
            return Ok(data_peers.values().map(Outbox::of).collect());
        };
        let host = lock(&self.peers).get(id).map(|peer| peer.address.ip());
        let data_peers = lock(&self.data_peers);
        if let Some(data) = data_peers.get(id) {
            return Ok(vec![Outbox::of(data)]);
        }
        let own = data_peers
            .values()
            .filter(|data| data.owner == Owner::One(id));
        let own: Vec<_> = own.map(Outbox::of).collect();
        let anybodys = |(_, address, data): (_, _, &DataEntry<P>)| {
            host == Some(address) && data.owner == Owner::Several
        };
        if !own.is_empty() {
            Ok(own)
        } else if data_peers.iter().any(anybodys) {
            Err(PushError::Ambiguous(id))
        } else {
            Err(PushError::NoConnection(id))
        }
    }
}

/// The queue for streams to one data connection.
pub(super) struct Outbox {
    sender: mpsc::Sender<Outgoing>,
    memory: Arc<ConnectionMemory>,
}

impl Outbox {
    fn of<P>(data: &DataEntry<P>) -> Self {
        Self {
            sender: data.sender.clone(),
            memory: Arc::clone(&data.peer.memory),
        }
    }

    /// Queues a frame when there is room and memory for it. Returns `false` if the connection has ended.
    pub(super) async fn send(&self, id: FrameId, body: Prepared) -> bool {
        let charge = poll_fn(|cx| self.memory.poll_queue(cx, body.len())).await;
        let frame = Outgoing { id, body, charge };
        self.sender.send(frame).await.is_ok()
    }
}

/// There is no room for a connection, or the server has ended.
struct NotAdmitted;

/// Removes the table entry of a connection when it is dropped.
struct Registered<P: Protocol> {
    shared: Arc<Shared<P>>,
    id: ConnectionId,
    _open: Held,
}

impl<P: Protocol> Drop for Registered<P> {
    fn drop(&mut self) {
        lock(&self.shared.peers).remove(self.id);
        lock(&self.shared.data_peers).remove(self.id);
    }
}
