// Outcomes and errors of reports that a robot sends.
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

/// The id of a connection to a robot. Ids count from 1 and are never reused.
using ConnectionId = std::uint64_t;

/// The outcome of a report at one app.
enum class AckOutcomeKind {
  Acknowledged,  ///< The app acknowledged the report.
  Refused,       ///< The app responded with a result other than success.
  Invalid,       ///< The response of the app is not an acknowledgement.
  TimedOut,      ///< No acknowledgement arrived, in spite of all retries.
  Dropped,       ///< The report was dropped for newer ones, because the app was slow.
  Closed,        ///< The connection ended first.
};

/// The name of an outcome, the same in every language.
[[nodiscard]] std::string_view name(AckOutcomeKind kind) noexcept;

/// The outcome of a report at one app.
struct AckOutcome {
  /// The connection of the app.
  ConnectionId connection = 0;
  /// The kind of the outcome.
  AckOutcomeKind kind = AckOutcomeKind::Closed;
  /// The result of the app, for `Refused`.
  std::optional<Refusal> refusal;
};

/// Called when a report has ended at every app.
using Pushed = std::function<void(std::vector<AckOutcome>)>;

/// The reason why a report or stream was not queued.
enum class PushErrorKind {
  Invalid,       ///< The report or content breaks one of its constraints.
  Frame,         ///< The data does not fit into a frame.
  NoConnection,  ///< The connection is closed; for a stream: no data connection is open.
  Ambiguous,     ///< Several apps share the address: the owner of the data connection is unknown.
};

/// The name of a kind, the same in every language.
[[nodiscard]] std::string_view name(PushErrorKind kind) noexcept;

/// The reason why a report or stream was not queued.
struct PushError {
  /// The kind of the error.
  PushErrorKind kind = PushErrorKind::NoConnection;
  /// The error of the body, for `Invalid`.
  std::optional<BodyError> body;
};

/// The error as one line.
[[nodiscard]] std::string to_string(const PushError& error);

/// The outcome of a report at each app, or the error.
using Acknowledged = Result<std::vector<AckOutcome>, PushError>;

}  // namespace fc_runtime
