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
#include "fc_runtime/log.hpp"
#include "fc_runtime/operation.hpp"
#include "fc_runtime/reports.hpp"
#include "fc_runtime/typed.hpp"

namespace fc_runtime {

/// How to come back after a connection has been lost.
struct Backoff {
  /// Wait before the first attempt.
  std::chrono::milliseconds first{100};
  /// Longest wait; each one is twice the one before, and up to a quarter shorter by chance.
  std::chrono::milliseconds longest{10000};
  /// Failed attempts in a row before the connection is given up; none to go on for ever.
  std::optional<std::uint32_t> attempts;
};

/// What a client can be told beforehand. Whatever is not set is the protocol's default.
struct ClientConfig {
  /// Name or address of the robot.
  std::optional<std::string> host;
  /// Port of commands and reports.
  std::optional<std::uint16_t> command_port;
  /// Port of streams.
  std::optional<std::uint16_t> data_port;
  /// How long one attempt to connect may take.
  std::chrono::milliseconds connect_timeout{3000};
  /// How long a call waits for its response, reconnecting included.
  std::optional<std::chrono::milliseconds> call_timeout;
  /// How to reconnect, or none to give up with the first loss.
  std::optional<Backoff> reconnect = Backoff();
  /// After how much silence TCP asks whether the robot is still there, or none not to ask.
  std::optional<std::chrono::milliseconds> keepalive = std::chrono::seconds(30);
  /// How long a connection may make no progress, in the middle of a frame or while the robot has
  /// something to read, before it is given up and made again.
  std::chrono::milliseconds stall_timeout{10000};
  /// Bounds of everything that grows with what the robot sends.
  std::optional<Limits> limits;
  /// Most bytes of reports that wait for one receiver; as many as the longest body may have, unless
  /// set.
  std::optional<std::size_t> queued_bytes;
  /// Message id of the first call; the time of day unless set, so that an app that restarts does not
  /// use its ids again.
  std::optional<std::uint32_t> first_id;
  /// Compresses requests, for robots known to take it.
  std::optional<Gzip> gzip;
  /// Whether to verify the digests of what is received.
  bool verify_digest = true;
  /// Whether to search for the next frame where one should begin and does not, instead of closing the
  /// connection.
  bool resync = false;
  /// Receives the lines of the log. Without it, errors go to the standard error.
  Log log;
};

namespace detail {
class ConnectionImpl;
}

/// The states of a connection: first the one that it is in, then each that it comes to. Nothing is
/// queued: who asks late gets the latest.
class ConnectionStates {
 public:
  explicit ConnectionStates(std::shared_ptr<detail::ConnectionImpl> impl)
      : impl_(std::move(impl)) {}
  /// The next state; none if there is none in time.
  [[nodiscard]] std::optional<ConnectionState> next(std::chrono::milliseconds wait);

 private:
  std::shared_ptr<detail::ConnectionImpl> impl_;
  std::uint64_t seen_ = 0;
};

/// A call on its way, to be cancelled if nobody waits for it any more.
class PendingCall {
 public:
  explicit PendingCall(std::function<void()> cancel) : cancel_(std::move(cancel)) {}
  /// Gives the call's place back; its callback is not called unless it has been already. The robot
  /// acts all the same once the request is on its way.
  void cancel() const { cancel_(); }

 private:
  std::function<void()> cancel_;
};

/// A connection to a robot's command port. Cheap to copy; all copies share one connection, which is
/// closed with the last of them. May be used from any thread. A thread of its own does the work:
/// callbacks run there, and must not block or call what waits. An exception of a callback is logged.
class Connection {
 public:
  /// Connects. If the first attempt fails, says why. The protocol has to outlive the connection.
  [[nodiscard]] static Result<Connection, Loss> connect(const Protocol& protocol,
                                                        const ClientConfig& config = {});
  /// Gives a connection that is made in the background; calls made meanwhile wait.
  [[nodiscard]] static Connection connect_lazy(const Protocol& protocol,
                                               const ClientConfig& config = {});

  /// Calls a command and waits for the response.
  template <class Request>
  Result<typename Command<Request>::Response, CallError> call(
      const Request& request, const CallOptions& options = {}) const {
    using Response = typename Command<Request>::Response;
    auto body = write_request(protocol(), request);
    if (!body) return std::move(body).error();
    auto answer = call_body(Command<Request>::code, *std::move(body),
                            usual(options, Command<Request>::effect));
    if (!answer) return std::move(answer).error();
    return read_response<Response>(protocol(), *answer, limits().json());
  }

  /// Calls a command; the response is given to `done`, on the thread of the connection.
  template <class Request, class Done>
  PendingCall call_async(const Request& request, Done done, const CallOptions& options = {}) const {
    using Response = typename Command<Request>::Response;
    auto body = write_request(protocol(), request);
    if (!body) {
      done(Result<Response, CallError>(std::move(body).error()));
      return PendingCall([] {});
    }
    const Protocol* protocol_of = &protocol();
    const Allowance allowance = limits().json();
    auto read = [done = std::move(done), protocol_of, allowance](Answer answer) mutable {
      if (!answer) {
        done(Result<Response, CallError>(std::move(answer).error()));
      } else {
        done(read_response<Response>(*protocol_of, *answer, allowance));
      }
    };
    return call_body_async(Command<Request>::code, *std::move(body), std::move(read),
                           usual(options, Command<Request>::effect));
  }

  /// Calls a code with a whole body, envelope included, and gives that of the answer.
  [[nodiscard]] Answer call_body(std::uint16_t code, std::string body,
                                 const CallOptions& options = {}) const;
  /// The same without waiting.
  PendingCall call_body_async(std::uint16_t code, std::string body, Completion done,
                              const CallOptions& options = {}) const;

  /// The reports from now on, of one code or of any.
  [[nodiscard]] std::shared_ptr<ReportQueue> reports(
      std::optional<std::uint16_t> code = std::nullopt) const;
  /// A connection to the data port.
  [[nodiscard]] DataConnection data() const;
  /// Whether there is a connection.
  [[nodiscard]] ConnectionState state() const;
  /// Its states.
  [[nodiscard]] ConnectionStates states() const;
  /// Ends the connection for good.
  void close() const;
  /// What it has seen.
  [[nodiscard]] const ClientCounters& counters() const;
  /// Counts a report that came in another order than the protocol says.
  void note_out_of_order() const;
  /// How many calls have not ended.
  [[nodiscard]] std::size_t in_flight() const;
  [[nodiscard]] const Protocol& protocol() const;
  [[nodiscard]] const Limits& limits() const;

 private:
  friend class DataConnection;
  class Handle;
  explicit Connection(std::shared_ptr<Handle> handle);
  static CallOptions usual(CallOptions options, Effect effect) {
    if (!options.repeat) options.repeat = effect == Effect::Read;
    return options;
  }

  std::shared_ptr<Handle> handle_;
};

}  // namespace fc_runtime
