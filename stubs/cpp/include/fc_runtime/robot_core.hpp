// A whole robot without sockets, threads and clocks: whoever has these tells it what happened and
// what time it is, runs its handlers, and writes what it has to send.
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
#include "fc_runtime/frame.hpp"
#include "fc_runtime/push.hpp"
#include "fc_runtime/session.hpp"

namespace fc_runtime {

/// What a robot has seen since it was started.
struct RobotCounters {
  Count connections;            ///< Connections taken.
  Count connections_refused;    ///< Connections closed at once because there were too many.
  Count connections_forbidden;  ///< Connections closed at once because of their address.
  Count connections_displaced;  ///< Silent connections closed to make room for another.
  Count connections_evicted;    ///< Connections closed because memory was short and they held most.
  Count connections_timed_out;  ///< Connections closed because they made no progress.
  Count bytes_in;               ///< Bytes received.
  Count bytes_out;              ///< Bytes handed to connections to be sent.
  Count calls;                  ///< Commands that reached a handler.
  Count calls_forbidden;        ///< Commands refused because of the address that they came from.
  Count calls_timed_out;        ///< Commands whose handler took too long.
  Count calls_refused;          ///< Commands answered with another result than success.
  Count handlers_panicked;      ///< Handlers that threw, or whose response could not be sent.
  Count abandoned_reached;      ///< Commands refused: too many handlers continue without an app.
  Count in_flight_reached;      ///< Times that a connection was not read: too many at work.
  Count reports_acknowledged;   ///< Reports that an app has acknowledged.
  Count reports_dropped;        ///< Reports that gave way to newer ones.
  Count bad_frames;             ///< Frames that could not be read.
};

/// A command that has arrived, for the thread that runs its handler.
struct Request {
  /// What to give back to `RobotCore::finish`.
  std::uint64_t handler = 0;
  /// The connection that it came over.
  ConnectionId connection = 0;
  /// Code and message id.
  FrameId frame;
  /// The whole JSON text, envelope included. Expires when the app waits no more.
  std::weak_ptr<const std::string> text;
  /// Settles whether the handler begins: the thread that sets it first lets it begin, or drops it if
  /// that is the core, because the app waits no more. A dropped handler is not given to `finish`.
  std::shared_ptr<std::atomic<bool>> settled;
  /// Set as soon as nobody waits for the answer any more.
  std::shared_ptr<const std::atomic<bool>> abandoned;
};

/// What a robot needs to know, all of it filled in.
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
  /// Whether commands that the spec does not know have handlers as well; if not, they are refused.
  bool hands_on_unknown = false;
};

namespace detail {

/// A report on its way to any number of apps.
struct Push {
  std::size_t open = 0;
  std::vector<AckOutcome> ended;
  Pushed done;
};

/// A report that waits for one app, or is in flight to it.
struct Queued {
  std::uint16_t code = 0;
  AckPolicy policy;
  std::shared_ptr<const std::string> body;
  std::shared_ptr<Push> push;
};

/// What the connections of a robot have in common.
struct RobotShared {
  const Protocol* protocol = nullptr;
  RobotSettings settings;
  RobotCounters counters;
  std::function<void(Request)> begin;
  std::function<void(ConnectionId, FrameId, const FrameError&)> unsendable;
  /// Memory is short: nothing is read.
  bool is_pressed = false;
  /// Bytes of all requests in handlers, including those of closed connections.
  std::shared_ptr<std::atomic<std::size_t>> handled_bytes =
      std::make_shared<std::atomic<std::size_t>>(0);
  std::uint64_t next_handler = 1;
  /// Handlers at work, each with its connection; those that nobody waits for are not here.
  std::unordered_map<std::uint64_t, ConnectionId> handlers;
  /// Handlers that have begun and whose app waits no more.
  std::size_t abandoned = 0;
  /// Pushes that have ended, and not been told so yet.
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
  /// The app has closed its half.
  void deaf() { deaf_ = true; }
  /// Reads no more, and ends once what has been begun is answered.
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
  /// Bytes that the app makes the robot hold.
  [[nodiscard]] std::size_t held() const {
    return decoder_.pending() + handled_bytes_ + queued_bytes_ + unsent();
  }
  /// Bytes of its requests that handlers have.
  [[nodiscard]] std::size_t handled_bytes() const { return handled_bytes_; }

 private:
  struct AtWork {
    FrameId frame;
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
  void answer(FrameId id, const Refusal& refusal);
  void append(FrameId id, std::string_view body);
  void begin_to_write();
  void send_reports(Instant now);
  void end(Queued report, AckOutcomeKind kind, std::optional<Refusal> refusal = {});
  [[nodiscard]] std::size_t unsent() const { return out_.size() + unwritten_; }
  /// When the connection is given up unless it goes on.
  [[nodiscard]] std::optional<Instant> patience() const;

  /// Whether the app may call a command, which nobody may know.
  [[nodiscard]] bool may_call(const OperationInfo* command) const;

  RobotShared* shared_;
  ConnectionId id_;
  /// What it may call; all where there are none.
  std::vector<Effect> effects_;
  Decoder decoder_;
  Encoder encoder_;
  Session session_;
  std::map<std::uint64_t, AtWork> handlers_;
  /// Bytes of their requests.
  std::size_t handled_bytes_ = 0;
  std::deque<Queued> queue_;
  std::unordered_map<Token, Queued> in_flight_;
  std::size_t queued_bytes_ = 0;
  Token next_token_ = 1;
  std::string out_;
  std::size_t unwritten_ = 0;
  /// When it was last told something.
  Instant now_;
  Instant last_read_;
  Instant last_written_;
  /// When the frame began that is arriving.
  std::optional<Instant> begun_;
  bool heard_ = false;
  bool deaf_ = false;
  bool draining_ = false;
  bool killed_ = false;
};

}  // namespace detail

/// A robot. Not to be used from two threads at once, but for its counters.
class RobotCore {
 public:
  /// `begin` is called with each command that is to be handled. The protocol has to outlive it.
  RobotCore(const Protocol& protocol, const RobotSettings& settings,
            std::function<void(Request)> begin);

  /// An app connects; none if there are too many. It may call what has these effects; none of them is
  /// all of them.
  [[nodiscard]] std::optional<ConnectionId> connect(Instant now, std::vector<Effect> effects = {});
  /// Returns `true` while there is room for one more connection.
  [[nodiscard]] bool takes_connections() const;
  /// Bytes have come over a connection.
  void received(ConnectionId id, std::string_view bytes, Instant now);
  /// The app has closed its half of a connection: what has been begun is still answered.
  void ended(ConnectionId id);
  /// A connection is no more, broken or closed.
  void closed(ConnectionId id);
  /// The counters. The owner of the sockets counts connections that it closes itself.
  [[nodiscard]] RobotCounters& counting() { return shared_->counters; }
  /// Is told of responses that do not fit into a frame.
  void set_unsendable(std::function<void(ConnectionId, FrameId, const FrameError&)> told) {
    shared_->unsendable = std::move(told);
  }
  /// Memory is short, or no longer: while it is, no connection takes bytes.
  void set_pressed(bool is_pressed) { shared_->is_pressed = is_pressed; }
  /// Bytes that a connection makes the robot hold.
  [[nodiscard]] std::size_t held(ConnectionId id) const;
  /// Bytes of requests in handlers whose app waits no more. No connection counts them.
  [[nodiscard]] std::size_t held_for_nobody() const;
  /// Returns `true` once a byte has come over a connection.
  [[nodiscard]] bool is_heard(ConnectionId id) const;
  /// What a handler has come to.
  void finish(std::uint64_t handler, const Handled& handled, Instant now);
  /// Sends a report, a whole body, to every app connected or to one. `done` is called by `settle` once
  /// it has ended at each. Says at how many apps it has been queued.
  std::size_t push(std::uint16_t code, std::string body, std::optional<ConnectionId> to,
                   Pushed done, Instant now);
  /// Begins to end: nothing more is read, what has been begun is answered, for so long at most.
  void shutdown(std::chrono::milliseconds grace, Instant now);
  /// Time has passed.
  void advance(Instant now);
  /// When `advance` is to be called at the latest.
  [[nodiscard]] std::optional<Instant> next_due() const;
  /// Calls what waits for reports that have ended.
  void settle();

  /// Whether a connection takes more bytes at this moment.
  [[nodiscard]] bool wants_bytes(ConnectionId id) const;
  /// What is to be sent over a connection; from then on it is the caller's.
  [[nodiscard]] std::string take_out(ConnectionId id);
  /// How much of that is not written yet, in bytes.
  void set_unwritten(ConnectionId id, std::size_t bytes, Instant now);
  /// Whether a connection is to be closed.
  [[nodiscard]] bool is_done(ConnectionId id) const;
  /// All connections.
  [[nodiscard]] std::vector<ConnectionId> connections() const;
  /// Whether a shutdown is over.
  [[nodiscard]] bool is_over() const;
  [[nodiscard]] const RobotCounters& counters() const { return shared_->counters; }

 private:
  [[nodiscard]] detail::RobotPeer* find(ConnectionId id) const;

  std::unique_ptr<detail::RobotShared> shared_;
  std::map<ConnectionId, std::unique_ptr<detail::RobotPeer>> peers_;
  ConnectionId next_id_ = 1;
  /// By when a shutdown is over.
  std::optional<Instant> over_by_;
  bool cut_off_ = false;
};

}  // namespace fc_runtime
