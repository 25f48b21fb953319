// An app's connection to a robot over TCP. Needs the target `fc::net`.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "fc_runtime/client_core.hpp"
#include "fc_runtime/data.hpp"
#include "fc_runtime/ended_call.hpp"
#include "fc_runtime/log.hpp"
#include "fc_runtime/operation.hpp"
#include "fc_runtime/reports.hpp"
#include "fc_runtime/secure_channel.hpp"
#include "fc_runtime/typed.hpp"

namespace fc_runtime {

/// The schedule of reconnection attempts after a loss.
struct Backoff {
  /// Wait before the first attempt.
  std::chrono::milliseconds first{100};
  /// Longest wait. Each wait is twice the previous one, randomly shortened by up to a quarter.
  std::chrono::milliseconds longest{10000};
  /// Consecutive failed attempts before the client gives up. Unset: no limit.
  std::optional<std::uint32_t> attempts;
};

/// The settings of a client. Unset ones are the defaults of the protocol.
struct ClientConfig {
  /// Name or address of the robot.
  std::optional<std::string> host;
  /// Port of commands and reports.
  std::optional<std::uint16_t> command_port;
  /// Port of streams.
  std::optional<std::uint16_t> data_port;
  /// Longest time of one connection attempt.
  std::chrono::milliseconds connect_timeout{3000};
  /// Longest wait of a call for its response, including reconnection.
  std::optional<std::chrono::milliseconds> call_timeout;
  /// The reconnection schedule. Unset: the client gives up after the first loss.
  std::optional<Backoff> reconnect = Backoff();
  /// Idle time before TCP keepalive probes the robot. Unset: no probes.
  std::optional<std::chrono::milliseconds> keepalive = std::chrono::seconds(30);
  /// Longest time without progress inside a frame, or while the robot leaves sent bytes unread.
  /// Then the client reconnects.
  std::chrono::milliseconds stall_timeout{10000};
  /// Limits of everything that grows with the data from the robot.
  std::optional<Limits> limits;
  /// Most bytes of reports that wait for one receiver. Unset: the length of the longest body.
  std::optional<std::size_t> queued_bytes;
  /// Message id of the first call. Unset: derived from the time of day, so that a restarted app
  /// does not reuse its ids.
  std::optional<std::uint32_t> first_id;
  /// Compresses requests. Set it only for robots that accept compression.
  std::optional<Gzip> gzip;
  /// Verifies the digests of received frames.
  bool verify_digest = true;
  /// Searches for the next frame after invalid bytes, instead of closing the connection.
  bool resync = false;
  /// Creates the secure channel of each connection at both ports, such as `openssl_client(context)`.
  /// Its handshake is a part of the `connect_timeout`. Unset: plain TCP.
  ClientChannel channel;
  /// Receives the lines of the log. Without it, errors go to the standard error.
  Log log;
  /// Receives the end of each call, for metrics. Runs on the thread that waits for the call, or on
  /// that of the connection, and must not block. An exception of this function is logged.
  CallHook on_call;
};

namespace detail {
class ConnectionImpl;
}

/// A call in flight that can be cancelled.
class PendingCall {
 public:
  explicit PendingCall(std::function<void()> cancel) : cancel_(std::move(cancel)) {}
  /// Frees the slot of the call and drops its callback, unless it was called already. A request
  /// that was sent still takes effect on the robot.
  void cancel() const { cancel_(); }

 private:
  std::function<void()> cancel_;
};

/// A connection to the command port of a robot. Copies are cheap and share one connection, which
/// closes with the last copy. Any thread may use it.
///
/// An internal thread does the work and runs the callbacks. They must not block or make blocking
/// calls. An exception of a callback is logged.
class Connection {
 public:
  /// Connects and waits. Returns the reason if the first attempt fails. The protocol must outlive
  /// the connection.
  [[nodiscard]] static Result<Connection, Loss> connect(const Protocol& protocol,
                                                        const ClientConfig& config = {});
  /// Returns at once and connects in the background. Calls made in the meantime wait.
  [[nodiscard]] static Connection connect_lazy(const Protocol& protocol,
                                               const ClientConfig& config = {});

  /// Calls a command and waits for the response.
  template <class Request>
  Result<typename Command<Request>::Response, CallError> call(
      const Request& request, const CallOptions& options = {}) const {
    const auto end = end_of(Command<Request>::code);
    auto response = answered(request, options);
    if (end) end->tell(response ? "success" : response.error().name());
    return response;
  }

  /// Calls a command without waiting. `done` gets the response, on the thread of the connection.
  template <class Request, class Done>
  PendingCall call_async(const Request& request, Done done, const CallOptions& options = {}) const {
    using Answered = Result<typename Command<Request>::Response, CallError>;
    auto finish = [end = end_of(Command<Request>::code),
                   done = std::move(done)](Answered response) mutable {
      if (end) end->tell(response ? "success" : response.error().name());
      done(std::move(response));
    };
    auto body = write_request(protocol(), request);
    if (!body) {
      finish(std::move(body).error());
      return PendingCall([] {});
    }
    const Protocol* protocol_of = &protocol();
    const Allowance allowance = limits().json();
    auto read = [finish = std::move(finish), protocol_of, allowance](Answer answer) mutable {
      using Response = typename Command<Request>::Response;
      if (!answer) {
        finish(std::move(answer).error());
      } else {
        finish(read_response<Response>(*protocol_of, *answer, allowance));
      }
    };
    return send_body_async(Command<Request>::code, *std::move(body), std::move(read),
                           usual(options, Command<Request>::effect));
  }

  /// Calls a code with a complete body, including the envelope, and returns the body of the
  /// response.
  [[nodiscard]] Answer call_body(std::uint16_t code, std::string body,
                                 const CallOptions& options = {}) const;
  /// Calls a code with a complete body, without waiting.
  PendingCall call_body_async(std::uint16_t code, std::string body, Completion done,
                              const CallOptions& options = {}) const;

  /// Returns a queue of the reports from now on, with one code or any.
  [[nodiscard]] std::shared_ptr<ReportQueue> reports(
      std::optional<std::uint16_t> code = std::nullopt) const;
  /// Returns a connection to the data port.
  [[nodiscard]] DataConnection data() const;
  /// Returns the current state.
  [[nodiscard]] ConnectionState state() const;
  /// Returns an iterator over the states.
  [[nodiscard]] ConnectionStates states() const;
  /// Waits for the end of the connection. Returns the cause, or no value if it does not end in time.
  [[nodiscard]] std::optional<Loss> closed(std::chrono::milliseconds wait) const;
  /// Closes the connection for good.
  void close() const;
  /// The counters of the connection.
  [[nodiscard]] const ClientCounters& counters() const;
  /// Counts a report that violates the order in the protocol.
  void note_out_of_order() const;
  /// Number of calls in flight.
  [[nodiscard]] std::size_t in_flight() const;
  [[nodiscard]] const Protocol& protocol() const;
  [[nodiscard]] const Limits& limits() const;

 private:
  friend class DataConnection;
  class Handle;
  explicit Connection(std::shared_ptr<Handle> handle);
  template <class Request>
  Result<typename Command<Request>::Response, CallError> answered(
      const Request& request, const CallOptions& options) const {
    using Response = typename Command<Request>::Response;
    auto body = write_request(protocol(), request);
    if (!body) return std::move(body).error();
    auto answer = send_body(Command<Request>::code, *std::move(body),
                            usual(options, Command<Request>::effect));
    if (!answer) return std::move(answer).error();
    return read_response<Response>(protocol(), *answer, limits().json());
  }
  [[nodiscard]] Answer send_body(std::uint16_t code, std::string body,
                                 const CallOptions& options) const;
  PendingCall send_body_async(std::uint16_t code, std::string body, Completion done,
                              const CallOptions& options) const;
  /// Begins a call for `ClientConfig::on_call`; null without that function.
  [[nodiscard]] std::shared_ptr<detail::CallEnd> end_of(std::uint16_t code) const;
  static CallOptions usual(CallOptions options, Effect effect) {
    if (!options.repeat) options.repeat = effect == Effect::Read;
    return options;
  }

  std::shared_ptr<Handle> handle_;
};

}  // namespace fc_runtime
