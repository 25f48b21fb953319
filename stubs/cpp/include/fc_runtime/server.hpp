// A robot's server over TCP. Needs the target `fc::net`.
#pragma once

#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fc_runtime/data.hpp"
#include "fc_runtime/log.hpp"
#include "fc_runtime/operation.hpp"
#include "fc_runtime/push.hpp"
#include "fc_runtime/robot_core.hpp"
#include "fc_runtime/typed.hpp"

namespace fc_runtime {

/// A network that apps may connect from, and what they may call there.
struct Allowed {
  /// The network, such as "10.0.0.0/24", or an address.
  std::string network;
  /// The effects of the commands that are handled from there; none for all of them.
  std::vector<Effect> effects;
};

/// The settings of a server. Unset ones are the protocol's defaults.
struct ServerConfig {
  /// Address to listen at.
  std::string address = "0.0.0.0";
  /// Port of commands and reports; 0 for any that is free.
  std::optional<std::uint16_t> command_port;
  /// Port of streams; 0 for any that is free.
  std::optional<std::uint16_t> data_port;
  /// Longest time of a handler. Then the app gets the result of a timeout. The handler
  /// runs on, since a function cannot be stopped; `Context::is_abandoned` tells it.
  std::optional<std::chrono::milliseconds> handler_timeout;
  /// Most handlers that run at the same time. While all are busy, requests wait.
  std::size_t handler_threads = 16;
  /// Most handlers that continue without a waiting app. While there are as many, the server refuses
  /// commands. Has no effect above `handler_threads`.
  std::size_t abandoned_handlers = 64;
  /// Oldest request that is still served, by the time in its envelope.
  std::optional<std::chrono::milliseconds> max_age;
  /// Bounds of everything that grows with what apps send.
  std::optional<Limits> limits;
  /// Most bytes of reports that wait for one app or for its acknowledgement.
  std::optional<std::size_t> queued_bytes;
  /// Most connections from one address, at each port. Apps behind one router share an address.
  ///
  /// At this limit, or at `Limits::connections`, a new connection takes the place of a silent one: the
  /// oldest from the address with most connections. No byte has come over a silent connection yet. A
  /// data connection keeps its place if a command connection of its address has sent something.
  std::size_t connections_per_address = 8;
  /// Most bytes that apps may make the server hold: received data, requests in handlers, and unsent
  /// responses, reports and streams. Above it, the server closes the connection that holds most. While
  /// handlers of closed connections hold too much, it reads no commands.
  std::size_t memory = std::size_t{256} << 20U;
  /// Who may connect, and who may call what; everyone and all if nothing is here. Of several networks
  /// that have an address, the smallest holds. Any other connection is closed at once, and any other
  /// command refused as unknown; both are counted.
  std::vector<Allowed> allow;
  /// Message id of the first report on each connection; the time of day unless set.
  std::optional<std::uint32_t> first_id;
  /// Compresses responses and reports, for apps known to take it.
  std::optional<Gzip> gzip;
  /// Whether to verify the digests of what is received.
  bool verify_digest = true;
  /// Whether to search for the next frame where one should begin and does not.
  bool resync = false;
  /// Longest time of a header, from its first byte to its last.
  std::chrono::milliseconds header_timeout{5000};
  /// How long a connection may make no progress, in the middle of a frame or while it has something
  /// to read, before it is closed.
  std::chrono::milliseconds stall_timeout{30000};
  /// Lowest rate of a frame that arrives, in bytes per second. Its time is `stall_timeout`, plus a
  /// second for each so many bytes. 0 allows any rate.
  std::uint32_t least_rate = 1024;
  /// Longest silence of a connection in between frames.
  std::optional<std::chrono::milliseconds> idle_timeout;
  /// After how much silence TCP asks whether the app is still there, or none not to ask.
  std::optional<std::chrono::milliseconds> keepalive = std::chrono::seconds(30);
  /// Receives the lines of the log. Without it, errors go to the standard error.
  Log log;
  /// Is called with each exception of a handler, and with an `UnsendableResponse` if its response
  /// cannot be sent. The exception may quote the request; the log has only its type. Runs in a thread of
  /// the server, and must not block. An exception of this function is logged.
  std::function<void(const std::exception_ptr& error, const Context& context)> on_handler_error;
};

/// Why a server could not be started.
struct BindError {
  /// What the system says.
  std::string detail;
};

/// The error as one line.
[[nodiscard]] inline std::string to_string(const BindError& error) { return error.detail; }

/// A frame of raw bytes that an app has sent.
struct AppStream {
  /// The data connection that brought it.
  ConnectionId connection = 0;
  /// The frame.
  StreamFrame frame;
};

/// Handles requests, on any of several threads at once: the context, the code and the whole text, and
/// gives the body of the response or a refusal. The server answers, counts and logs an exception.
using Service = std::function<Handled(const Context& context, std::string_view text)>;

namespace detail {
class ServerImpl;
}

/// A robot's server. Ends when it goes out of scope, at once; `shutdown` before that ends it
/// gracefully. May be used from any thread but those of its own callbacks.
class Server {
 public:
  /// Listens at both ports and serves in threads of its own. The protocol has to outlive it.
  [[nodiscard]] static Result<Server, BindError> bind(const Protocol& protocol, Service service,
                                                      const ServerConfig& config = {});
  Server(Server&&) noexcept;
  Server& operator=(Server&&) noexcept;
  ~Server();

  /// Where it listens.
  [[nodiscard]] const std::string& address() const;
  [[nodiscard]] std::uint16_t command_port() const;
  [[nodiscard]] std::uint16_t data_port() const;

  /// Sends a report to every app connected or to one, and waits until it has ended at each.
  template <class Message>
  Result<std::vector<AckOutcome>, PushError> push(
      const Message& report, std::optional<ConnectionId> to = std::nullopt) const {
    auto body = write_request(protocol(), report);
    if (!body) return PushError{PushErrorKind::Invalid, std::move(body).error().body};
    return push_body(Report<Message>::code, *std::move(body), to);
  }

  /// The same without waiting; `done` is called on the server's thread, and must not block. An
  /// exception of it is logged.
  template <class Message>
  Result<Done, PushError> push_async(const Message& report, Pushed done,
                                     std::optional<ConnectionId> to = std::nullopt) const {
    auto body = write_request(protocol(), report);
    if (!body) return PushError{PushErrorKind::Invalid, std::move(body).error().body};
    push_body_async(Report<Message>::code, *std::move(body), std::move(done), to);
    return Done{};
  }

  /// Sends a report with a whole body, envelope included.
  [[nodiscard]] Result<std::vector<AckOutcome>, PushError> push_body(
      std::uint16_t code, std::string body, std::optional<ConnectionId> to = std::nullopt) const;
  void push_body_async(std::uint16_t code, std::string body, Pushed done,
                       std::optional<ConnectionId> to = std::nullopt) const;

  /// Sends a frame of raw bytes to the data connections of one app, named by its command or data
  /// connection, or of all. A data connection is that of an app if the app's command connection is
  /// the only one that has been open at the same address meanwhile. Waits for room in their queues,
  /// and says how many took it.
  [[nodiscard]] Result<std::size_t, PushError> send_stream(std::optional<ConnectionId> to,
                                                           std::uint16_t code, std::uint32_t id,
                                                           std::string data) const;
  /// The next frame that an app has sent to the data port. Before this is first asked they are
  /// dropped.
  [[nodiscard]] std::optional<AppStream> next_stream(std::chrono::milliseconds wait) const;

  /// The apps connected at this moment.
  [[nodiscard]] std::vector<ConnectionId> connections() const;
  /// What it has seen.
  [[nodiscard]] const RobotCounters& counters() const;
  [[nodiscard]] const Protocol& protocol() const;

  /// Ends the server: accepts nothing more, reads no more requests, answers those that are being
  /// handled, and cuts off after `grace` what is not done by then.
  void shutdown(std::chrono::milliseconds grace) const;

 private:
  explicit Server(std::shared_ptr<detail::ServerImpl> impl);

  std::shared_ptr<detail::ServerImpl> impl_;
};

}  // namespace fc_runtime
