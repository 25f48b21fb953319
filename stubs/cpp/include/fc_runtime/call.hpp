// What one call can be told, and what can go wrong with it.
#pragma once

#include <chrono>
#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>

#include "fc_runtime/error.hpp"
#include "fc_runtime/protocol.hpp"

namespace fc_runtime {

/// What one call can be told.
struct CallOptions {
  /// How long to wait for the response; none for the connection's default.
  std::optional<std::chrono::milliseconds> timeout;
  /// Whether to send the call once more when the connection was lost before its answer came; none:
  /// only what has `Effect::Read`. `true` on anything else may do it twice.
  std::optional<bool> repeat;
};

/// The result code and text that a handler refuses with, or that a peer has refused with.
struct Refusal {
  /// Result code; not the one of success.
  std::int64_t code = 0;
  /// Text for people. Never rely on it.
  std::string text;

  Refusal() = default;
  Refusal(std::int64_t result, std::string words) : code(result), text(std::move(words)) {}
  // NOLINTNEXTLINE(google-explicit-constructor): `return protocol.results.invalid;` is what it is for
  Refusal(const ResultText& result) : code(result.code), text(result.text) {}
};

/// The refusal as one line.
[[nodiscard]] std::string to_string(const Refusal& refusal);

/// What a handler has come to: the text of a body with the keys of the response alone, or a refusal.
using Handled = Result<std::string, Refusal>;

/// Why a connection was lost, or why there is none.
enum class LossKind {
  NotYet,          ///< The first attempt to connect is not over.
  Closed,          ///< The robot has closed the connection after it had sent something.
  Unheard,         ///< The robot has closed the connection before it sent anything.
  Broken,          ///< The connection broke.
  Frame,           ///< What the robot sent cannot be told into frames.
  Stalled,         ///< A frame began and did not go on.
  Unread,          ///< The robot did not read what was sent to it.
  Unreachable,     ///< The network says no to a new connection.
  ConnectTimeout,  ///< A new connection was not made in time.
  Renewed,         ///< The command connection was made again, and the data connection with it.
  Here,            ///< This side has closed the connection.
  Ended,           ///< The client is gone.
  Settings,        ///< A setting of the client is out of range; `detail` names it.
};

/// Why a connection was lost, or why there is none.
struct Loss {
  /// The reason.
  LossKind kind = LossKind::NotYet;
  /// What is wrong with the bytes, for `LossKind::Frame`.
  std::optional<FrameErrorKind> frame;
  /// What the system says, where it says something.
  std::string detail;

  /// The reason's fixed name; for `LossKind::Frame` that of the error.
  [[nodiscard]] std::string_view name() const noexcept;
};

/// The loss as one line.
[[nodiscard]] std::string to_string(const Loss& loss);

/// How a call has failed.
enum class CallErrorKind {
  Refused,          ///< The peer answered with another result than success.
  Timeout,          ///< No response in time; the peer may have acted.
  NotConnected,     ///< No connection in time; not sent.
  Closed,           ///< The connection is over; not sent.
  Lost,             ///< The connection was lost before the response came; the peer may have acted.
  Busy,             ///< Too many calls are in flight; not sent.
  InvalidRequest,   ///< The request breaks one of its own constraints; not sent.
  InvalidResponse,  ///< The answer is not a response to this command.
  Frame,            ///< The request does not fit into a frame, or the answer came in a broken one.
};

/// The name of a kind, the same in every language.
[[nodiscard]] std::string_view name(CallErrorKind kind) noexcept;

/// A call that has failed.
struct CallError {
  /// How.
  CallErrorKind kind = CallErrorKind::Timeout;
  /// What the peer said, for `Refused`.
  std::optional<Refusal> refusal;
  /// Why there is no connection, for `NotConnected`, `Closed` and `Lost`.
  std::optional<Loss> loss;
  /// What is wrong with the body, for `InvalidRequest` and `InvalidResponse`.
  std::optional<BodyError> body;
  /// What is wrong with the frame, for `Frame`.
  std::optional<FrameError> frame;

  /// The kind's name.
  [[nodiscard]] std::string_view name() const noexcept { return fc_runtime::name(kind); }
  /// Whether the peer has certainly not seen the request.
  [[nodiscard]] bool was_not_sent() const noexcept;
};

/// The error as one line.
[[nodiscard]] std::string to_string(const CallError& error);
std::ostream& operator<<(std::ostream& out, const CallError& error);

/// Whether there is a connection.
enum class ConnectionStatus {
  Connected,   ///< There is one.
  Connecting,  ///< There is none, and one is being made.
  Closed,      ///< There will be none any more.
};

/// Whether there is a connection at a moment, and why not.
struct ConnectionState {
  /// Whether there is one.
  ConnectionStatus status = ConnectionStatus::Connecting;
  /// How many connections have been made so far, the present one included. An app that sees another
  /// number than before asks for the robot's state again: it may have restarted.
  std::uint64_t connects = 0;
  /// Why there is none.
  Loss why;
};

}  // namespace fc_runtime
