// Who may connect to a robot, and who may call what.
#pragma once

#include <asio/ip/address.hpp>
#include <optional>
#include <string>
#include <vector>

#include "fc_runtime/server.hpp"

namespace fc_runtime::detail {

/// Networks, each with what may be called from it.
class AllowList {
 public:
  /// What is wrong with the networks, if anything is.
  [[nodiscard]] std::optional<BindError> read(const std::vector<Allowed>& allow);
  /// The effects of what may be called from an address, none for all of them; null if nobody may
  /// connect from there.
  [[nodiscard]] const std::vector<Effect>* effects(const asio::ip::address& address) const;

 private:
  struct Network {
    std::vector<unsigned char> bytes;
    /// How many of its bits an address has to share.
    std::size_t prefix = 0;
    std::vector<Effect> effects;
  };

  std::vector<Network> networks_;
  std::vector<Effect> all_;
};

}  // namespace fc_runtime::detail
