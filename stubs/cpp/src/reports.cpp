#include "fc_runtime/reports.hpp"

#include <utility>

#include "fc_runtime/session.hpp"

namespace fc_runtime {

std::optional<RawReport> ReportQueue::pop() {
  if (reports_.empty()) return std::nullopt;
  RawReport report = std::move(reports_.front().second);
  reports_.pop_front();
  bytes_ -= report.text.size();
  return report;
}

std::optional<ReportEvent> ReportQueue::pop_event() {
  Before& before = reports_.empty() ? since_ : reports_.front().first;
  ReportEvent event;
  if (before.missed > 0) {
    event.kind = ReportEvent::Kind::Missed;
    event.missed = std::exchange(before.missed, 0);
    return event;
  }
  if (before.lost) {
    event.kind = ReportEvent::Kind::Lost;
    event.why = *std::exchange(before.lost, std::nullopt);
    return event;
  }
  if (std::exchange(before.connected, false)) {
    event.kind = ReportEvent::Kind::Connected;
    return event;
  }
  if (auto report = pop()) {
    event.kind = ReportEvent::Kind::Report;
    event.report = *std::move(report);
    return event;
  }
  if (is_closed_) return event;
  return std::nullopt;
}

std::optional<RawReport> ReportQueue::try_next() {
  const std::lock_guard held(mutex_);
  return pop();
}

std::optional<RawReport> ReportQueue::next(std::chrono::milliseconds wait) {
  std::unique_lock held(mutex_);
  changed_.wait_for(held, detail::bounded(wait),
                    [this] { return !reports_.empty() || is_closed_; });
  return pop();
}

std::optional<ReportEvent> ReportQueue::next_event(std::chrono::milliseconds wait) {
  std::unique_lock held(mutex_);
  std::optional<ReportEvent> event;
  changed_.wait_for(held, detail::bounded(wait), [&] {
    event = pop_event();
    return event.has_value();
  });
  return event;
}

std::uint64_t ReportQueue::take_missed() {
  const std::lock_guard held(mutex_);
  return std::exchange(missed_, 0);
}

bool ReportQueue::is_over() const {
  const std::lock_guard held(mutex_);
  return is_closed_ && reports_.empty();
}

bool ReportQueue::has_room(std::size_t bytes) const {
  const std::lock_guard held(mutex_);
  return !is_closed_ && reports_.size() < limit_ && bytes_ + bytes <= bytes_limit_;
}

void ReportQueue::push(const RawReport& report) {
  const std::lock_guard held(mutex_);
  bytes_ += report.text.size();
  reports_.emplace_back(std::exchange(since_, Before()), report);
  changed_.notify_all();
}

void ReportQueue::miss() {
  const std::lock_guard held(mutex_);
  ++missed_;
  ++since_.missed;
  changed_.notify_all();
}

void ReportQueue::lost(const Loss& why) {
  const std::lock_guard held(mutex_);
  is_cut_ = true;
  since_.lost = why;
  since_.connected = false;
  changed_.notify_all();
}

void ReportQueue::connected() {
  const std::lock_guard held(mutex_);
  if (std::exchange(is_cut_, false)) since_.connected = true;
  changed_.notify_all();
}

void ReportQueue::close() {
  const std::lock_guard held(mutex_);
  is_closed_ = true;
  changed_.notify_all();
}

std::shared_ptr<ReportQueue> Receivers::enter(std::optional<std::uint16_t> code) {
  const std::lock_guard held(mutex_);
  auto queue = std::make_shared<ReportQueue>(code, limit_, bytes_);
  if (is_closed_) queue->close();
  queues_.push_back(queue);
  return queue;
}

std::vector<std::shared_ptr<ReportQueue>> Receivers::all() {
  const std::lock_guard held(mutex_);
  std::vector<std::shared_ptr<ReportQueue>> there;
  std::vector<std::weak_ptr<ReportQueue>> left;
  for (const auto& weak : queues_) {
    if (auto queue = weak.lock()) {
      there.push_back(std::move(queue));
      left.push_back(weak);
    }
  }
  queues_ = std::move(left);
  return there;
}

std::optional<std::uint64_t> Receivers::push(const RawReport& report) {
  // Only this thread adds to the queues; others only take.
  std::vector<std::shared_ptr<ReportQueue>> takers;
  std::vector<std::shared_ptr<ReportQueue>> full;
  for (auto& queue : all()) {
    if (!queue->wants(report.code)) continue;
    (queue->has_room(report.text.size()) ? takers : full).push_back(std::move(queue));
  }
  if (takers.empty()) return std::nullopt;
  for (const auto& queue : takers) queue->push(report);
  for (const auto& queue : full) queue->miss();
  return full.size();
}

void Receivers::lost(const Loss& why) {
  for (const auto& queue : all()) queue->lost(why);
}

void Receivers::connected() {
  for (const auto& queue : all()) queue->connected();
}

void Receivers::close() {
  {
    const std::lock_guard held(mutex_);
    is_closed_ = true;
  }
  for (const auto& queue : all()) queue->close();
}

}  // namespace fc_runtime
