//! Finds the TCP segment in a packet.

use super::Flow;
use etherparse::{EtherType, LaxSlicedPacket, TransportSlice};
use fc_spec::model::{Model, Text};
use std::collections::BTreeSet;
use std::net::{IpAddr, SocketAddr};

/// The ports whose connections are read.
#[derive(Clone, Debug, Default)]
pub struct Ports {
    wanted: BTreeSet<u16>,
}

impl Ports {
    /// Returns the ports of a model and some more.
    #[must_use]
    pub fn new(model: &Model, more: &[u16]) -> Self {
        let ports = model.transport.ports.each().map(|port| port.number);
        Self {
            wanted: ports.into_iter().chain(more.iter().copied()).collect(),
        }
    }

    /// Returns the ports in words.
    pub(crate) fn listed(&self) -> Text {
        Text::listed(&self.wanted)
    }

    /// Returns `true` if one end of a flow has one of the ports.
    #[must_use]
    pub fn include(&self, flow: Flow) -> bool {
        let ends = [flow.from.port(), flow.to.port()];
        ends.iter().any(|port| self.wanted.contains(port))
    }
}

/// The kind of the first header of a packet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Link {
    Ethernet,
    /// IP without a link.
    Ip,
    /// A header of this length that is skipped, then IP.
    Before(usize),
    /// A Linux cooked header of this length, with the protocol at this position.
    Cooked(usize, usize),
}

impl Link {
    /// Returns the kind with this number (<https://www.tcpdump.org/linktypes.html>).
    pub(super) fn numbered(number: i32) -> Option<Self> {
        Some(match number {
            0 | 108 => Self::Before(4),
            1 => Self::Ethernet,
            12 | 14 | 101 | 228 | 229 => Self::Ip,
            113 => Self::Cooked(16, 14),
            276 => Self::Cooked(20, 0),
            _ => return None,
        })
    }
}

/// A TCP segment.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment<'p> {
    pub(super) flow: Flow,
    pub(super) sequence: u32,
    /// The next sequence number that the sender expects from the other side.
    pub(super) acknowledged: Option<u32>,
    pub(super) syn: bool,
    pub(super) fin: bool,
    pub(super) rst: bool,
    pub(super) payload: &'p [u8],
}

/// Returns the segment of a packet, or `None` if the packet is not TCP over IP.
pub(super) fn segment(link: Link, packet: &[u8]) -> Option<Segment<'_>> {
    let sliced = match link {
        Link::Ethernet => LaxSlicedPacket::from_ethernet(packet).ok()?,
        Link::Ip => LaxSlicedPacket::from_ip(packet).ok()?,
        Link::Before(length) => LaxSlicedPacket::from_ip(packet.get(length..)?).ok()?,
        Link::Cooked(length, protocol) => {
            let protocol = packet.get(protocol..)?.first_chunk::<2>()?;
            let protocol = EtherType(u16::from_be_bytes(*protocol));
            LaxSlicedPacket::from_ether_type(protocol, packet.get(length..)?)
        }
    };
    let (from, to): (IpAddr, IpAddr) = match sliced.net.as_ref()? {
        etherparse::LaxNetSlice::Ipv4(ip) => {
            let header = ip.header();
            (
                header.source_addr().into(),
                header.destination_addr().into(),
            )
        }
        etherparse::LaxNetSlice::Ipv6(ip) => {
            let header = ip.header();
            (
                header.source_addr().into(),
                header.destination_addr().into(),
            )
        }
        etherparse::LaxNetSlice::Arp(_) => return None,
    };
    let Some(TransportSlice::Tcp(tcp)) = sliced.transport else {
        return None;
    };
    Some(Segment {
        flow: Flow {
            from: SocketAddr::new(from, tcp.source_port()),
            to: SocketAddr::new(to, tcp.destination_port()),
        },
        sequence: tcp.sequence_number(),
        acknowledged: tcp.ack().then(|| tcp.acknowledgment_number()),
        syn: tcp.syn(),
        fin: tcp.fin(),
        rst: tcp.rst(),
        payload: tcp.payload(),
    })
}
