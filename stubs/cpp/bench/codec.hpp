// Frames to typed messages and back, compared with the JSON and MD5 of the same bytes.
#pragma once

#include <nlohmann/json.hpp>

#include "measure.hpp"

namespace bench {

/// Returns the cost of each message in microseconds, in the format of the report.
[[nodiscard]] nlohmann::ordered_json codec(Effort effort);

}  // namespace bench
