// The small protocol of the scripts: a command that reads, one that moves, and a report.
#pragma once

#include <algorithm>

#include "fc_runtime/protocol.hpp"
#include "support/fc.hpp"

namespace tests {

constexpr std::uint16_t kEcho = 100;
constexpr std::uint16_t kGo = 200;
constexpr std::uint16_t kMoved = 300;

/// Frames as in FC; 64 requests in flight.
inline fc_runtime::Protocol toy_protocol() {
  fc_runtime::Protocol protocol = fc_protocol();
  protocol.name = "toy";
  protocol.defaults.limits.in_flight = 64;
  protocol.defaults.limits.queued_reports = 16;
  protocol.defaults.ack = {std::chrono::milliseconds(2000), 3};
  return protocol;
}

/// The same with two bytes for message ids.
inline fc_runtime::Protocol toy_protocol_of_short_ids() {
  using fc_runtime::HeaderField;
  fc_runtime::Protocol protocol = toy_protocol();
  auto& fields = protocol.header.fields;
  const auto id = std::find_if(fields.begin(), fields.end(), [](const HeaderField& field) {
    return field.role == fc_runtime::HeaderRole::Id;
  });
  id->size -= 2;
  std::for_each(id + 1, fields.end(), [](HeaderField& field) { field.offset -= 2; });
  protocol.header.length -= 2;
  return protocol;
}

}  // namespace tests
