// What becomes of a report that a robot sends.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fc_runtime/call.hpp"
#include "fc_runtime/error.hpp"
#include "fc_runtime/result.hpp"

namespace fc_runtime {

/// Which connection of a robot; counted from 1, and never used again.
using ConnectionId = std::uint64_t;

/// How a report ended at one app.
enum class AckOutcomeKind {
  Acknowledged,  ///< The app has acknowledged it.
  Refused,       ///< The app has answered with another result than success.
  Invalid,       ///< The app has answered with something that is not an acknowledgement.
  TimedOut,      ///< No acknowledgement has come, however often it was repeated.
  Dropped,       ///< The app was so slow that the report gave way to newer ones.
  Closed,        ///< The connection ended first.
};

/// The name of an outcome, the same in every language.
[[nodiscard]] std::string_view name(AckOutcomeKind kind) noexcept;

/// How a report ended at one app.
struct AckOutcome {
  /// The app.
  ConnectionId connection = 0;
  /// How it ended.
  AckOutcomeKind kind = AckOutcomeKind::Closed;
  /// What the app said, for `Refused`.
  std::optional<Refusal> refusal;
};

/// What is done when a report has ended at every app that it was sent to.
using Pushed = std::function<void(std::vector<AckOutcome>)>;

/// Why a report or stream was not even queued.
enum class PushErrorKind {
  Invalid,       ///< It breaks one of its own constraints.
  Frame,         ///< It does not fit into a frame.
  NoConnection,  ///< There is no such connection any more; for a stream: no data connection.
  Ambiguous,     ///< Several apps share the address, and nothing tells whose data connection it is.
};

/// The name of a kind, the same in every language.
[[nodiscard]] std::string_view name(PushErrorKind kind) noexcept;

/// Why a report or stream was not even queued.
struct PushError {
  /// Why.
  PushErrorKind kind = PushErrorKind::NoConnection;
  /// What is wrong with it, for `Invalid`.
  std::optional<BodyError> body;
};

/// The error as one line.
[[nodiscard]] std::string to_string(const PushError& error);

/// What a report has come to at each app that it was sent to.
using Acknowledged = Result<std::vector<AckOutcome>, PushError>;

}  // namespace fc_runtime
