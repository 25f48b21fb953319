// The TCP server of a robot. Needs the target `fc::net`.
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
#include "fc_runtime/ended_call.hpp"
#include "fc_runtime/log.hpp"
#include "fc_runtime/operation.hpp"
#include "fc_runtime/push.hpp"
#include "fc_runtime/robot_core.hpp"
#include "fc_runtime/secure_channel.hpp"
#include "fc_runtime/typed.hpp"

namespace fc_runtime {

/// A network of allowed apps, and the commands that they may call.
struct Allowed {
  /// The network, such as "10.0.0.0/24", or an address.
  std::string network;
  /// The effects of allowed commands; empty for all.
  std::vector<Effect> effects;
};

/// The settings of a server. Unset ones are the protocol's defaults.
struct ServerConfig {
  /// Address to listen on.
  std::string address = "0.0.0.0";
  /// Port of commands and reports; 0 for any free port.
  std::optional<std::uint16_t> command_port;
  /// Port of streams; 0 for any free port.
  std::optional<std::uint16_t> data_port;
  /// Longest time of a handler, after which the app gets a timeout. The handler continues, since a
  /// thread cannot be stopped; `Context::is_abandoned` tells it.
  std::optional<std::chrono::milliseconds> handler_timeout;
  /// Most handlers that run at the same time. While all are busy, requests wait.
  std::size_t handler_threads = 16;
  /// Most handlers that continue without a waiting app. While there are as many, the server refuses
  /// commands. Has no effect above `handler_threads`.
  std::size_t abandoned_handlers = 64;
  /// Greatest age of a request that is still handled, by the time in its envelope.
  std::optional<std::chrono::milliseconds> max_age;
  /// Limits of everything that grows with the data from apps.
  std::optional<Limits> limits;
  /// Most bytes of reports that wait for one app or for its acknowledgement.
  std::optional<std::size_t> queued_bytes;
  /// Most connections from one address, at each port. Apps behind one router share an address.
  ///
  /// At this limit, or at `Limits::connections`, a new connection replaces a silent one: the oldest
  /// from the address with most connections. A silent connection has not sent a byte yet. A data
  /// connection keeps its place if a command connection of its address has sent something.
  std::size_t connections_per_address = 8;
  /// Most bytes that apps may make the server hold: received data, requests in handlers, and unsent
  /// responses, reports and streams. Above it, the server closes the connection that holds most.
  /// While handlers of closed connections hold too much, it reads no commands.
  std::size_t memory = std::size_t{256} << 20U;
  /// Networks of allowed apps; empty for no restriction. If several networks contain an address,
  /// the smallest applies. The server closes any other connection and refuses any other command as
  /// unknown, and counts both.
  std::vector<Allowed> allow;
  /// Message id of the first report on each connection. Unset: derived from the time of day.
  std::optional<std::uint32_t> first_id;
  /// Compresses responses and reports. Set it only for apps that accept compression.
  std::optional<Gzip> gzip;
  /// Verifies the digests of received frames.
  bool verify_digest = true;
  /// Searches for the next frame after invalid bytes, instead of closing the connection.
  bool resync = false;
  /// Longest time of a header, from its first byte to its last.
  std::chrono::milliseconds header_timeout{5000};
  /// Longest time without progress inside a frame, or while the app leaves sent bytes unread. Then
  /// the server closes the connection.
  std::chrono::milliseconds stall_timeout{30000};
  /// Lowest rate of an incoming frame, in bytes per second. A frame may take `stall_timeout`, plus
  /// one second for each `least_rate` bytes. 0 allows any rate.
  std::uint32_t least_rate = 1024;
  /// Longest silence of a connection between frames.
  std::optional<std::chrono::milliseconds> idle_timeout;
  /// Idle time before TCP keepalive probes the app. Unset: no probes.
  std::optional<std::chrono::milliseconds> keepalive = std::chrono::seconds(30);
  /// Creates the secure channel of each connection at both ports, such as `openssl_server(context)`.
  /// The handshake may take the `header_timeout`; the connection is silent in the meantime. Unset:
  /// plain TCP.
  ServerChannel channel;
  /// Receives the lines of the log. Without it, errors go to the standard error.
  Log log;
  /// Called with each exception of a handler, or an `UnsendableResponse` if its response cannot be
  /// sent. The exception may quote the request; the log has only its type. Runs in a thread of the
  /// server and must not block. An exception of this function is logged.
  std::function<void(const std::exception_ptr& error, const Context& context)> on_handler_error;
  /// Receives the end of each call, for metrics. Runs on the thread of all connections and must not
  /// block. An exception of this function is logged.
  CallHook on_call;
};

/// The reason why a server could not start.
struct BindError {
  /// The message of the operating system, or the invalid setting.
  std::string detail;
};

/// The error as one line.
[[nodiscard]] inline std::string to_string(const BindError& error) { return error.detail; }

/// A received frame of raw bytes.
struct AppStream {
  /// The data connection of the frame.
  ConnectionId connection = 0;
  /// The frame.
  StreamFrame frame;
};

/// Handles a request and returns the body of the response or a refusal. Several threads may call it
/// at once. `text` is the complete JSON text. The server sends the response, and counts and logs
/// exceptions.
using Service = std::function<Handled(const Context& context, std::string_view text)>;

namespace detail {
class ServerImpl;
}

/// The server of a robot. The destructor ends it at once; call `shutdown` first for a graceful end.
/// Any thread may use it, except those of its callbacks.
class Server {
 public:
  /// Listens on both ports and serves in its own threads. The protocol must outlive the server.
  [[nodiscard]] static Result<Server, BindError> bind(const Protocol& protocol, Service service,
                                                      const ServerConfig& config = {});
  Server(Server&&) noexcept;
  Server& operator=(Server&&) noexcept;
  ~Server();

  /// The address and ports that it listens on.
  [[nodiscard]] const std::string& address() const;
  [[nodiscard]] std::uint16_t command_port() const;
  [[nodiscard]] std::uint16_t data_port() const;

  /// Sends a report to one app, or to all, and waits until it has ended at each.
  template <class Message>
  Result<std::vector<AckOutcome>, PushError> push(
      const Message& report, std::optional<ConnectionId> to = std::nullopt) const {
    auto body = write_request(protocol(), report);
    if (!body) return PushError{PushErrorKind::Invalid, std::move(body).error().body};
    return push_body(Report<Message>::code, *std::move(body), to);
  }

  /// Sends a report without waiting. `done` runs on the thread of the server and must not block.
  /// Its exceptions are logged.
  template <class Message>
  Result<Done, PushError> push_async(const Message& report, Pushed done,
                                     std::optional<ConnectionId> to = std::nullopt) const {
    auto body = write_request(protocol(), report);
    if (!body) return PushError{PushErrorKind::Invalid, std::move(body).error().body};
    push_body_async(Report<Message>::code, *std::move(body), std::move(done), to);
    return Done{};
  }

  /// Sends a report with a complete body, including the envelope.
  [[nodiscard]] Result<std::vector<AckOutcome>, PushError> push_body(
      std::uint16_t code, std::string body, std::optional<ConnectionId> to = std::nullopt) const;
  void push_body_async(std::uint16_t code, std::string body, Pushed done,
                       std::optional<ConnectionId> to = std::nullopt) const;

  /// Sends a frame of raw bytes to the data connections of one app, or of all. `to` is the command
  /// or data connection of the app. Waits for space in their queues, and returns how many took the
  /// frame.
  ///
  /// A data connection belongs to a command connection if no other one was open at the same address
  /// in the meantime.
  [[nodiscard]] Result<std::size_t, PushError> send_stream(std::optional<ConnectionId> to,
                                                           std::uint16_t code, std::uint32_t id,
                                                           std::string data) const;
  /// Sends a message as the content of a frame.
  template <class Content>
  [[nodiscard]] Result<std::size_t, PushError> send_stream_json(std::optional<ConnectionId> to,
                                                                std::uint16_t code,
                                                                std::uint32_t id,
                                                                const Content& content) const {
    auto text = to_json(content);
    if (!text) return PushError{PushErrorKind::Invalid, std::move(text).error()};
    return send_stream(to, code, id, *std::move(text));
  }
  /// Returns the next frame that an app sent to the data port. Earlier frames are dropped until the
  /// first call.
  [[nodiscard]] std::optional<AppStream> next_stream(std::chrono::milliseconds wait) const;

  /// The currently connected apps.
  [[nodiscard]] std::vector<ConnectionId> connections() const;
  /// The counters of the server.
  [[nodiscard]] const ServerCounters& counters() const;
  [[nodiscard]] const Protocol& protocol() const;

  /// Shuts down gracefully. The server stops accepting connections and requests, and responds to
  /// the current requests. After `grace`, it closes the rest.
  void shutdown(std::chrono::milliseconds grace) const;

 private:
  explicit Server(std::shared_ptr<detail::ServerImpl> impl);

  std::shared_ptr<detail::ServerImpl> impl_;
};

}  // namespace fc_runtime
