#include "fc_runtime/client_core.hpp"

#include <algorithm>

#include "fc_runtime/envelope.hpp"

namespace fc_runtime {

namespace {

/// Limit of unsent bytes above which reports are not acknowledged. A robot that does not read must
/// not make the app collect acknowledgements.
constexpr std::size_t kAcknowledgeUpTo = std::size_t{256} * 1024;
/// Least rate of a frame after the stall timeout, in bytes per second.
constexpr std::uint64_t kLeast = 16 * 1024;

CallError failed(CallErrorKind kind, const Loss& why) {
  CallError error;
  error.kind = kind;
  error.loss = why;
  return error;
}

CallError failed(CallErrorKind kind) {
  CallError error;
  error.kind = kind;
  return error;
}

CallError failed(const FrameError& frame) {
  CallError error;
  error.kind = CallErrorKind::Frame;
  error.frame = frame;
  return error;
}

void keep_earlier(std::optional<Instant>& first, const std::optional<Instant>& other) {
  if (other && (!first || *other < *first)) first = other;
}

}  // namespace

ConnectionState Life::now() const {
  const std::lock_guard held(mutex_);
  return state_;
}

std::optional<ConnectionState> Life::next(std::uint64_t& seen,
                                          std::chrono::milliseconds wait) const {
  std::unique_lock held(mutex_);
  if (!changed_.wait_for(held, wait, [&] { return version_ != seen; })) return std::nullopt;
  seen = version_;
  return state_;
}

void Life::turn(ConnectionStatus status, std::uint64_t more, const Loss& why) {
  const std::lock_guard held(mutex_);
  if (state_.status == ConnectionStatus::Closed) return;
  state_.status = status;
  state_.connects += more;
  state_.why = why;
  ++version_;
  changed_.notify_all();
}

void Life::connected() { turn(ConnectionStatus::Connected, 1, {}); }
void Life::lost(const Loss& why) { turn(ConnectionStatus::Connecting, 0, why); }
void Life::close(const Loss& why) { turn(ConnectionStatus::Closed, 0, why); }

std::optional<Instant> Progress::deadline(std::size_t received, Instant now) {
  if (received == 0) {
    since_.reset();
    return std::nullopt;
  }
  if (!since_) since_ = {now, now};
  const auto earned = std::chrono::milliseconds(std::uint64_t{received} * 1000 / kLeast);
  return std::min(detail::after(since_->second, limit_),
                  detail::after(since_->first, limit_ + earned));
}

ClientCore::ClientCore(const Protocol& protocol, const ClientSettings& settings)
    : protocol_(&protocol),
      settings_(settings),
      decoder_(protocol),
      encoder_(protocol),
      session_(protocol, settings.limits, protocol.defaults.ack, settings.first_id),
      arriving_(settings.stall_timeout),
      receivers_(
          std::make_unique<Receivers>(settings.limits.queued_reports, settings.queued_bytes)) {
  encoder_.set_gzip(settings.gzip);
  encoder_.set_frame_bytes(settings.limits.frame_bytes);
}

std::uint64_t ClientCore::call(std::uint16_t code, std::string body, const CallOptions& options,
                               Completion done, Instant now) {
  const std::uint64_t token = next_call_++;
  if (closed_) {
    ended_.emplace_back(std::move(done), failed(CallErrorKind::Closed, why_));
    return token;
  }
  if (options.timeout && options.timeout->count() < 0) {
    CallError error = failed(CallErrorKind::InvalidRequest);
    error.body =
        BodyError{BodyErrorKind::OutOfRange, "CallOptions::timeout", 0,
                  std::to_string(options.timeout->count()) + " ms, expected a time from 0"};
    ended_.emplace_back(std::move(done), std::move(error));
    return token;
  }
  const AckPolicy policy{options.timeout.value_or(settings_.call_timeout), 0};
  const auto frame = session_.open(protocol_->command_kind, code, policy, now, token);
  if (!frame) {
    ended_.emplace_back(std::move(done), failed(CallErrorKind::Busy));
    return token;
  }
  Call& call = calls_[token];
  call.frame = *frame;
  call.body = std::move(body);
  call.repeat = options.repeat.value_or(false);
  call.done = std::move(done);
  if (connected_) send(token, call);
  return token;
}

void ClientCore::send(std::uint64_t token, Call& call) {
  const std::size_t before = out_.size();
  const auto sent = encoder_.append(out_, call.frame, call.body);
  if (!sent) {
    static_cast<void>(session_.cancel(call.frame));
    finish(token, failed(sent.error()));
    return;
  }
  counters_->bytes_out += out_.size() - before;
  // A call is repeated at most once, after the first loss.
  call.repeat = call.repeat && call.stage == Stage::Unsent;
  call.stage = Stage::Sent;
  if (!call.repeat) std::string().swap(call.body);
}

void ClientCore::cancel(std::uint64_t call) {
  const auto found = calls_.find(call);
  if (found == calls_.end()) return;
  static_cast<void>(session_.cancel(found->second.frame));
  calls_.erase(found);
}

void ClientCore::finish(std::uint64_t token, Answer answer) {
  const auto found = calls_.find(token);
  if (found == calls_.end()) return;
  ended_.emplace_back(std::move(found->second.done), std::move(answer));
  calls_.erase(found);
}

void ClientCore::settle() {
  std::vector<std::pair<Completion, Answer>> ended;
  ended.swap(ended_);
  for (auto& [done, answer] : ended) {
    if (done) done(std::move(answer));
  }
}

void ClientCore::connected() {
  connected_ = true;
  heard_ = false;
  decoder_ = Decoder(*protocol_);
  decoder_.set_limits(settings_.limits);
  decoder_.set_verify_digest(settings_.verify_digest);
  decoder_.set_resync(settings_.resync);
  arriving_.whole();
  unwritten_ = 0;
  unread_since_.reset();
  beats_.clear();
  session_.reconnected();
  life_->connected();
  receivers_->connected();
  // In the order of the calls.
  std::vector<std::uint64_t> waiting;
  for (const auto& [token, call] : calls_) {
    if (call.stage != Stage::Sent) waiting.push_back(token);
  }
  std::sort(waiting.begin(), waiting.end());
  for (const std::uint64_t token : waiting) send(token, calls_.at(token));
}

std::optional<Loss> ClientCore::received(std::string_view bytes, Instant now) {
  counters_->bytes_in += bytes.size();
  arriving_.came(now);
  decoder_.push(bytes);
  for (;;) {
    auto next = decoder_.next();
    if (next && !*next) return std::nullopt;
    arriving_.whole();
    if (next) {
      heard_ = true;
      arrive(**next, now);
      continue;
    }
    ++counters_->bad_frames;
    if (next.error().is_fatal()) return Loss{LossKind::Frame, next.error().kind, {}};
    heard_ = true;
    arrive_broken(next.error(), now);
  }
}

Loss ClientCore::ended() const {
  if (const auto error = decoder_.finish()) return Loss{LossKind::Frame, error->kind, {}};
  return Loss{heard_ ? LossKind::Closed : LossKind::Unheard, {}, {}};
}

void ClientCore::arrive(const Frame& frame, Instant now) {
  const FrameId id = frame.header.frame;
  const bool is_report = !id.response && id.kind == protocol_->report_kind;
  if (is_report) {
    // An unreadable report is refused instead of acknowledged.
    if (const auto error = check_report(id.code, frame.data)) {
      ++counters_->reports_invalid;
      answer(id, protocol_->results.invalid, error->name());
      return;
    }
  }
  const Incoming incoming = session_.receive(id, frame.header.digest, now);
  switch (incoming.meaning) {
    case Meaning::Answer:
      ++counters_->answers;
      finish(incoming.token, std::string(frame.data));
      break;
    case Meaning::Late:
      ++counters_->late_answers;
      break;
    case Meaning::Report:
      report(frame, now);
      break;
    case Meaning::Repeated:
      ++counters_->repeated_reports;
      answer(id, protocol_->results.success);
      break;
    case Meaning::Command:
    case Meaning::Stream:
      // Apps handle no commands, and streams use the data port.
      answer(id, protocol_->results.protocol);
      break;
  }
}

void ClientCore::arrive_broken(const FrameError& error, Instant now) {
  if (!error.frame.response) {
    answer(error.frame, protocol_->results.protocol);
    return;
  }
  const Incoming incoming = session_.receive(error.frame, std::nullopt, now);
  if (incoming.meaning == Meaning::Answer) {
    ++counters_->answers;
    finish(incoming.token, failed(error));
  } else {
    ++counters_->late_answers;
  }
}

std::optional<BodyError> ClientCore::check_report(std::uint16_t code, std::string_view text) const {
  const Allowance allowance = settings_.limits.json();
  const OperationInfo* known = protocol_->find(OperationKind::Report, code);
  if (known == nullptr || !known->request) {
    const auto envelope = read_envelope(protocol_->request_envelope, text, allowance);
    if (!envelope) return envelope.error();
    return std::nullopt;
  }
  return check_enveloped(*known->request, protocol_->request_envelope, text, allowance);
}

void ClientCore::note_beat(std::uint16_t code, Instant now) {
  const OperationInfo* known = protocol_->find(OperationKind::Report, code);
  if (known == nullptr || !known->cadence || known->cadence->kind != CadenceKind::Every) return;
  const auto interval = known->cadence->time;
  const auto [last, is_first] = beats_.emplace(code, now);
  if (!is_first && now - last->second > interval + interval / 2) {
    ++counters_->reports_late;
  }
  last->second = now;
}

void ClientCore::report(const Frame& frame, Instant now) {
  const FrameId id = frame.header.frame;
  note_beat(id.code, now);
  const bool has_room = !closed_ && out_.size() + unwritten_ < kAcknowledgeUpTo;
  std::optional<std::uint64_t> missed;
  if (has_room) missed = receivers_->push({id.code, id.id, std::string(frame.data)});
  if (!missed) {
    ++counters_->reports_refused;
    return;
  }
  ++counters_->reports;
  counters_->reports_missed += *missed;
  session_.handed_on(id, frame.header.digest, now);
  answer(id, protocol_->results.success);
}

/// Sends a response with a result alone. Sends nothing if responses cannot carry the result.
void ClientCore::answer(FrameId id, const ResultText& result, std::string_view why) {
  const bool can_say = result.code == protocol_->results.success.code || protocol_->has_result();
  if (!can_say || out_.size() + unwritten_ >= kAcknowledgeUpTo) return;
  std::string text(result.text);
  if (!why.empty()) text.append(": ").append(why);
  id.response = true;
  const Envelope envelope{unix_ms(), result.code, std::move(text)};
  const std::size_t before = out_.size();
  // An envelope alone fits into any reasonable limit. Otherwise the robot repeats the request.
  static_cast<void>(
      encoder_.append(out_, id, write_envelope(protocol_->response_envelope, envelope)));
  counters_->bytes_out += out_.size() - before;
}

void ClientCore::lost(const Loss& why) {
  if (closed_) return;
  why_ = why;
  if (std::exchange(connected_, false)) receivers_->lost(why);
  life_->lost(why);
  end_calls(false, why);
}

void ClientCore::close(const Loss& why) {
  if (std::exchange(closed_, true)) return;
  connected_ = false;
  why_ = why;
  life_->close(why);
  end_calls(true, why);
  receivers_->close();
}

/// Ends the calls that must not be sent twice. Keeps the others for the next connection.
void ClientCore::end_calls(bool for_good, const Loss& why) {
  if (!for_good) out_.clear();
  const auto ends = [&](FrameId, Token token) {
    const auto found = calls_.find(token);
    if (found == calls_.end()) return true;
    Call& call = found->second;
    if (call.repeat && call.stage == Stage::Sent) call.stage = Stage::Again;
    return for_good || call.stage == Stage::Sent;
  };
  for (const auto& [frame, token] : session_.end_if(ends)) {
    const auto found = calls_.find(token);
    if (found == calls_.end()) continue;
    const bool unsent = found->second.stage == Stage::Unsent;
    finish(token, failed(unsent ? CallErrorKind::Closed : CallErrorKind::Lost, why));
  }
}

std::optional<Loss> ClientCore::advance(Instant now) {
  while (const auto due = session_.due(now)) {
    const auto found = calls_.find(due->token);
    if (due->again || found == calls_.end()) continue;
    ++counters_->timeouts;
    const bool unsent = found->second.stage == Stage::Unsent;
    finish(due->token, connected_ ? failed(CallErrorKind::Timeout)
                       : unsent   ? failed(CallErrorKind::NotConnected, why_)
                                  : failed(CallErrorKind::Lost, why_));
  }
  if (!connected_) return std::nullopt;
  const std::size_t received = decoder_.pending();
  if (const auto stalls = arriving_.deadline(received, now); stalls && *stalls <= now) {
    return Loss{LossKind::Stalled, {}, std::to_string(received) + " bytes have come"};
  }
  if (unread_since_ && detail::after(*unread_since_, settings_.stall_timeout) <= now) {
    return Loss{LossKind::Unread, {}, {}};
  }
  return std::nullopt;
}

std::optional<Instant> ClientCore::next_due(Instant now) {
  std::optional<Instant> due = session_.next_due();
  if (!connected_) return due;
  keep_earlier(due, arriving_.deadline(decoder_.pending(), now));
  if (unread_since_) keep_earlier(due, detail::after(*unread_since_, settings_.stall_timeout));
  return due;
}

void ClientCore::set_unwritten(std::size_t bytes, Instant now) {
  if (bytes == 0) {
    unread_since_.reset();
  } else if (bytes < unwritten_ || !unread_since_) {
    unread_since_ = now;
  }
  unwritten_ = bytes;
}

}  // namespace fc_runtime
