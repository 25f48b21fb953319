// Follows the process that a command starts: the response, and then the reports.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "fc_runtime/client.hpp"
#include "fc_runtime/operation.hpp"
#include "fc_runtime/session.hpp"

namespace fc_runtime {

/// An event of a followed process.
template <class Message>
struct Followed {
  /// The kind of the event.
  enum class Kind {
    Going,        ///< The process goes on.
    Ended,        ///< The process has ended with a final state. The last event.
    Failed,       ///< The report means a failure. The last event.
    Missed,       ///< Reports did not fit into this queue while another receiver took them.
    Interrupted,  ///< The connection was lost. The events continue after the next connection.
    Resumed,      ///< There is a connection again. Query the robot's state: reports may be missing.
    Closed,       ///< The connection is closed for good; the process may go on. The last event.
  };
  Kind kind = Kind::Closed;
  /// The report, for the first three.
  std::optional<Message> report;
  /// Number of reports, for `Missed`.
  std::uint64_t missed = 0;
  /// The reason, for `Interrupted` and `Closed`.
  Loss why;

  /// Returns `true` for the last event.
  [[nodiscard]] bool is_over() const {
    return kind == Kind::Ended || kind == Kind::Failed || kind == Kind::Closed;
  }
};

/// An accepted command and the reports of its process. It has its own queue for reports with that
/// code. If no field ties a report to a call, it also returns the reports of other calls.
template <class Request, class Message>
class Following {
 public:
  using Response = typename Command<Request>::Response;

  Following(Connection connection, std::shared_ptr<ReportQueue> queue, Request request,
            Response answer)
      : connection_(std::move(connection)),
        queue_(std::move(queue)),
        request_(std::move(request)),
        answer_(std::move(answer)) {}

  /// The response of the robot to the command.
  [[nodiscard]] const Response& answer() const { return answer_; }
  /// Returns the next event. Returns nothing if none arrives within `wait`, or after the last
  /// event.
  [[nodiscard]] std::optional<Followed<Message>> next(std::chrono::milliseconds wait) {
    const auto until = detail::after(std::chrono::steady_clock::now(), wait);
    while (queue_) {
      const auto left =
          std::chrono::ceil<std::chrono::milliseconds>(until - std::chrono::steady_clock::now());
      auto event = queue_->next_event(std::max(left, std::chrono::milliseconds(0)));
      if (!event) return std::nullopt;
      auto followed = take(*std::move(event));
      if (!followed) continue;
      if (followed->is_over()) queue_.reset();
      return followed;
    }
    return std::nullopt;
  }

 private:
  using Kind = typename Followed<Message>::Kind;

  std::optional<Followed<Message>> take(ReportEvent event) {
    Followed<Message> followed;
    switch (event.kind) {
      case ReportEvent::Kind::Missed:
        followed.kind = Kind::Missed;
        followed.missed = event.missed;
        return followed;
      case ReportEvent::Kind::Lost:
        followed.kind = Kind::Interrupted;
        followed.why = std::move(event.why);
        return followed;
      case ReportEvent::Kind::Connected:
        followed.kind = Kind::Resumed;
        return followed;
      case ReportEvent::Kind::Closed:
        followed.why = connection_.state().why;
        return followed;
      case ReportEvent::Kind::Report:
        break;
    }
    using Facts = Report<Message>;
    auto report = read_report<Message>(connection_.protocol(), event.report.text,
                                       connection_.limits().json());
    // The client has read it successfully before the acknowledgement.
    if (!report || !SetsOff<Request, Message>::is_of(request_, answer_, *report)) {
      return std::nullopt;
    }
    if (last_ && !Facts::is_in_order(*report, *last_)) connection_.note_out_of_order();
    followed.kind = Facts::is_failure(*report) ? Kind::Failed
                    : Facts::is_end(*report)   ? Kind::Ended
                                               : Kind::Going;
    if (Facts::has_state(*report)) last_ = *report;
    followed.report = *std::move(report);
    return followed;
  }

  Connection connection_;
  /// Null after the last event: later reports would have no reader.
  std::shared_ptr<ReportQueue> queue_;
  Request request_;
  Response answer_;
  /// The last report with a state.
  std::optional<Message> last_;
};

/// Calls a command and follows its process from the moment the request is sent.
template <class Message, class Request>
Called<Following<Request, Message>> follow(const Connection& connection, const Request& request,
                                           const CallOptions& options = {}) {
  auto queue = connection.reports(Report<Message>::code);
  auto answer = connection.call(request, options);
  if (!answer) return std::move(answer).error();
  return Following<Request, Message>(connection, std::move(queue), request, *std::move(answer));
}

}  // namespace fc_runtime
