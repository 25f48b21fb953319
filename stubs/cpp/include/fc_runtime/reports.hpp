// Queues of received reports, one per receiver. Any thread may use them.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "fc_runtime/call.hpp"

namespace fc_runtime {

/// A report as received.
struct RawReport {
  /// Command code.
  std::uint16_t code = 0;
  /// Message id.
  std::uint32_t id = 0;
  /// The complete JSON text, including the envelope.
  std::string text;
};

/// An event for a follower of a process.
struct ReportEvent {
  /// The kind of the event.
  enum class Kind {
    Report,     ///< A report.
    Missed,     ///< Reports arrived that did not fit into the queue.
    Lost,       ///< The connection was lost. Later reports may be missing.
    Connected,  ///< The connection is up again.
    Closed,     ///< The connection is closed. The last event.
  };
  Kind kind = Kind::Closed;
  /// The report.
  RawReport report;
  /// Number of missed reports.
  std::uint64_t missed = 0;
  /// The reason of the loss.
  Loss why;
};

/// The reports for one receiver since its creation, in the order received.
///
/// The client acknowledges a report when at least one receiver has it in its queue. Without a
/// receiver with room, it does not acknowledge, so that the robot sends the report again.
class ReportQueue {
 public:
  /// Creates a queue for reports with one code, or any.
  ReportQueue(std::optional<std::uint16_t> code, std::size_t limit, std::size_t bytes)
      : code_(code), limit_(limit), bytes_limit_(bytes) {}

  /// Returns the next report, if one is queued.
  [[nodiscard]] std::optional<RawReport> try_next();
  /// Returns the next report. Returns nothing after `wait`, or if the connection is closed and the
  /// queue empty.
  [[nodiscard]] std::optional<RawReport> next(std::chrono::milliseconds wait);
  /// Returns the next event, or nothing if none arrives within `wait`.
  [[nodiscard]] std::optional<ReportEvent> next_event(std::chrono::milliseconds wait);
  /// Returns the number of missed reports since the last call. Reports are missed if this queue is
  /// full while another receiver takes them.
  [[nodiscard]] std::uint64_t take_missed();
  /// Returns `true` if the connection is closed and the queue empty.
  [[nodiscard]] bool is_over() const;

  // Called by the client.
  [[nodiscard]] bool wants(std::uint16_t code) const { return !code_ || *code_ == code; }
  [[nodiscard]] bool has_room(std::size_t bytes) const;
  void push(const RawReport& report);
  void miss();
  void lost(const Loss& why);
  void connected();
  void close();

 private:
  /// The events between two reports.
  struct Before {
    std::uint64_t missed = 0;
    std::optional<Loss> lost;
    bool connected = false;
  };

  [[nodiscard]] std::optional<RawReport> pop();
  [[nodiscard]] std::optional<ReportEvent> pop_event();

  std::optional<std::uint16_t> code_;
  std::size_t limit_;
  std::size_t bytes_limit_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::pair<Before, RawReport>> reports_;
  Before since_;
  bool is_cut_ = false;
  bool is_closed_ = false;
  std::size_t bytes_ = 0;
  std::uint64_t missed_ = 0;
};

/// All receivers of a connection. Each receiver owns its queue; without an owner, it receives no
/// more.
class Receivers {
 public:
  Receivers(std::size_t limit, std::size_t bytes) : limit_(limit), bytes_(bytes) {}

  /// Adds a receiver of reports with a code, or any.
  [[nodiscard]] std::shared_ptr<ReportQueue> enter(std::optional<std::uint16_t> code);
  /// Queues a report at all receivers with room. Returns how many had none, or nothing if none took
  /// it. A report that was taken must be acknowledged.
  [[nodiscard]] std::optional<std::uint64_t> push(const RawReport& report);
  void lost(const Loss& why);
  void connected();
  void close();

 private:
  [[nodiscard]] std::vector<std::shared_ptr<ReportQueue>> all();

  std::size_t limit_;
  std::size_t bytes_;
  std::mutex mutex_;
  bool is_closed_ = false;
  std::vector<std::weak_ptr<ReportQueue>> queues_;
};

}  // namespace fc_runtime
