// Checks of the settings of clients and servers.
#pragma once

#include <optional>
#include <string>

#include "fc_runtime/client.hpp"
#include "fc_runtime/server.hpp"

namespace fc_runtime::detail {

/// Returns the first setting that is out of range, such as "`ClientConfig::host` is "", expected a
/// name or address".
[[nodiscard]] std::optional<std::string> fault_of(const ClientConfig& config);
[[nodiscard]] std::optional<std::string> fault_of(const ServerConfig& config);

}  // namespace fc_runtime::detail
