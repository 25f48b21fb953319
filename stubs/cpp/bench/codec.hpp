// Frames to typed messages and back, beside nothing but the JSON and the MD5 of the same bytes.
#pragma once

#include <nlohmann/json.hpp>

#include "measure.hpp"

namespace bench {

/// What each message costs, in microseconds, as the report has it.
[[nodiscard]] nlohmann::ordered_json codec(Effort effort);

}  // namespace bench
