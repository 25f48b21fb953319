// The choice of a connection to close for a new one at the limit.
#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <string>

#include "fc_runtime/push.hpp"

namespace fc_runtime::detail {

/// The connections of a port, in order of age, and their limits.
template <class Peer>
class Crowd {
 public:
  Crowd(const std::map<ConnectionId, Peer>& peers, std::size_t per_address, std::size_t limit)
      : peers_(peers), per_address_(per_address), limit_(limit) {}

  /// Returns `true` if there is room for one more from an address.
  [[nodiscard]] bool has_room(const std::string& address) const {
    return peers_.size() < limit_ && from(address) < per_address_;
  }

  /// Returns the connection to close for a new one from an address: the oldest silent one from the
  /// address with most connections. At the limit of the address, it has the same address.
  template <class IsSilent>
  [[nodiscard]] std::optional<ConnectionId> gives_way(const std::string& address,
                                                      const IsSilent& is_silent) const {
    const bool is_own = from(address) >= per_address_;
    std::optional<ConnectionId> found;
    std::size_t most = 0;
    for (const auto& [id, peer] : peers_) {
      if ((is_own && peer.address != address) || !is_silent(id, peer)) continue;
      const std::size_t count = from(peer.address);
      if (count <= most) continue;
      most = count;
      found = id;
    }
    return found;
  }

 private:
  [[nodiscard]] std::size_t from(const std::string& address) const {
    const auto is_from = [&](const auto& entry) { return entry.second.address == address; };
    return static_cast<std::size_t>(std::count_if(peers_.begin(), peers_.end(), is_from));
  }

  const std::map<ConnectionId, Peer>& peers_;
  std::size_t per_address_;
  std::size_t limit_;
};

}  // namespace fc_runtime::detail
