#include "fc_runtime/session.hpp"

#include <algorithm>

namespace fc_runtime {

namespace {

using std::chrono::milliseconds;

/// Initial number of slots of a table.
constexpr std::size_t kFirstSlots = 16;
/// A time that is never reached in practice.
constexpr auto kFar = std::chrono::hours(24 * 365);

std::size_t half_of_ids(const Protocol& protocol) {
  return std::size_t{protocol.header.id_max()} / 2 + 1;
}

/// Returns the number of reports to remember. A peer repeats the reports in flight, up to its own
/// limit.
std::size_t remembered(const Protocol& protocol, const Limits& limits) {
  const std::size_t most =
      std::max({limits.queued_reports, limits.in_flight, protocol.defaults.limits.in_flight});
  return std::min(most, half_of_ids(protocol));
}

/// Returns twice the time for which a report may be repeated.
milliseconds age(AckPolicy ack) {
  const auto far = std::chrono::duration_cast<milliseconds>(kFar);
  const std::uint64_t times = 2 * (std::uint64_t{ack.retries} + 1);
  const auto timeout = static_cast<std::uint64_t>(std::max<std::int64_t>(ack.timeout.count(), 0));
  if (timeout > static_cast<std::uint64_t>(far.count()) / times) return far;
  return milliseconds(static_cast<std::int64_t>(timeout * times));
}

}  // namespace

namespace detail {

milliseconds bounded(milliseconds wait) {
  return std::clamp<milliseconds>(wait, milliseconds(0), kFar);
}

Instant after(Instant now, milliseconds wait) { return now + bounded(wait); }

Outgoing::Outgoing(std::size_t limit, std::uint32_t first_id, std::uint32_t id_max)
    : limit_(limit), next_id_(first_id & id_max), id_max_(id_max) {}

bool Outgoing::is_due_at(const Deadline& deadline) const {
  if (slots_.empty()) return false;
  const auto& entry = slots_[slot_of(deadline.second)];
  return entry && entry->frame.id == deadline.second && entry->due == deadline.first;
}

std::optional<Instant> Outgoing::earliest() const {
  if (deadlines_.empty()) return std::nullopt;
  return deadlines_.front().first;
}

void Outgoing::add_deadline(Deadline deadline) {
  // Most requests end before their deadline. Once enough of these have accumulated, they are
  // removed.
  if (deadlines_.size() >= 2 * in_flight_ + kFirstSlots) {
    const auto is_over = [this](const Deadline& held) { return !is_due_at(held); };
    deadlines_.erase(std::remove_if(deadlines_.begin(), deadlines_.end(), is_over),
                     deadlines_.end());
    std::make_heap(deadlines_.begin(), deadlines_.end(), std::greater<>());
  }
  deadlines_.push_back(deadline);
  std::push_heap(deadlines_.begin(), deadlines_.end(), std::greater<>());
}

/// Grows until at most half of the slots are occupied, so that a free one is always near.
void Outgoing::grow() {
  if ((in_flight_ + 1) * 2 <= slots_.size()) return;
  std::vector<std::optional<Entry>> old(std::max(slots_.size() * 2, kFirstSlots));
  old.swap(slots_);
  for (auto& entry : old) {
    // Ids that differ in a few low bits also differ in more of them.
    if (entry) slots_[slot_of(entry->frame.id)] = entry;
  }
}

std::optional<FrameId> Outgoing::open(std::uint8_t kind, std::uint16_t code, AckPolicy policy,
                                      Instant now, Token token) {
  if (in_flight_ >= limit_) return std::nullopt;
  grow();
  for (;;) {
    const std::uint32_t id = next_id_;
    next_id_ = (id + 1) & id_max_;
    auto& place = slots_[slot_of(id)];
    if (place) continue;
    const FrameId frame{false, kind, code, id};
    const Instant due = after(now, policy.timeout);
    place = Entry{frame, due, policy.timeout, policy.retries, token};
    ++in_flight_;
    add_deadline({due, id});
    return frame;
  }
}

std::optional<Token> Outgoing::end(FrameId frame) {
  if (slots_.empty()) return std::nullopt;
  auto& place = slots_[slot_of(frame.id)];
  if (!place || place->frame.id != frame.id || place->frame.kind != frame.kind ||
      place->frame.code != frame.code) {
    return std::nullopt;
  }
  const Token token = place->token;
  place.reset();
  --in_flight_;
  return token;
}

std::optional<Due> Outgoing::due(Instant now) {
  for (;;) {
    if (deadlines_.empty() || deadlines_.front().first > now) return std::nullopt;
    const Deadline deadline = deadlines_.front();
    std::pop_heap(deadlines_.begin(), deadlines_.end(), std::greater<>());
    deadlines_.pop_back();
    if (!is_due_at(deadline)) continue;
    auto& place = slots_[slot_of(deadline.second)];
    Entry& entry = *place;
    Due out{entry.repetitions_left > 0, entry.frame, entry.token};
    if (!out.again) {
      place.reset();
      --in_flight_;
      return out;
    }
    --entry.repetitions_left;
    entry.due = after(now, entry.timeout);
    add_deadline({entry.due, deadline.second});
    return out;
  }
}

std::vector<std::pair<FrameId, Token>> Outgoing::end_if(
    const std::function<bool(FrameId, Token)>& ends) {
  std::vector<std::pair<FrameId, Token>> ended;
  for (auto& place : slots_) {
    if (!place || !ends(place->frame, place->token)) continue;
    ended.emplace_back(place->frame, place->token);
    place.reset();
    --in_flight_;
  }
  return ended;
}

bool Seen::contains(FrameId frame, const std::optional<Sum>& digest, Instant now) {
  const auto same = [&](const Entry& entry) {
    if (entry.frame != frame) return false;
    if (entry.digest && digest && *entry.digest == *digest) return true;
    const bool is_recent = now - entry.at <= age_;
    if (!entry.digest || !digest) return is_recent;
    return entry.connection == connection_ && is_recent;
  };
  const auto found = std::find_if(window_.rbegin(), window_.rend(), same);
  if (found == window_.rend()) return false;
  // The report may be repeated for the full time again, so its age restarts.
  Entry entry = *found;
  window_.erase(std::next(found).base());
  entry.connection = connection_;
  entry.at = now;
  window_.push_back(entry);
  return true;
}

void Seen::insert(FrameId frame, const std::optional<Sum>& digest, Instant now) {
  if (length_ == 0) return;
  if (window_.size() == length_) window_.pop_front();
  window_.push_back({frame, digest, connection_, now});
}

}  // namespace detail

Session::Session(const Protocol& protocol, const Limits& limits, AckPolicy ack,
                 std::uint32_t first_id)
    : outgoing_(std::min(limits.in_flight, half_of_ids(protocol)), first_id,
                protocol.header.id_max()),
      seen_(remembered(protocol, limits), age(ack)),
      report_kind_(protocol.report_kind),
      stream_kind_(protocol.stream_kind) {}

Incoming Session::receive(FrameId frame, const std::optional<Sum>& digest, Instant now) {
  if (frame.response) {
    const auto token = outgoing_.end(frame);
    if (!token) return {Meaning::Late, 0};
    return {Meaning::Answer, *token};
  }
  if (frame.kind == report_kind_) {
    return {seen_.contains(frame, digest, now) ? Meaning::Repeated : Meaning::Report, 0};
  }
  return {frame.kind == stream_kind_ ? Meaning::Stream : Meaning::Command, 0};
}

}  // namespace fc_runtime
