// A complete robot without sockets, threads and clocks. The caller feeds it events and the time,
// runs the handlers, and sends the bytes that it produces.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "fc_runtime/call.hpp"
#include "fc_runtime/client_core.hpp"
#include "fc_runtime/count.hpp"
#include "fc_runtime/ended_call.hpp"
#include "fc_runtime/frame.hpp"
#include "fc_runtime/pace.hpp"
#include "fc_runtime/push.hpp"
#include "fc_runtime/session.hpp"

namespace fc_runtime {

/// The counters of a robot since its start.
struct ServerCounters {
  /// Connections accepted at the command port.
  Count connections;
  /// Connections accepted at the data port.
  Count data_connections;
  /// Connections closed at once at the limit, in total or from their address.
  Count connections_refused;
  /// Connections closed at once because their address is not allowed.
  Count connections_forbidden;
  /// Connections closed because memory was short and they held most of it.
  Count connections_evicted;
  /// Silent connections closed to make room for another.
  Count connections_displaced;
  /// Connections closed by a timeout: of a header, of a stalled frame or reader, or of silence.
  Count connections_timed_out;
  /// Connections closed because the handshake of their channel failed or took too long.
  Count handshakes_failed;
  /// Times a connection was not read for a while because of useless frames.
  Count connections_paced;
  /// Requests with a response of success.
  Count calls_succeeded;
  /// Requests with the result for a protocol error.
  Count calls_protocol;
  /// Requests with the result for a timeout.
  Count calls_timed_out;
  /// Requests with the result for an invalid parameter.
  Count calls_invalid;
  /// Requests with the result for an expired message.
  Count calls_expired;
  /// Requests to which a handler gave another result.
  Count calls_refused;
  /// Requests refused because their address does not allow them; included in `calls_protocol`.
  Count calls_forbidden;
  /// Requests refused because the robot does not implement their command; included in
  /// `calls_protocol`.
  Count calls_not_implemented;
  /// Handlers that threw, or whose response could not be sent. Their requests are included in
  /// `calls_protocol`, or earlier in `calls_timed_out`.
  Count handlers_panicked;
  /// Handlers that were still running when their response was no longer awaited.
  Count handlers_abandoned;
  /// Requests refused because `abandoned_handlers` of these were running; included in
  /// `calls_protocol`.
  Count abandoned_reached;
  /// Times a connection was not read because it had the most requests in flight.
  Count in_flight_reached;
  /// Frames that could not be read.
  Count bad_frames;
  /// Reports sent for the first time, counted per app.
  Count reports_sent;
  /// Reports sent again.
  Count reports_repeated;
  /// Reports acknowledged with success.
  Count reports_acknowledged;
  /// Reports acknowledged with another result.
  Count reports_refused;
  /// Reports given up after the last repetition.
  Count reports_timed_out;
  /// Reports dropped because an app's queue was full.
  Count reports_dropped;
  /// Frames of streams received.
  Count stream_frames_in;
  /// Frames of streams sent.
  Count stream_frames_out;
  /// Frames of streams dropped for lack of a receiver.
  Count stream_frames_dropped;
  /// Bytes received.
  Count bytes_in;
  /// Bytes sent.
  Count bytes_out;
};

/// A received command, for the thread that runs its handler.
struct Request {
  /// The number of the handler, for `RobotCore::finish`.
  std::uint64_t handler = 0;
  /// The connection of the command.
  ConnectionId connection = 0;
  /// Code and message id.
  FrameId frame;
  /// The complete JSON text, including the envelope. Expires when the app stops waiting.
  std::weak_ptr<const std::string> text;
  /// Decides between start and drop. The first thread to set it wins: the worker starts the
  /// handler, the core drops it because the app stopped waiting. Do not call `finish` for a dropped
  /// handler.
  std::shared_ptr<std::atomic<bool>> settled;
  /// Set when the app stops waiting for the response.
  std::shared_ptr<const std::atomic<bool>> abandoned;
};

/// The settings of a robot, all set.
struct RobotSettings {
  Limits limits;                                    ///< Limits of frames, bodies and calls.
  std::chrono::milliseconds handler_timeout{2500};  ///< Longest time of a handler.
  std::chrono::milliseconds header_timeout{5000};   ///< Longest time of a header.
  std::chrono::milliseconds stall_timeout{30000};   ///< Longest time without progress.
  std::uint32_t least_rate = 1024;  ///< Lowest rate of a frame, in bytes per second.
  std::optional<std::chrono::milliseconds> idle_timeout;
  std::size_t queued_bytes = 0;
  std::size_t abandoned_handlers = 64;
  std::uint32_t first_id = 0;
  std::optional<Gzip> gzip;
  bool verify_digest = true;
  bool resync = false;
  /// Hands commands that the spec does not define to handlers. By default they are refused.
  bool hands_on_unknown = false;
};

namespace detail {

/// A report on its way to any number of apps.
struct Push {
  std::size_t open = 0;
  std::vector<AckOutcome> ended;
  Pushed done;
};

/// A report that is queued for one app, or in flight to it.
struct Queued {
  std::uint16_t code = 0;
  AckPolicy policy;
  std::shared_ptr<const std::string> body;
  std::shared_ptr<Push> push;
};

/// The state shared by the connections of a robot.
struct RobotShared {
  const Protocol* protocol = nullptr;
  RobotSettings settings;
  ServerCounters counters;
  std::function<void(Request)> begin;
  std::function<void(ConnectionId, FrameId, const FrameError&)> unsendable;
  CallHook on_call;
  /// `true` while memory is short: the robot reads nothing.
  bool is_pressed = false;
  /// Bytes of all requests in handlers, including those of closed connections.
  std::shared_ptr<std::atomic<std::size_t>> handled_bytes =
      std::make_shared<std::atomic<std::size_t>>(0);
  std::uint64_t next_handler = 1;
  /// Running handlers with their connections, without abandoned ones.
  std::unordered_map<std::uint64_t, ConnectionId> handlers;
  /// Number of started handlers whose app stopped waiting.
  std::size_t abandoned = 0;
  /// Ended pushes whose callback is still to be called.
  std::vector<std::shared_ptr<Push>> ended;
};

/// One app's connection.
class RobotPeer {
 public:
  RobotPeer(RobotShared& shared, ConnectionId id, std::vector<Effect> effects, Instant now);
  RobotPeer(const RobotPeer&) = delete;
  RobotPeer& operator=(const RobotPeer&) = delete;
  ~RobotPeer();

  void received(std::string_view bytes, Instant now);
  /// Notes that the app has closed its half.
  void deaf() { deaf_ = true; }
  /// Stops reading, and ends after the responses to the current commands.
  void drain();
  void kill() { killed_ = true; }
  void finish(std::uint64_t handler, const Handled& handled, Instant now);
  void push(Queued report, Instant now);
  void advance(Instant now);
  void set_unwritten(std::size_t bytes, Instant now);
  [[nodiscard]] std::optional<Instant> next_due() const;
  [[nodiscard]] bool wants_bytes() const;
  [[nodiscard]] bool is_done() const;
  [[nodiscard]] std::string take_out() { return std::exchange(out_, std::string()); }
  [[nodiscard]] bool is_heard() const { return heard_; }
  /// Bytes that the robot holds for this app.
  [[nodiscard]] std::size_t held() const {
    return decoder_.pending() + handled_bytes_ + queued_bytes_ + unsent();
  }
  /// Bytes of its requests in handlers.
  [[nodiscard]] std::size_t handled_bytes() const { return handled_bytes_; }

 private:
  struct AtWork {
    FrameId frame;
    Instant begun;
    Instant due;
    std::shared_ptr<std::atomic<bool>> abandoned;
    std::shared_ptr<std::atomic<bool>> settled;
    std::shared_ptr<const std::string> text;
  };

  void pump(Instant now);
  void arrive(const Frame& frame, Instant now);
  void begin(FrameId frame, std::string_view text, Instant now);
  void abandon(const AtWork& handler);
  void acknowledged(Queued report, std::string_view text);
  /// Responds with a refusal. A request without a handler began now.
  void answer(FrameId id, const Refusal& refusal, std::optional<Instant> begun = std::nullopt);
  void tell_end(FrameId id, std::string_view result, Instant begun) const;
  [[nodiscard]] bool append(FrameId id, std::string_view body);
  void rest(bool must_rest);
  void begin_to_write();
  void send_reports(Instant now);
  void end(Queued report, AckOutcomeKind kind, std::optional<Refusal> refusal = {});
  [[nodiscard]] std::size_t unsent() const { return out_.size() + unwritten_; }
  /// The time when the connection times out without progress.
  [[nodiscard]] std::optional<Instant> patience() const;

  /// Returns `true` if the app may call a command. `command` is null for an unknown one.
  [[nodiscard]] bool may_call(const OperationInfo* command) const;

  RobotShared* shared_;
  ConnectionId id_;
  /// The effects that the app may call; empty for all.
  std::vector<Effect> effects_;
  Decoder decoder_;
  Encoder encoder_;
  Session session_;
  std::map<std::uint64_t, AtWork> handlers_;
  /// Bytes of the requests in `handlers_`.
  std::size_t handled_bytes_ = 0;
  std::deque<Queued> queue_;
  std::unordered_map<Token, Queued> in_flight_;
  std::size_t queued_bytes_ = 0;
  Token next_token_ = 1;
  std::string out_;
  std::size_t unwritten_ = 0;
  /// The time of the latest event.
  Instant now_;
  Instant last_read_;
  Instant last_written_;
  Pace pace_;
  /// The arrival of the first bytes of the current frame.
  std::optional<Instant> begun_;
  bool heard_ = false;
  bool deaf_ = false;
  bool draining_ = false;
  bool killed_ = false;
};

}  // namespace detail

/// A robot. It is not thread-safe, except for its counters.
class RobotCore {
 public:
  /// `begin` is called with each command to handle. The protocol must outlive the robot.
  RobotCore(const Protocol& protocol, const RobotSettings& settings,
            std::function<void(Request)> begin);

  /// Adds a connection, or returns nothing if there are too many. The app may call commands with
  /// these effects; an empty list allows all.
  [[nodiscard]] std::optional<ConnectionId> connect(Instant now, std::vector<Effect> effects = {});
  /// Returns `true` while there is room for one more connection.
  [[nodiscard]] bool takes_connections() const;
  /// Takes received bytes of a connection.
  void received(ConnectionId id, std::string_view bytes, Instant now);
  /// Notes that the app has closed its half. Commands that have begun still get their responses.
  void ended(ConnectionId id);
  /// Removes a broken or closed connection.
  void closed(ConnectionId id);
  /// The counters, for the owner of the sockets, which counts the connections that it closes.
  [[nodiscard]] ServerCounters& counting() { return shared_->counters; }
  /// Sets the callback for the end of each call. It must not throw.
  void set_on_call(CallHook told) { shared_->on_call = std::move(told); }
  /// Sets the callback for responses that do not fit into a frame.
  void set_unsendable(std::function<void(ConnectionId, FrameId, const FrameError&)> told) {
    shared_->unsendable = std::move(told);
  }
  /// Sets the memory pressure. Under pressure, no connection takes bytes.
  void set_pressed(bool is_pressed) { shared_->is_pressed = is_pressed; }
  /// Bytes that the robot holds for a connection.
  [[nodiscard]] std::size_t held(ConnectionId id) const;
  /// Bytes of requests in abandoned handlers. No connection counts them.
  [[nodiscard]] std::size_t held_for_nobody() const;
  /// Returns `true` once a byte has arrived over a connection.
  [[nodiscard]] bool is_heard(ConnectionId id) const;
  /// Takes the outcome of a handler.
  void finish(std::uint64_t handler, const Handled& handled, Instant now);
  /// Sends a report with a complete body to one app, or to all. `settle` calls `done` when the
  /// report has ended at each app. Returns the number of apps that have it in their queue.
  std::size_t push(std::uint16_t code, std::string body, std::optional<ConnectionId> to,
                   Pushed done, Instant now);
  /// Starts a shutdown: reads no more, and responds to the current commands within `grace`.
  void shutdown(std::chrono::milliseconds grace, Instant now);
  /// Advances the time.
  void advance(Instant now);
  /// The latest time for the next call of `advance`.
  [[nodiscard]] std::optional<Instant> next_due() const;
  /// Calls the callbacks of ended reports.
  void settle();

  /// Returns `true` while a connection takes more bytes.
  [[nodiscard]] bool wants_bytes(ConnectionId id) const;
  /// Returns the bytes to send over a connection, and forgets them.
  [[nodiscard]] std::string take_out(ConnectionId id);
  /// Sets the number of bytes from `take_out` that are not written yet.
  void set_unwritten(ConnectionId id, std::size_t bytes, Instant now);
  /// Returns `true` if a connection must be closed.
  [[nodiscard]] bool is_done(ConnectionId id) const;
  /// All connections.
  [[nodiscard]] std::vector<ConnectionId> connections() const;
  /// Returns `true` after a shutdown.
  [[nodiscard]] bool is_over() const;
  [[nodiscard]] const ServerCounters& counters() const { return shared_->counters; }

 private:
  [[nodiscard]] detail::RobotPeer* find(ConnectionId id) const;

  std::unique_ptr<detail::RobotShared> shared_;
  std::map<ConnectionId, std::unique_ptr<detail::RobotPeer>> peers_;
  ConnectionId next_id_ = 1;
  /// The deadline of a shutdown.
  std::optional<Instant> over_by_;
  bool cut_off_ = false;
};

}  // namespace fc_runtime
