// The connection of one app to a robot.
#include <algorithm>

#include "fc_runtime/envelope.hpp"
#include "fc_runtime/robot_core.hpp"

namespace fc_runtime::detail {

namespace {

/// Limit of unsent bytes above which the robot reads and starts no more requests.
constexpr std::size_t kHighWater = std::size_t{256} * 1024;

Decoder decoder_of(const RobotShared& shared) {
  Decoder decoder(*shared.protocol);
  decoder.set_limits(shared.settings.limits);
  decoder.set_verify_digest(shared.settings.verify_digest);
  decoder.set_resync(shared.settings.resync);
  return decoder;
}

/// Spreads the repetitions to many apps: up to an eighth longer, by connection.
AckPolicy spread(AckPolicy policy, ConnectionId id) {
  policy.timeout += policy.timeout * static_cast<std::int64_t>(id % 8) / 64;
  return policy;
}

}  // namespace

RobotPeer::RobotPeer(RobotShared& shared, ConnectionId id, std::vector<Effect> effects, Instant now)
    : shared_(&shared),
      id_(id),
      effects_(std::move(effects)),
      decoder_(decoder_of(shared)),
      encoder_(*shared.protocol),
      session_(*shared.protocol, shared.settings.limits, shared.protocol->defaults.ack,
               shared.settings.first_id),
      now_(now),
      last_read_(now),
      last_written_(now) {
  encoder_.set_gzip(shared.settings.gzip);
  encoder_.set_frame_bytes(shared.settings.limits.frame_bytes);
}

RobotPeer::~RobotPeer() {
  for (const auto& [handler, at_work] : handlers_) {
    abandon(at_work);
    shared_->handlers.erase(handler);
  }
  drain();
}

/// Notes that the app has stopped waiting. A handler that has begun cannot be stopped; any other
/// does not begin.
void RobotPeer::abandon(const AtWork& handler) {
  handler.abandoned->store(true);
  if (!handler.settled->exchange(true)) return;
  ++shared_->abandoned;
  ++shared_->counters.handlers_abandoned;
}

void RobotPeer::drain() {
  draining_ = true;
  for (auto& [token, report] : in_flight_) end(std::move(report), AckOutcomeKind::Closed);
  for (auto& report : queue_) end(std::move(report), AckOutcomeKind::Closed);
  in_flight_.clear();
  queue_.clear();
  static_cast<void>(session_.end_if([](FrameId, Token) { return true; }));
}

bool RobotPeer::wants_bytes() const {
  return !deaf_ && !draining_ && !killed_ && !shared_->is_pressed && unsent() < kHighWater &&
         pace_.until() <= now_ && handlers_.size() < shared_->settings.limits.in_flight;
}

bool RobotPeer::is_done() const {
  return killed_ || ((deaf_ || draining_) && handlers_.empty() && unsent() == 0);
}

void RobotPeer::received(std::string_view bytes, Instant now) {
  now_ = now;
  if (deaf_ || draining_) return;
  heard_ = true;
  last_read_ = now;
  if (!begun_) begun_ = now;
  shared_->counters.bytes_in += bytes.size();
  decoder_.push(bytes);
  pump(now);
}

void RobotPeer::pump(Instant now) {
  while (!deaf_ && !draining_ && unsent() < kHighWater && pace_.until() <= now) {
    if (handlers_.size() >= shared_->settings.limits.in_flight) {
      if (decoder_.pending() > 0) ++shared_->counters.in_flight_reached;
      return;
    }
    auto next = decoder_.next();
    if (next && !*next) break;
    begun_ = now;
    if (next) {
      arrive(**next, now);
      continue;
    }
    ++shared_->counters.bad_frames;
    if (next.error().is_fatal()) {
      // Earlier requests still get their responses.
      deaf_ = true;
    } else if (!next.error().frame.response) {
      answer(next.error().frame, shared_->protocol->results.protocol);
    } else {
      rest(pace_.unusable(now));
    }
  }
  if (decoder_.pending() == 0) begun_.reset();
}

void RobotPeer::arrive(const Frame& frame, Instant now) {
  const FrameId id = frame.header.frame;
  rest(pace_.inflated(surplus_of(frame, shared_->protocol->header.length), now));
  const Incoming incoming = session_.receive(id, frame.header.digest, now);
  if (incoming.meaning == Meaning::Answer) {
    const auto found = in_flight_.find(incoming.token);
    if (found == in_flight_.end()) return;
    Queued report = std::move(found->second);
    in_flight_.erase(found);
    acknowledged(std::move(report), frame.data);
    send_reports(now);
    return;
  }
  if (incoming.meaning == Meaning::Late) {
    rest(pace_.unusable(now));
    return;
  }
  const OperationInfo* known = shared_->protocol->find(OperationKind::Command, id.code);
  const bool is_handled = known != nullptr || shared_->settings.hands_on_unknown;
  if (incoming.meaning != Meaning::Command || !is_handled) {
    answer(id, shared_->protocol->results.protocol);
    return;
  }
  if (!may_call(known)) {
    ++shared_->counters.calls_forbidden;
    answer(id, shared_->protocol->results.protocol);
    return;
  }
  if (shared_->abandoned >= shared_->settings.abandoned_handlers) {
    ++shared_->counters.abandoned_reached;
    answer(id, shared_->protocol->results.protocol);
    return;
  }
  begin(id, frame.data, now);
}

void RobotPeer::begin(FrameId frame, std::string_view text, Instant now) {
  const std::uint64_t handler = shared_->next_handler++;
  auto abandoned = std::make_shared<std::atomic<bool>>(false);
  // The handler may be the last owner.
  const auto forget = [bytes = shared_->handled_bytes](const std::string* held) {
    *bytes -= held->size();
    delete held;
  };
  *shared_->handled_bytes += text.size();
  const std::shared_ptr<const std::string> held(new std::string(text), forget);
  handled_bytes_ += text.size();
  auto settled = std::make_shared<std::atomic<bool>>(false);
  handlers_[handler] = {frame,     now,     after(now, shared_->settings.handler_timeout),
                        abandoned, settled, held};
  shared_->handlers[handler] = id_;
  shared_->begin({handler, id_, frame, held, std::move(settled), std::move(abandoned)});
}

bool RobotPeer::may_call(const OperationInfo* command) const {
  const Effect effect = command != nullptr ? command->effect : Effect::Unknown;
  return effects_.empty() || std::find(effects_.begin(), effects_.end(), effect) != effects_.end();
}

void RobotPeer::finish(std::uint64_t handler, const Handled& handled, Instant now) {
  now_ = now;
  const auto found = handlers_.find(handler);
  if (found == handlers_.end()) return;
  const FrameId frame = found->second.frame;
  const Instant begun = found->second.begun;
  handled_bytes_ -= found->second.text->size();
  handlers_.erase(found);
  shared_->handlers.erase(handler);
  ServerCounters& counters = shared_->counters;
  if (handled) {
    const bool is_sent = append(frame, *handled);
    ++(is_sent ? counters.calls_succeeded : counters.calls_protocol);
    tell_end(frame, is_sent ? "success" : "protocol", begun);
  } else {
    if (handled.error().is_not_implemented) ++counters.calls_not_implemented;
    answer(frame, handled.error(), begun);
  }
  pump(now);
}

void RobotPeer::tell_end(FrameId id, std::string_view result, Instant begun) const {
  if (!shared_->on_call) return;
  const OperationInfo* known = shared_->protocol->find(OperationKind::Command, id.code);
  shared_->on_call({known == nullptr ? "unknown" : known->name, result, now_ - begun});
}

void RobotPeer::answer(FrameId id, const Refusal& refusal, std::optional<Instant> begun) {
  const Results& results = shared_->protocol->results;
  ServerCounters& counters = shared_->counters;
  std::string_view result;
  if (refusal.code == results.protocol.code) {
    ++counters.calls_protocol;
    result = "protocol";
  } else if (refusal.code == results.invalid.code) {
    ++counters.calls_invalid;
    result = "invalid";
  } else if (refusal.code == results.expired.code) {
    ++counters.calls_expired;
    result = "expired";
  } else if (refusal.code == results.timeout.code) {
    ++counters.calls_timed_out;
    result = "timeout";
  } else {
    ++counters.calls_refused;
    result = "refused";
  }
  tell_end(id, result, begun.value_or(now_));
  const bool is_useless = result != "timeout" && result != "refused";
  if (is_useless) rest(pace_.unusable(now_));
  if (!shared_->protocol->has_result()) return;
  const Envelope envelope{unix_ms(), refusal.code, refusal.text};
  static_cast<void>(append(id, write_envelope(shared_->protocol->response_envelope, envelope)));
}

/// Counts that the connection must rest after useless work.
void RobotPeer::rest(bool must_rest) {
  if (must_rest) ++shared_->counters.connections_paced;
}

/// Restarts the write timeout when the app gets something to read. Before that, it cannot be slow.
void RobotPeer::begin_to_write() {
  if (unsent() == 0) last_written_ = now_;
}

/// Appends a response with this body. Appends a refusal and returns `false` if it does not fit into
/// a frame.
bool RobotPeer::append(FrameId id, std::string_view body) {
  begin_to_write();
  const std::size_t before = out_.size();
  FrameId response = id;
  response.response = true;
  const auto appended = encoder_.append(out_, response, body);
  if (!appended) {
    const auto& protocol = *shared_->protocol;
    if (shared_->unsendable) shared_->unsendable(id_, id, appended.error());
    const Envelope envelope{unix_ms(), protocol.results.protocol.code,
                            std::string(protocol.results.protocol.text)};
    static_cast<void>(
        encoder_.append(out_, response, write_envelope(protocol.response_envelope, envelope)));
  }
  shared_->counters.bytes_out += out_.size() - before;
  return bool(appended);
}

void RobotPeer::push(Queued report, Instant now) {
  now_ = now;
  if (draining_) {
    end(std::move(report), AckOutcomeKind::Closed);
    return;
  }
  const std::size_t bytes = report.body->size();
  queued_bytes_ += bytes;
  queue_.push_back(std::move(report));
  send_reports(now);
  // Without room, the oldest unsent report is dropped.
  while (!queue_.empty() && (queue_.size() > shared_->settings.limits.queued_reports ||
                             queued_bytes_ > shared_->settings.queued_bytes)) {
    Queued oldest = std::move(queue_.front());
    queue_.pop_front();
    ++shared_->counters.reports_dropped;
    end(std::move(oldest), AckOutcomeKind::Dropped);
  }
}

void RobotPeer::send_reports(Instant now) {
  while (!queue_.empty() && unsent() < kHighWater) {
    const Token token = next_token_;
    const Queued& report = queue_.front();
    const auto frame = session_.open(shared_->protocol->report_kind, report.code,
                                     spread(report.policy, id_), now, token);
    if (!frame) return;
    ++next_token_;
    Queued sent = std::move(queue_.front());
    queue_.pop_front();
    begin_to_write();
    const std::size_t before = out_.size();
    if (!encoder_.append(out_, *frame, *sent.body)) {
      static_cast<void>(session_.cancel(*frame));
      end(std::move(sent), AckOutcomeKind::Dropped);
      continue;
    }
    shared_->counters.bytes_out += out_.size() - before;
    ++shared_->counters.reports_sent;
    in_flight_.emplace(token, std::move(sent));
  }
}

void RobotPeer::acknowledged(Queued report, std::string_view text) {
  const auto envelope =
      read_envelope(shared_->protocol->response_envelope, text, shared_->settings.limits.json());
  if (!envelope) {
    ++shared_->counters.reports_refused;
    end(std::move(report), AckOutcomeKind::Invalid);
  } else if (envelope->code && *envelope->code != shared_->protocol->results.success.code) {
    ++shared_->counters.reports_refused;
    end(std::move(report), AckOutcomeKind::Refused,
        Refusal(*envelope->code, envelope->text.value_or("")));
  } else {
    ++shared_->counters.reports_acknowledged;
    end(std::move(report), AckOutcomeKind::Acknowledged);
  }
}

void RobotPeer::end(Queued report, AckOutcomeKind kind, std::optional<Refusal> refusal) {
  queued_bytes_ -= report.body->size();
  Push& push = *report.push;
  push.ended.push_back({id_, kind, std::move(refusal)});
  if (--push.open == 0) shared_->ended.push_back(std::move(report.push));
}

void RobotPeer::advance(Instant now) {
  now_ = now;
  while (const auto due = session_.due(now)) {
    const auto found = in_flight_.find(due->token);
    if (found == in_flight_.end()) continue;
    if (due->again) {
      begin_to_write();
      const std::size_t before = out_.size();
      static_cast<void>(encoder_.append(out_, due->frame, *found->second.body));
      shared_->counters.bytes_out += out_.size() - before;
      ++shared_->counters.reports_repeated;
      continue;
    }
    Queued report = std::move(found->second);
    in_flight_.erase(found);
    ++shared_->counters.reports_timed_out;
    end(std::move(report), AckOutcomeKind::TimedOut);
  }
  send_reports(now);
  for (auto at = handlers_.begin(); at != handlers_.end();) {
    if (at->second.due > now) {
      ++at;
      continue;
    }
    abandon(at->second);
    shared_->handlers.erase(at->first);
    answer(at->second.frame, shared_->protocol->results.timeout, at->second.begun);
    handled_bytes_ -= at->second.text->size();
    at = handlers_.erase(at);
  }
  pump(now);
  if (const auto late = patience(); late && *late <= now) {
    ++shared_->counters.connections_timed_out;
    killed_ = true;
  }
}

std::optional<Instant> RobotPeer::patience() const {
  const RobotSettings& settings = shared_->settings;
  if (unsent() > 0) return after(last_written_, settings.stall_timeout);
  if (!wants_bytes()) return std::nullopt;
  const std::size_t pending = decoder_.pending();
  if (pending > 0 && pending < shared_->protocol->header.length && begun_) {
    return after(*begun_, settings.header_timeout);
  }
  if (pending > 0) {
    const Instant silent = after(last_read_, settings.stall_timeout);
    if (!begun_ || settings.least_rate == 0) return silent;
    const std::chrono::seconds earned(pending / settings.least_rate);
    return std::min(silent, after(after(*begun_, settings.stall_timeout), earned));
  }
  if (settings.idle_timeout && handlers_.empty()) {
    return after(std::max(last_read_, last_written_), *settings.idle_timeout);
  }
  return std::nullopt;
}

std::optional<Instant> RobotPeer::next_due() const {
  std::optional<Instant> due = session_.next_due();
  const auto keep_earlier = [&due](const std::optional<Instant>& other) {
    if (other && (!due || *other < *due)) due = other;
  };
  for (const auto& [handler, at_work] : handlers_) keep_earlier(at_work.due);
  if (!killed_) keep_earlier(patience());
  if (pace_.until() > now_) keep_earlier(pace_.until());
  return due;
}

void RobotPeer::set_unwritten(std::size_t bytes, Instant now) {
  now_ = now;
  if (bytes < unwritten_ || unwritten_ == 0) last_written_ = now;
  unwritten_ = bytes;
  if (bytes == 0) {
    send_reports(now);
    pump(now);
  }
}

}  // namespace fc_runtime::detail
