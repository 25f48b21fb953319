//! Networks of IP addresses.

use std::fmt;
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr};
use std::str::FromStr;

/// A network of addresses, such as `10.0.0.0/8` or `fd00::/8`. An address without a length is a network of one address.
///
/// An IPv4 address at an IPv6 socket (`::ffff:10.1.2.3`) counts as that IPv4 address, and a network of such addresses
/// as an IPv4 network. `::/0` contains no IPv4 address.
///
/// ```
/// use fc_runtime::Network;
///
/// let robots: Network = "10.0.0.0/8".parse()?;
/// assert!(robots.contains("10.1.2.3".parse()?));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Network {
    /// The first address.
    first: IpAddr,
    /// Number of leading bits that all addresses share.
    prefix: u8,
}

impl Network {
    /// Returns `true` if the network contains the address.
    #[must_use]
    pub fn contains(&self, address: IpAddr) -> bool {
        first(address.to_canonical(), self.prefix) == Some(self.first)
    }

    /// Returns the number of shared leading bits. A larger number means a smaller network.
    pub(super) fn prefix(&self) -> u8 {
        self.prefix
    }
}

/// Returns the number of bits of the address.
fn bits(address: IpAddr) -> u8 {
    match address {
        IpAddr::V4(_) => 32,
        IpAddr::V6(_) => 128,
    }
}

/// Returns the first address with the same `prefix` leading bits, or `None` if the address has fewer bits.
fn first(address: IpAddr, prefix: u8) -> Option<IpAddr> {
    let rest = u32::from(bits(address).checked_sub(prefix)?);
    Some(match address {
        IpAddr::V4(address) => {
            let mask = u32::MAX.checked_shl(rest).unwrap_or(0);
            Ipv4Addr::from_bits(address.to_bits() & mask).into()
        }
        IpAddr::V6(address) => {
            let mask = u128::MAX.checked_shl(rest).unwrap_or(0);
            Ipv6Addr::from_bits(address.to_bits() & mask).into()
        }
    })
}

/// A text is not a [`Network`].
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NetworkError {
    /// The part before the slash is not an address.
    #[error("`{text}` is no IP address: write 10.0.0.0/8, fd00::/8 or one address")]
    Address {
        /// The text.
        text: String,
    },
    /// The part after the slash is not a prefix length.
    #[error("`{text}` is no prefix length: write a number from 0 to {longest}")]
    Prefix {
        /// The text.
        text: String,
        /// Longest prefix of such an address, in bits.
        longest: u8,
    },
    /// The address is not the first of its network, so address or prefix is wrong.
    #[error("the address has bits beyond its prefix: write {network}, or the address alone")]
    HostBits {
        /// The network with this prefix that contains the address.
        network: Network,
    },
}

impl FromStr for Network {
    type Err = NetworkError;

    fn from_str(text: &str) -> Result<Self, NetworkError> {
        let (address, length) = match text.split_once('/') {
            Some((address, length)) => (address, Some(length)),
            None => (text, None),
        };
        let address: IpAddr = address.parse().map_err(|_| NetworkError::Address {
            text: address.to_owned(),
        })?;
        let Some(length) = length else {
            return Ok(Self::from(address));
        };
        let longest = bits(address);
        let prefix = length
            .parse()
            .ok()
            .filter(|prefix| *prefix <= longest && length.bytes().all(|b| b.is_ascii_digit()));
        let wrong = || NetworkError::Prefix {
            text: length.to_owned(),
            longest,
        };
        let prefix = prefix.ok_or_else(wrong)?;
        let network = Self {
            first: first(address, prefix).ok_or_else(wrong)?,
            prefix,
        };
        if network.first != address {
            return Err(NetworkError::HostBits { network });
        }
        Ok(match (address.to_canonical(), prefix.checked_sub(96)) {
            (first @ IpAddr::V4(_), Some(prefix)) if address.is_ipv6() => Self { first, prefix },
            _ => network,
        })
    }
}

/// The network of one address.
impl From<IpAddr> for Network {
    fn from(address: IpAddr) -> Self {
        let first = address.to_canonical();
        Self {
            first,
            prefix: bits(first),
        }
    }
}

impl fmt::Display for Network {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.first, self.prefix)
    }
}
