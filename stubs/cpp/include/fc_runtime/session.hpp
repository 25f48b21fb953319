// The session: which answer belongs to which request, what is due, what has been seen before. No
// sockets and no clocks: it is told what happened and what time it is.
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

/// A moment of a clock that never goes back.
using Instant = std::chrono::steady_clock::time_point;

/// The caller's own word for a request in flight.
using Token = std::uint64_t;

/// What a frame that has arrived means.
enum class Meaning {
  Answer,    ///< The answer to a request in flight, which has ended with it.
  Late,      ///< An answer that nobody waits for (any more): drop it.
  Command,   ///< A command: handle it and answer.
  Report,    ///< A report: hand it on, then say so with `handed_on`, and acknowledge it.
  Repeated,  ///< A report that has been handed on already: acknowledge it again, nothing else.
  Stream,    ///< Raw bytes.
};

/// A frame that has arrived.
struct Incoming {
  /// What it means.
  Meaning meaning = Meaning::Late;
  /// Of the request that it answers, where it answers one.
  Token token = 0;
};

/// What time has brought about for a request in flight.
struct Due {
  /// Whether to send it again, with the same id; otherwise it has ended without an answer.
  bool again = false;
  /// The request.
  FrameId frame;
  /// Its token.
  Token token = 0;
};

namespace detail {

/// The table of requests in flight. Ids count on, and an id's low bits are its slot: an id whose slot
/// is still taken is passed over, so that no two in flight are the same.
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
  /// When which id is due, earliest first; among them those of requests that have ended since.
  std::vector<Deadline> deadlines_;
};

/// A window over the last reports handed on. What has the same id and the same data is the same
/// report, whenever it comes. What has only the same id is the same report if it comes soon and over
/// the same connection; later, or over another one, it is another: a peer that restarts may use its
/// ids again.
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
    /// When it last came.
    Instant at;
  };

  /// Oldest first.
  std::deque<Entry> window_;
  std::size_t length_;
  std::chrono::milliseconds age_;
  std::uint64_t connection_ = 0;
};

}  // namespace detail

/// The state of one peer's conversation with another. Every token given to `open` comes back exactly
/// once: with the answer, as expired, as cancelled or by `end_if`.
class Session {
 public:
  /// Ids count on from `first_id`, and from 0 behind the largest. At most `limits.in_flight` requests
  /// are in flight, and no more than half of all ids. Reports handed on are remembered for twice as
  /// long as `ack` says that they may be repeated.
  Session(const Protocol& protocol, const Limits& limits, AckPolicy ack, std::uint32_t first_id);

  /// Puts a request in flight and gives the id to send it with; none if too many are in flight.
  [[nodiscard]] std::optional<FrameId> open(std::uint8_t kind, std::uint16_t code, AckPolicy policy,
                                            Instant now, Token token) {
    return outgoing_.open(kind, code, policy, now, token);
  }
  /// Says what a frame that has arrived means. By the digest of its data, reports are told apart that
  /// came over different connections.
  [[nodiscard]] Incoming receive(FrameId frame, const std::optional<Sum>& digest, Instant now);
  /// Remembers that a report has been handed on.
  void handed_on(FrameId report, const std::optional<Sum>& digest, Instant now) {
    seen_.insert(report, digest, now);
  }
  /// Notes that what comes from now on comes over another connection.
  void reconnected() { seen_.reconnected(); }
  /// Ends a request because nobody waits for its answer any more. A late answer will miss.
  std::optional<Token> cancel(FrameId request) { return outgoing_.end(request); }
  /// What is due; call it until it gives none.
  [[nodiscard]] std::optional<Due> due(Instant now) { return outgoing_.due(now); }
  /// Before this, nothing is due. May be earlier than the first deadline, never later.
  [[nodiscard]] std::optional<Instant> next_due() const { return outgoing_.earliest(); }
  /// Ends every request in flight that `ends` says so of, as when the connection is lost.
  [[nodiscard]] std::vector<std::pair<FrameId, Token>> end_if(
      const std::function<bool(FrameId, Token)>& ends) {
    return outgoing_.end_if(ends);
  }
  /// How many requests are in flight.
  [[nodiscard]] std::size_t in_flight() const noexcept { return outgoing_.size(); }

 private:
  detail::Outgoing outgoing_;
  detail::Seen seen_;
  std::uint8_t report_kind_;
  std::uint8_t stream_kind_;
};

namespace detail {

/// A wait that can be added to the time: a negative one is 0, and one too long for the clock a year.
[[nodiscard]] std::chrono::milliseconds bounded(std::chrono::milliseconds wait);

/// The time `wait` after `now`, as far as the clock goes.
[[nodiscard]] Instant after(Instant now, std::chrono::milliseconds wait);

}  // namespace detail

}  // namespace fc_runtime
