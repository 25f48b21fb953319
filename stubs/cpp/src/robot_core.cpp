#include "fc_runtime/robot_core.hpp"

namespace fc_runtime {

std::string_view name(AckOutcomeKind kind) noexcept {
  switch (kind) {
    case AckOutcomeKind::Acknowledged:
      return "acknowledged";
    case AckOutcomeKind::Refused:
      return "refused";
    case AckOutcomeKind::Invalid:
      return "invalid";
    case AckOutcomeKind::TimedOut:
      return "timed_out";
    case AckOutcomeKind::Dropped:
      return "dropped";
    case AckOutcomeKind::Closed:
      return "closed";
  }
  return "";
}

RobotCore::RobotCore(const Protocol& protocol, const RobotSettings& settings,
                     std::function<void(Request)> begin)
    : shared_(std::make_unique<detail::RobotShared>()) {
  shared_->protocol = &protocol;
  shared_->settings = settings;
  shared_->begin = std::move(begin);
}

detail::RobotPeer* RobotCore::find(ConnectionId id) const {
  const auto found = peers_.find(id);
  return found == peers_.end() ? nullptr : found->second.get();
}

std::optional<ConnectionId> RobotCore::connect(Instant now, std::vector<Effect> effects) {
  if (!takes_connections()) {
    ++shared_->counters.connections_refused;
    return std::nullopt;
  }
  ++shared_->counters.connections;
  const ConnectionId id = next_id_++;
  peers_.emplace(id, std::make_unique<detail::RobotPeer>(*shared_, id, std::move(effects), now));
  return id;
}

bool RobotCore::takes_connections() const {
  return !over_by_ && peers_.size() < shared_->settings.limits.connections;
}

void RobotCore::received(ConnectionId id, std::string_view bytes, Instant now) {
  if (auto* peer = find(id)) peer->received(bytes, now);
}

void RobotCore::ended(ConnectionId id) {
  if (auto* peer = find(id)) peer->deaf();
}

void RobotCore::closed(ConnectionId id) { peers_.erase(id); }

void RobotCore::finish(std::uint64_t handler, const Handled& handled, Instant now) {
  const auto found = shared_->handlers.find(handler);
  if (found == shared_->handlers.end()) {
    if (shared_->abandoned > 0) --shared_->abandoned;
    return;
  }
  if (auto* peer = find(found->second)) peer->finish(handler, handled, now);
}

std::size_t RobotCore::push(std::uint16_t code, std::string body, std::optional<ConnectionId> to,
                            Pushed done, Instant now) {
  const OperationInfo* known = shared_->protocol->find(OperationKind::Report, code);
  const AckPolicy usual = shared_->protocol->defaults.ack;
  const AckPolicy policy = known != nullptr ? known->ack.value_or(usual) : usual;
  const auto whole = std::make_shared<const std::string>(std::move(body));
  auto push = std::make_shared<detail::Push>();
  push->done = std::move(done);
  std::vector<detail::RobotPeer*> audience;
  for (const auto& [id, peer] : peers_) {
    if (!to || *to == id) audience.push_back(peer.get());
  }
  push->open = audience.size();
  if (audience.empty()) shared_->ended.push_back(push);
  for (auto* peer : audience) peer->push({code, policy, whole, push}, now);
  return audience.size();
}

std::size_t RobotCore::held(ConnectionId id) const {
  const auto* peer = find(id);
  return peer != nullptr ? peer->held() : 0;
}

std::size_t RobotCore::held_for_nobody() const {
  std::size_t counted = 0;
  for (const auto& [id, peer] : peers_) counted += peer->handled_bytes();
  const std::size_t all = *shared_->handled_bytes;
  // A handler may release its request between the two reads.
  return all > counted ? all - counted : 0;
}

bool RobotCore::is_heard(ConnectionId id) const {
  const auto* peer = find(id);
  return peer != nullptr && peer->is_heard();
}

void RobotCore::shutdown(std::chrono::milliseconds grace, Instant now) {
  over_by_ = detail::after(now, grace);
  for (const auto& [id, peer] : peers_) peer->drain();
}

void RobotCore::advance(Instant now) {
  if (over_by_ && *over_by_ <= now) cut_off_ = true;
  for (const auto& [id, peer] : peers_) {
    peer->advance(now);
    if (cut_off_) peer->kill();
  }
}

std::optional<Instant> RobotCore::next_due() const {
  std::optional<Instant> due = cut_off_ ? std::nullopt : over_by_;
  for (const auto& [id, peer] : peers_) {
    const auto other = peer->next_due();
    if (other && (!due || *other < *due)) due = other;
  }
  return due;
}

void RobotCore::settle() {
  std::vector<std::shared_ptr<detail::Push>> ended;
  ended.swap(shared_->ended);
  for (const auto& push : ended) {
    if (push->done) push->done(std::move(push->ended));
  }
}

bool RobotCore::wants_bytes(ConnectionId id) const {
  const auto* peer = find(id);
  return peer != nullptr && peer->wants_bytes();
}

std::string RobotCore::take_out(ConnectionId id) {
  auto* peer = find(id);
  return peer != nullptr ? peer->take_out() : std::string();
}

void RobotCore::set_unwritten(ConnectionId id, std::size_t bytes, Instant now) {
  if (auto* peer = find(id)) peer->set_unwritten(bytes, now);
}

bool RobotCore::is_done(ConnectionId id) const {
  const auto* peer = find(id);
  return peer == nullptr || peer->is_done();
}

std::vector<ConnectionId> RobotCore::connections() const {
  std::vector<ConnectionId> ids;
  ids.reserve(peers_.size());
  for (const auto& [id, peer] : peers_) ids.push_back(id);
  return ids;
}

bool RobotCore::is_over() const {
  return over_by_ && peers_.empty() && (cut_off_ || shared_->abandoned == 0);
}

}  // namespace fc_runtime
