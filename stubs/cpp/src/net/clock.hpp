// The clocks of code with sockets.
#pragma once

#include <cstdint>

#include "fc_runtime/session.hpp"

namespace fc_runtime::detail {

[[nodiscard]] inline Instant clock_now() { return std::chrono::steady_clock::now(); }

/// Returns the local time of day, so that a restarted peer does not reuse its ids.
[[nodiscard]] std::uint32_t first_id_now();

}  // namespace fc_runtime::detail
