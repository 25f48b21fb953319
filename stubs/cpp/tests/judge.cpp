// Reads frames, one in hex per line, and prints the verdict of this package as one JSON list per
// line.
//
// The judges of several languages are compared. `fc-reflect/tests/it/judges.rs` describes the
// lists.
#include <iostream>
#include <string>

#include "fc_runtime/frame.hpp"
#include "support/hex.hpp"
#include "support/transcode.hpp"

namespace {

using fc_runtime::Json;

std::string refused(std::string_view name, std::string_view path) {
  return R"(["refused",)" + Json::string(name).text() + "," + Json::string(path).text() + "]";
}

/// Transcodes the data of a frame as the type of its operation. Without a type, checks that it is
/// an object with any keys.
tests::Transcoded transcode(const fc_runtime::OperationInfo* operation, bool is_request,
                            std::string_view data) {
  if (operation != nullptr) return tests::transcode(*operation, is_request, data);
  const auto& protocol = fc::protocol();
  const auto& keys = is_request ? protocol.request_envelope : protocol.response_envelope;
  const auto envelope = fc_runtime::read_envelope(keys, data, protocol.defaults.limits.json());
  if (!envelope) return envelope.error();
  return std::string(data);
}

std::string verdict(const std::string& bytes) {
  const auto& protocol = fc::protocol();
  fc_runtime::Decoder decoder(protocol);
  decoder.push(bytes);
  const auto next = decoder.next();
  if (!next) return refused(next.error().name(), "");
  if (!*next) return refused(name(fc_runtime::FrameErrorKind::Truncated), "");
  const auto& [header, data] = **next;
  const auto& id = header.frame;
  const std::string place = (id.response ? "1," : "0,") + std::to_string(id.kind) + "," +
                            std::to_string(id.code) + "," + std::to_string(id.id) + ",";
  const std::string raw = R"(["bytes",)" + place + '"' + tests::hex(data) + "\"]";
  if (id.kind == protocol.stream_kind) return raw;
  const auto kind = id.kind == protocol.report_kind ? fc_runtime::OperationKind::Report
                                                    : fc_runtime::OperationKind::Command;
  const auto* operation = protocol.find(kind, id.code);
  const auto again = transcode(operation, !id.response, data);
  if (!again) return refused(again.error().name(), again.error().path);
  if (operation == nullptr) return raw;
  return R"(["message",)" + place + Json::string(*again).text() + "]";
}

}  // namespace

int main() {
  std::ios::sync_with_stdio(false);
  std::string line;
  while (std::getline(std::cin, line)) std::cout << verdict(tests::unhex(line)) << '\n';
  return 0;
}
