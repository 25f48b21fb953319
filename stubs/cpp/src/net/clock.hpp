// The clocks of those who have sockets.
#pragma once

#include <cstdint>

#include "fc_runtime/session.hpp"

namespace fc_runtime::detail {

[[nodiscard]] inline Instant clock_now() { return std::chrono::steady_clock::now(); }

/// The local time of day, so that who restarts does not use its ids again.
[[nodiscard]] std::uint32_t first_id_now();

}  // namespace fc_runtime::detail
