// The session matches responses with requests, finds due retries, and detects repeated reports. It
// has no sockets and no clocks: the caller feeds it events and the time.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <queue>
#include <utility>
#include <vector>

#include "fc_runtime/digest.hpp"
#include "fc_runtime/error.hpp"
#include "fc_runtime/protocol.hpp"

namespace fc_runtime {

/// A time of a monotonic clock.
using Instant = std::chrono::steady_clock::time_point;

/// A value of the caller that identifies a request in flight.
using Token = std::uint64_t;

/// The meaning of a received frame.
enum class Meaning {
  Answer,    ///< The response to a request in flight, which ends with it.
  Late,      ///< A response without a request in flight: drop it.
  Command,   ///< A command: handle it and respond.
  Report,    ///< A report: hand it on, call `handed_on`, and acknowledge it.
  Repeated,  ///< A report that was handed on before: only acknowledge it again.
  Stream,    ///< Raw bytes.
};

/// A received frame.
struct Incoming {
  /// The meaning of the frame.
  Meaning meaning = Meaning::Late;
  /// The token of the request, for `Answer`.
  Token token = 0;
};

/// A request whose wait has ended.
struct Due {
  /// `true`: send the request again with the same id. `false`: it has ended without a response.
  bool again = false;
  /// The request.
  FrameId frame;
  /// The token of the request.
  Token token = 0;
};

namespace detail {

/// The table of requests in flight. Ids count up, and the low bits of an id are its slot. An id
/// with an occupied slot is skipped, so that all ids in flight differ.
class Outgoing {
 public:
  Outgoing(std::size_t limit, std::uint32_t first_id, std::uint32_t id_max);

  [[nodiscard]] std::optional<FrameId> open(std::uint8_t kind, std::uint16_t code, AckPolicy policy,
                                            Instant now, Token token);
  [[nodiscard]] std::optional<Token> end(FrameId frame);
  [[nodiscard]] std::optional<Due> due(Instant now);
  [[nodiscard]] std::optional<Instant> earliest() const;
  [[nodiscard]] std::vector<std::pair<FrameId, Token>> end_if(
      const std::function<bool(FrameId, Token)>& ends);
  [[nodiscard]] std::size_t size() const noexcept { return in_flight_; }

 private:
  struct Entry {
    FrameId frame;
    Instant due;
    std::chrono::milliseconds timeout{};
    std::uint32_t repetitions_left = 0;
    Token token = 0;
  };
  using Deadline = std::pair<Instant, std::uint32_t>;

  [[nodiscard]] std::size_t slot_of(std::uint32_t id) const { return id & (slots_.size() - 1); }
  [[nodiscard]] bool is_due_at(const Deadline& deadline) const;
  void grow();
  void add_deadline(Deadline deadline);

  std::vector<std::optional<Entry>> slots_;
  std::size_t in_flight_ = 0;
  std::size_t limit_;
  std::uint32_t next_id_;
  std::uint32_t id_max_;
  /// The deadlines with their ids, earliest first. May contain requests that have ended.
  std::vector<Deadline> deadlines_;
};

/// A window over the last reports handed on. A report with the same id and data is a repetition at
/// any time. A report with only the same id is a repetition if it arrives soon and over the same
/// connection. Otherwise it is new: a restarted peer may reuse its ids.
class Seen {
 public:
  Seen(std::size_t length, std::chrono::milliseconds age) : length_(length), age_(age) {}

  void reconnected() { ++connection_; }
  [[nodiscard]] bool contains(FrameId frame, const std::optional<Sum>& digest, Instant now);
  void insert(FrameId frame, const std::optional<Sum>& digest, Instant now);

 private:
  struct Entry {
    FrameId frame;
    std::optional<Sum> digest;
    std::uint64_t connection = 0;
    /// The time of the latest arrival.
    Instant at;
  };

  /// Oldest first.
  std::deque<Entry> window_;
  std::size_t length_;
  std::chrono::milliseconds age_;
  std::uint64_t connection_ = 0;
};

}  // namespace detail

/// The state of the exchange with one peer. Every token given to `open` returns exactly once: with
/// the response, as expired, as cancelled or by `end_if`.
class Session {
 public:
  /// Ids count up from `first_id`, and continue at 0 after the largest. At most `limits.in_flight`
  /// requests are in flight, and at most half of all ids. Reports are remembered for twice the
  /// retry time of `ack`.
  Session(const Protocol& protocol, const Limits& limits, AckPolicy ack, std::uint32_t first_id);

  /// Opens a request and returns its id, or nothing if too many are in flight.
  [[nodiscard]] std::optional<FrameId> open(std::uint8_t kind, std::uint16_t code, AckPolicy policy,
                                            Instant now, Token token) {
    return outgoing_.open(kind, code, policy, now, token);
  }
  /// Returns the meaning of a received frame. The digest of its data distinguishes reports over
  /// different connections.
  [[nodiscard]] Incoming receive(FrameId frame, const std::optional<Sum>& digest, Instant now);
  /// Remembers a report that was handed on.
  void handed_on(FrameId report, const std::optional<Sum>& digest, Instant now) {
    seen_.insert(report, digest, now);
  }
  /// Notes that the following frames arrive over a new connection.
  void reconnected() { seen_.reconnected(); }
  /// Cancels a request. A late response is then `Late`.
  std::optional<Token> cancel(FrameId request) { return outgoing_.end(request); }
  /// Returns the next due request. Call it until it returns nothing.
  [[nodiscard]] std::optional<Due> due(Instant now) { return outgoing_.due(now); }
  /// The time before which no request is due. May be earlier than the first deadline.
  [[nodiscard]] std::optional<Instant> next_due() const { return outgoing_.earliest(); }
  /// Ends every request in flight for which `ends` returns `true`, such as after a loss.
  [[nodiscard]] std::vector<std::pair<FrameId, Token>> end_if(
      const std::function<bool(FrameId, Token)>& ends) {
    return outgoing_.end_if(ends);
  }
  /// Number of requests in flight.
  [[nodiscard]] std::size_t in_flight() const noexcept { return outgoing_.size(); }

 private:
  detail::Outgoing outgoing_;
  detail::Seen seen_;
  std::uint8_t report_kind_;
  std::uint8_t stream_kind_;
};

namespace detail {

/// Returns a wait that can be added to the time: at least 0, and one year if the clock cannot hold
/// it.
[[nodiscard]] std::chrono::milliseconds bounded(std::chrono::milliseconds wait);

/// Returns the time `wait` after `now`, limited by the clock.
[[nodiscard]] Instant after(Instant now, std::chrono::milliseconds wait);

}  // namespace detail

}  // namespace fc_runtime
