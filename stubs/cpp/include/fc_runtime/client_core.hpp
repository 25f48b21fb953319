// A whole client without sockets, threads and clocks: whoever has these tells it what happened and
// what time it is, and writes what it has to send.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "fc_runtime/call.hpp"
#include "fc_runtime/count.hpp"
#include "fc_runtime/frame.hpp"
#include "fc_runtime/reports.hpp"
#include "fc_runtime/session.hpp"

namespace fc_runtime {

/// What a connection has seen since it was made, reconnecting included.
struct ClientCounters {
  Count bytes_in;          ///< Bytes received.
  Count bytes_out;         ///< Bytes handed to the connection to be sent.
  Count answers;           ///< Answers that reached their call.
  Count late_answers;      ///< Answers that nobody waited for any more.
  Count timeouts;          ///< Calls that ended without an answer in time.
  Count reports;           ///< Reports put into the queue of a receiver, and acknowledged.
  Count reports_missed;    ///< Reports that one receiver had no room for while another took them.
  Count repeated_reports;  ///< Reports that came again and were only acknowledged.
  Count reports_refused;   ///< Reports left unacknowledged: no receiver, or no room.
  Count reports_invalid;   ///< Reports refused because they do not read.
  Count reports_late;      ///< Reports more than one and a half of their intervals after the last.
  Count reports_out_of_order;  ///< Reports in another order than the protocol says.
  Count bad_frames;            ///< Frames that could not be read.
};

/// The state of a connection, for all who watch it; usable from any thread.
class Life {
 public:
  [[nodiscard]] ConnectionState now() const;
  /// Waits for another state than the `seen`-th; none if there is none in time. Nothing is queued:
  /// who asks late gets the latest.
  [[nodiscard]] std::optional<ConnectionState> next(std::uint64_t& seen,
                                                    std::chrono::milliseconds wait) const;

  // For the client.
  void connected();
  void lost(const Loss& why);
  void close(const Loss& why);

 private:
  void turn(ConnectionStatus status, std::uint64_t more, const Loss& why);

  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  ConnectionState state_;
  std::uint64_t version_ = 1;
};

/// Whether a frame that has begun goes on. It may take the stall timeout, and a second more for each
/// 16 KiB of it that have come: what a wrong length swallows must not pass for progress.
class Progress {
 public:
  explicit Progress(std::chrono::milliseconds limit) : limit_(detail::bounded(limit)) {}

  void whole() { since_.reset(); }
  void came(Instant now) {
    if (since_) since_->second = now;
  }
  /// When a frame of which so many bytes have come stalls; none in between frames.
  [[nodiscard]] std::optional<Instant> deadline(std::size_t received, Instant now);

 private:
  std::chrono::milliseconds limit_;
  /// When the frame began, and when bytes of it last came.
  std::optional<std::pair<Instant, Instant>> since_;
};

/// What a client needs to know, all of it filled in.
struct ClientSettings {
  Limits limits;
  std::chrono::milliseconds call_timeout{3000};
  std::chrono::milliseconds stall_timeout{10000};
  std::size_t queued_bytes = 0;
  std::uint32_t first_id = 0;
  std::optional<Gzip> gzip;
  bool verify_digest = true;
  bool resync = false;
};

/// The answer to a call: the text of its body, or why there is none.
using Answer = Result<std::string, CallError>;
/// What is done with an answer. Called once.
using Completion = std::function<void(Answer)>;

/// A client. Not to be used from two threads at once, but for what it shares.
class ClientCore {
 public:
  /// The protocol has to outlive it.
  ClientCore(const Protocol& protocol, const ClientSettings& settings);

  /// Makes a call with a whole body. It is ended by `settle`; `cancel` takes the number given here.
  std::uint64_t call(std::uint16_t code, std::string body, const CallOptions& options,
                     Completion done, Instant now);
  /// Ends a call that nobody waits for any more; its completion is not called.
  void cancel(std::uint64_t call);

  /// There is a connection.
  void connected();
  /// Bytes have come. Says why the connection has to end, if it has to.
  [[nodiscard]] std::optional<Loss> received(std::string_view bytes, Instant now);
  /// The robot has closed its end: why the connection has ended.
  [[nodiscard]] Loss ended() const;
  /// The connection has ended, and another one will be made.
  void lost(const Loss& why);
  /// There will be no connection any more.
  void close(const Loss& why);
  /// Time has passed. Says why the connection has to end, if it has to.
  [[nodiscard]] std::optional<Loss> advance(Instant now);
  /// When `advance` is to be called at the latest.
  [[nodiscard]] std::optional<Instant> next_due(Instant now);
  /// What is to be sent; from then on it is the caller's.
  [[nodiscard]] std::string take_out() { return std::exchange(out_, std::string()); }
  /// How much of that is not written yet, in bytes.
  void set_unwritten(std::size_t bytes, Instant now);
  /// Calls the completions of calls that have ended.
  void settle();

  /// Whether the robot has sent a frame over this connection.
  [[nodiscard]] bool is_heard() const { return heard_; }
  [[nodiscard]] std::size_t in_flight() const { return session_.in_flight(); }

  // What it shares with other threads.
  [[nodiscard]] Life& life() { return *life_; }
  [[nodiscard]] Receivers& receivers() { return *receivers_; }
  [[nodiscard]] const ClientCounters& counters() const { return *counters_; }
  void note_out_of_order() { ++counters_->reports_out_of_order; }

 private:
  enum class Stage { Unsent, Sent, Again };
  struct Call {
    FrameId frame;
    std::string body;
    Stage stage = Stage::Unsent;
    bool repeat = false;
    Completion done;
  };

  void arrive(const Frame& frame, Instant now);
  void arrive_broken(const FrameError& error, Instant now);
  void report(const Frame& frame, Instant now);
  [[nodiscard]] std::optional<BodyError> check_report(std::uint16_t code,
                                                      std::string_view text) const;
  void note_beat(std::uint16_t code, Instant now);
  void answer(FrameId id, const ResultText& result, std::string_view why = {});
  void send(std::uint64_t token, Call& call);
  void finish(std::uint64_t token, Answer answer);
  void end_calls(bool for_good, const Loss& why);

  const Protocol* protocol_;
  ClientSettings settings_;
  Decoder decoder_;
  Encoder encoder_;
  Session session_;
  Progress arriving_;
  std::unordered_map<std::uint64_t, Call> calls_;
  std::uint64_t next_call_ = 1;
  std::vector<std::pair<Completion, Answer>> ended_;
  std::string out_;
  std::size_t unwritten_ = 0;
  std::optional<Instant> unread_since_;
  bool connected_ = false;
  bool closed_ = false;
  bool heard_ = false;
  Loss why_;
  /// When the last report of a code came over this connection.
  std::map<std::uint16_t, Instant> beats_;
  std::unique_ptr<Life> life_ = std::make_unique<Life>();
  std::unique_ptr<Receivers> receivers_;
  std::unique_ptr<ClientCounters> counters_ = std::make_unique<ClientCounters>();
};

}  // namespace fc_runtime
