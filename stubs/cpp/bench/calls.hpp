// Calls over loopback: each peer has a process that serves and one that calls, and the peers take turns.
#pragma once

#include <nlohmann/json.hpp>

#include "measure.hpp"
#include "peer.hpp"

namespace bench {

/// All that are compared.
extern const Peer* const peers[3];

/// What calls cost with each number in flight, and with each peer, as the report has it.
[[nodiscard]] nlohmann::ordered_json calls(Effort effort);

}  // namespace bench
