// The networks that may connect to a robot, and the commands that they may call.
#pragma once

#include <asio/ip/address.hpp>
#include <optional>
#include <string>
#include <vector>

#include "fc_runtime/server.hpp"

namespace fc_runtime::detail {

/// Networks with their allowed effects.
class AllowList {
 public:
  /// Reads the networks. Returns the error, if any.
  [[nodiscard]] std::optional<BindError> read(const std::vector<Allowed>& allow);
  /// Returns the effects that an address may call; empty for all. Returns null if it may not
  /// connect.
  [[nodiscard]] const std::vector<Effect>* effects(const asio::ip::address& address) const;

 private:
  struct Network {
    std::vector<unsigned char> bytes;
    /// Length of the prefix in bits.
    std::size_t prefix = 0;
    std::vector<Effect> effects;
  };

  std::vector<Network> networks_;
  std::vector<Effect> all_;
};

}  // namespace fc_runtime::detail
