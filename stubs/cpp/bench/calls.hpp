// Calls over loopback. Each peer has a server process and a caller process, and the peers take
// turns.
#pragma once

#include <nlohmann/json.hpp>

#include "measure.hpp"
#include "peer.hpp"

namespace bench {

/// All compared peers.
extern const Peer* const peers[3];

/// Returns the cost of calls for each peer and number in flight, in the format of the report.
[[nodiscard]] nlohmann::ordered_json calls(Effort effort);

}  // namespace bench
