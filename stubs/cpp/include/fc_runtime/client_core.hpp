// A complete client without sockets, threads and clocks. The caller feeds it events and the time,
// and sends the bytes that it produces.
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

/// The counters of a connection since it was created. They continue over reconnections.
struct ClientCounters {
  Count bytes_in;          ///< Bytes received.
  Count bytes_out;         ///< Bytes handed to the connection to be sent.
  Count answers;           ///< Responses that reached their call.
  Count late_answers;      ///< Responses without a waiting call.
  Count timeouts;          ///< Calls that ended without a response in time.
  Count reports;           ///< Reports put into the queue of a receiver, and acknowledged.
  Count reports_missed;    ///< Reports that a full receiver missed while another took them.
  Count repeated_reports;  ///< Reports that came again and were only acknowledged.
  Count reports_refused;   ///< Reports left unacknowledged: no receiver, or no room.
  Count reports_invalid;   ///< Reports refused because they do not read.
  Count reports_late;      ///< Reports more than one and a half of their intervals after the last.
  Count reports_out_of_order;  ///< Reports that violate the order in the protocol.
  Count bad_frames;            ///< Frames that could not be read.
};

/// The state of a connection, for all watchers. Any thread may use it.
class Life {
 public:
  [[nodiscard]] ConnectionState now() const;
  /// Waits for a state other than number `seen`. Returns nothing if none arrives within `wait`.
  /// States are not queued: a late caller gets only the latest.
  [[nodiscard]] std::optional<ConnectionState> next(std::uint64_t& seen,
                                                    std::chrono::milliseconds wait) const;

  // Called by the client.
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

/// Iterates over the states of a connection, starting with the current one. States are not queued:
/// a late caller gets only the latest.
class ConnectionStates {
 public:
  explicit ConnectionStates(std::shared_ptr<const Life> life) : life_(std::move(life)) {}
  /// Returns the next state, or nothing if none arrives within `wait`.
  [[nodiscard]] std::optional<ConnectionState> next(std::chrono::milliseconds wait) {
    return life_->next(seen_, wait);
  }

 private:
  std::shared_ptr<const Life> life_;
  std::uint64_t seen_ = 0;
};

/// Detects a stalled frame. A frame may take the stall timeout, plus one second for each received
/// 16 KiB. The rate limit keeps a wrong length from passing for progress.
class Progress {
 public:
  explicit Progress(std::chrono::milliseconds limit) : limit_(detail::bounded(limit)) {}

  void whole() { since_.reset(); }
  void came(Instant now) {
    if (since_) since_->second = now;
  }
  /// Returns the time when the frame stalls after `received` bytes, or nothing between frames.
  [[nodiscard]] std::optional<Instant> deadline(std::size_t received, Instant now);

 private:
  std::chrono::milliseconds limit_;
  /// The arrival of the first and of the latest bytes of the frame.
  std::optional<std::pair<Instant, Instant>> since_;
};

/// The settings of a client, all set.
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

/// The outcome of a call: the body of the response, or the error.
using Answer = Result<std::string, CallError>;
/// Takes the outcome of a call. Called once.
using Completion = std::function<void(Answer)>;

/// A client. It is not thread-safe, except for its shared parts.
class ClientCore {
 public:
  /// The protocol must outlive the client.
  ClientCore(const Protocol& protocol, const ClientSettings& settings);

  /// Starts a call with a complete body. `settle` completes it. Returns its number for `cancel`.
  std::uint64_t call(std::uint16_t code, std::string body, const CallOptions& options,
                     Completion done, Instant now);
  /// Cancels a call. Its completion is not called.
  void cancel(std::uint64_t call);

  /// Notes that the connection is up.
  void connected();
  /// Takes received bytes. Returns the reason if the connection must end.
  [[nodiscard]] std::optional<Loss> received(std::string_view bytes, Instant now);
  /// Returns the reason of the loss after the robot has closed its end.
  [[nodiscard]] Loss ended() const;
  /// Notes that the connection is lost and another one follows.
  void lost(const Loss& why);
  /// Notes that no connection follows.
  void close(const Loss& why);
  /// Advances the time. Returns the reason if the connection must end.
  [[nodiscard]] std::optional<Loss> advance(Instant now);
  /// The latest time for the next call of `advance`.
  [[nodiscard]] std::optional<Instant> next_due(Instant now);
  /// Returns the bytes to send, and forgets them.
  [[nodiscard]] std::string take_out() { return std::exchange(out_, std::string()); }
  /// Sets the number of bytes from `take_out` that are not written yet.
  void set_unwritten(std::size_t bytes, Instant now);
  /// Calls the completions of ended calls.
  void settle();

  /// Returns `true` once the robot has sent a frame over this connection.
  [[nodiscard]] bool is_heard() const { return heard_; }
  [[nodiscard]] std::size_t in_flight() const { return session_.in_flight(); }

  // Parts shared with other threads.
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
  /// The arrival of the last report with each code over this connection.
  std::map<std::uint16_t, Instant> beats_;
  std::unique_ptr<Life> life_ = std::make_unique<Life>();
  std::unique_ptr<Receivers> receivers_;
  std::unique_ptr<ClientCounters> counters_ = std::make_unique<ClientCounters>();
};

}  // namespace fc_runtime
