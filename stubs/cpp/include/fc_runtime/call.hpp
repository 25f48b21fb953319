// Options of a call, and the errors that it can end with.
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

/// The options of one call.
struct CallOptions {
  /// Longest wait for the response. Unset: the default of the connection.
  std::optional<std::chrono::milliseconds> timeout;
  /// Sends the call once more if the connection is lost before its response arrives. Unset: only
  /// calls with `Effect::Read` are repeated. With `true`, the robot may execute any other call
  /// twice.
  std::optional<bool> repeat;
};

/// The result code and text of a refusal, from a handler or a peer.
struct Refusal {
  /// Result code; not the one of success.
  std::int64_t code = 0;
  /// Text for people. Never rely on it.
  std::string text;
  /// `true` if the robot does not implement the command. Not sent, only counted.
  bool is_not_implemented = false;

  Refusal() = default;
  Refusal(std::int64_t result, std::string words) : code(result), text(std::move(words)) {}
  // NOLINTNEXTLINE(google-explicit-constructor): `return protocol.results.invalid;` is what it is for
  Refusal(const ResultText& result) : code(result.code), text(result.text) {}
};

/// The refusal as one line.
[[nodiscard]] std::string to_string(const Refusal& refusal);

/// The outcome of a handler: the body with the keys of the response alone, or a refusal.
using Handled = Result<std::string, Refusal>;

/// The reason why a connection was lost or is not available.
enum class LossKind {
  NotYet,          ///< The first attempt to connect is not over.
  Closed,          ///< The robot has closed the connection after it had sent something.
  Unheard,         ///< The robot has closed the connection before it sent anything.
  Broken,          ///< The connection broke.
  Frame,           ///< The bytes from the robot are not a valid sequence of frames.
  Stalled,         ///< A frame began and did not go on.
  Unread,          ///< The robot did not read what was sent to it.
  Unreachable,     ///< The network refused a new connection.
  ConnectTimeout,  ///< A new connection was not made in time.
  Renewed,         ///< The command connection was made again, and the data connection with it.
  Here,            ///< This side has closed the connection.
  Ended,           ///< The client is gone.
  Settings,        ///< A setting of the client is out of range; `detail` names it.
};

/// The reason why a connection was lost or is not available.
struct Loss {
  /// The reason.
  LossKind kind = LossKind::NotYet;
  /// The error in the received bytes, for `LossKind::Frame`.
  std::optional<FrameErrorKind> frame;
  /// The message of the operating system; empty if it gave none.
  std::string detail;

  /// The fixed name of the reason. For `LossKind::Frame`, the name of the frame error.
  [[nodiscard]] std::string_view name() const noexcept;
};

/// The loss as one line.
[[nodiscard]] std::string to_string(const Loss& loss);

/// The kind of a failed call.
enum class CallErrorKind {
  Refused,          ///< The peer sent a result other than success.
  Timeout,          ///< No response in time; the peer may have acted.
  NotConnected,     ///< No connection in time; not sent.
  Closed,           ///< The connection is over; not sent.
  Lost,             ///< The connection was lost before the response came; the peer may have acted.
  Busy,             ///< Too many calls are in flight; not sent.
  InvalidRequest,   ///< The request breaks one of its own constraints; not sent.
  InvalidResponse,  ///< The body is not a response to this command.
  Frame,            ///< The request does not fit into a frame, or the response frame is broken.
};

/// The name of a kind, the same in every language.
[[nodiscard]] std::string_view name(CallErrorKind kind) noexcept;

/// The error of a failed call.
struct CallError {
  /// The kind of the error.
  CallErrorKind kind = CallErrorKind::Timeout;
  /// The result of the peer, for `Refused`.
  std::optional<Refusal> refusal;
  /// The reason of the loss, for `NotConnected`, `Closed` and `Lost`.
  std::optional<Loss> loss;
  /// The error of the body, for `InvalidRequest` and `InvalidResponse`.
  std::optional<BodyError> body;
  /// The error of the frame, for `Frame`.
  std::optional<FrameError> frame;

  /// The kind's name.
  [[nodiscard]] std::string_view name() const noexcept { return fc_runtime::name(kind); }
  /// Returns `true` if the peer has certainly not received the request.
  [[nodiscard]] bool was_not_sent() const noexcept;
};

/// The error as one line.
[[nodiscard]] std::string to_string(const CallError& error);
std::ostream& operator<<(std::ostream& out, const CallError& error);

/// The status of a connection.
enum class ConnectionStatus {
  Connected,   ///< The connection is up.
  Connecting,  ///< The client is connecting.
  Closed,      ///< The connection is closed for good.
};

/// A snapshot of a connection: its status, and the reason while it is down.
struct ConnectionState {
  /// The status at this moment.
  ConnectionStatus status = ConnectionStatus::Connecting;
  /// Number of connections made so far, including the current one. If it changes, the robot may
  /// have restarted: query its state again.
  std::uint64_t connects = 0;
  /// The reason why the connection is down.
  Loss why;
};

}  // namespace fc_runtime
