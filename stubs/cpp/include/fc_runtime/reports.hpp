// Reports on their way to the app: what waits for each of its receivers. Usable from any thread.
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
  /// The whole JSON text, envelope included.
  std::string text;
};

/// What comes to who follows a process.
struct ReportEvent {
  /// What it is.
  enum class Kind {
    Report,     ///< A report.
    Missed,     ///< Reports came for which there was no room.
    Lost,       ///< The connection was lost; what was reported meanwhile is not known.
    Connected,  ///< There is a connection again.
    Closed,     ///< Nothing comes any more.
  };
  Kind kind = Kind::Closed;
  /// The report.
  RawReport report;
  /// How many were missed.
  std::uint64_t missed = 0;
  /// Why the connection was lost.
  Loss why;
};

/// The reports for one receiver, from its making on, in the order in which they came. A report is
/// acknowledged when at least one receiver has it in its queue; while no receiver has room, or there
/// is none, reports are not acknowledged, so that the robot sends them again.
class ReportQueue {
 public:
  /// For reports of one code, or of any.
  ReportQueue(std::optional<std::uint16_t> code, std::size_t limit, std::size_t bytes)
      : code_(code), limit_(limit), bytes_limit_(bytes) {}

  /// The next report, if one is there.
  [[nodiscard]] std::optional<RawReport> try_next();
  /// The next report; none if none has come in time, or if the connection is closed and none is left.
  [[nodiscard]] std::optional<RawReport> next(std::chrono::milliseconds wait);
  /// The next report or what was in between; none if nothing has come in time.
  [[nodiscard]] std::optional<ReportEvent> next_event(std::chrono::milliseconds wait);
  /// How many reports were missed since this was last asked, because the queue was full while another
  /// receiver took them.
  [[nodiscard]] std::uint64_t take_missed();
  /// Whether the connection is closed and nothing is left.
  [[nodiscard]] bool is_over() const;

  // For the client.
  [[nodiscard]] bool wants(std::uint16_t code) const { return !code_ || *code_ == code; }
  [[nodiscard]] bool has_room(std::size_t bytes) const;
  void push(const RawReport& report);
  void miss();
  void lost(const Loss& why);
  void connected();
  void close();

 private:
  /// What a receiver has not got between one report and the next.
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

/// All receivers of a connection. They keep their queues; who lets go of one receives no more.
class Receivers {
 public:
  Receivers(std::size_t limit, std::size_t bytes) : limit_(limit), bytes_(bytes) {}

  /// One more, of reports of a code or of any.
  [[nodiscard]] std::shared_ptr<ReportQueue> enter(std::optional<std::uint16_t> code);
  /// Gives a report to all that have room for it: acknowledge it. Says how many had none; nothing if
  /// nobody has got it.
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
