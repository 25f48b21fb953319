// Bodies read as the typed messages of the spec, including the envelope, and written again.
#pragma once

#include <string>
#include <string_view>

#include "fc/protocol.hpp"
#include "fc_runtime/envelope.hpp"

namespace tests {

using Transcoded = fc_runtime::Result<std::string, fc_runtime::BodyError>;

/// Reads a body as its message and writes it again. Returns the text itself if it has no message.
inline Transcoded transcode(const fc_runtime::OperationInfo& operation, bool is_request,
                            std::string_view text) {
  const auto& type = is_request ? operation.request : operation.response;
  if (!type) return std::string(text);
  const auto allowance = fc::protocol().defaults.limits.json();
  if (operation.kind == fc_runtime::OperationKind::Stream) {
    return type->transcode(text, allowance, nullptr);
  }
  const auto& keys =
      is_request ? fc::protocol().request_envelope : fc::protocol().response_envelope;
  fc_runtime::EnvelopeReader beside(keys);
  auto again = type->transcode(text, allowance, &beside);
  if (!again) {
    if (auto error = fc_runtime::check_enveloped(*type, keys, text, allowance)) {
      return *std::move(error);
    }
    return again;
  }
  if (auto missing = beside.finish()) return *std::move(missing);
  // The envelope comes first, followed by the keys of the message.
  std::string whole = fc_runtime::write_envelope(keys, beside.envelope());
  const std::string own = again->substr(1);
  if (own == "}") return whole;
  whole.back() = ',';
  if (whole == "{,") whole = "{";
  return whole + own;
}

}  // namespace tests
