#include "data_port.hpp"

#include <algorithm>

#include "clock.hpp"
#include "fc_runtime/envelope.hpp"

namespace fc_runtime::detail {

namespace {

/// Most frames that wait for one app, or for the robot, in addition to the current one.
constexpr std::size_t kFramesForRobot = 4;

}  // namespace

DataPort::DataPort(asio::io_context& io, const Protocol& protocol, const RobotSettings& settings,
                   ServerCounters& counters)
    : protocol_(&protocol),
      settings_(settings),
      encoder_(protocol),
      counters_(&counters),
      watching_(io),
      pacing_(io) {
  encoder_.set_gzip(settings.gzip);
  encoder_.set_frame_bytes(settings.limits.frame_bytes);
}

std::size_t DataPort::held_by(ConnectionId id, const Peer& peer) const {
  std::size_t held = peer.decoder.pending() + peer.link->unwritten();
  // Several apps share the memory of a frame.
  const auto share = [](const std::shared_ptr<const std::string>& frame) {
    return frame->size() / static_cast<std::size_t>(std::max(frame.use_count(), 1L));
  };
  for (const auto& frame : peer.queue) held += share(frame);
  for (const auto& waiting : peer.waiting) held += share(waiting.frame);
  const std::lock_guard lock(mutex_);
  for (const AppStream& stream : inbox_) {
    if (stream.connection == id) held += stream.frame.data.size();
  }
  return held;
}

std::size_t DataPort::held() const {
  std::size_t held = 0;
  for (const auto& [id, peer] : peers_) held += held_by(id, peer);
  return held;
}

std::optional<std::pair<ConnectionId, std::size_t>> DataPort::largest() const {
  std::optional<std::pair<ConnectionId, std::size_t>> most;
  for (const auto& [id, peer] : peers_) {
    const std::size_t held = held_by(id, peer);
    if (!most || held > most->second) most = {id, held};
  }
  return most;
}

void DataPort::evict(ConnectionId id) {
  end(id);
  const std::lock_guard held(mutex_);
  const auto is_its = [id](const AppStream& stream) { return stream.connection == id; };
  inbox_.erase(std::remove_if(inbox_.begin(), inbox_.end(), is_its), inbox_.end());
}

void DataPort::connect(ConnectionId id, const std::string& address, std::shared_ptr<Link> link,
                       const std::vector<ConnectionId>& commands_from_there) {
  Peer peer{address, std::move(link), Decoder(*protocol_), commands_from_there, {}, {},
            false,   false,           clock_now(),         clock_now()};
  peer.decoder.set_limits(settings_.limits);
  peer.decoder.set_verify_digest(settings_.verify_digest);
  peer.decoder.set_resync(settings_.resync);
  peer.link->on_bytes = [this, id](std::string_view bytes) { received(id, bytes); };
  peer.link->on_end = [this, id](const std::error_code&) { end(id); };
  peer.link->on_written = [this, id] { go_on(id); };
  ++counters_->data_connections;
  const auto link_of = peer.link;
  peers_.emplace(id, std::move(peer));
  link_of->read();
  if (!std::exchange(is_watching_, true)) watch();
}

void DataPort::saw(ConnectionId command, const std::string& address) {
  for (auto& [id, peer] : peers_) {
    if (peer.address == address) peer.owners.push_back(command);
  }
}

void DataPort::received(ConnectionId id, std::string_view bytes) {
  const auto found = peers_.find(id);
  if (found == peers_.end()) return;
  found->second.is_heard = true;
  found->second.last_read = clock_now();
  counters_->bytes_in += bytes.size();
  found->second.decoder.push(bytes);
  take_frames(id, found->second);
  on_held();
}

void DataPort::take_frames(ConnectionId id, Peer& peer) {
  for (;;) {
    if (rest(peer)) return;
    std::unique_lock held(mutex_);
    if (is_wanted_ && inbox_.size() >= kFramesForRobot) {
      peer.link->pause();
      return;
    }
    const auto next = peer.decoder.next();
    if (next && !*next) break;
    if (!next) ++counters_->bad_frames;
    if (!next && next.error().is_fatal()) {
      held.unlock();
      end(id);
      return;
    }
    FrameId frame = next ? (*next)->header.frame : next.error().frame;
    if (next) pace(peer.pace.inflated(surplus_of(**next, protocol_->header.length), clock_now()));
    if (next && frame.kind == protocol_->stream_kind && frame.response) continue;
    if (next && frame.kind == protocol_->stream_kind) {
      ++counters_->stream_frames_in;
      if (is_wanted_) {
        inbox_.push_back({id, {frame.code, frame.id, std::string((*next)->data)}});
        came_.notify_all();
      } else {
        ++counters_->stream_frames_dropped;
      }
      continue;
    }
    pace(peer.pace.unusable(clock_now()));
    if (!frame.response && protocol_->has_result()) {
      frame.response = true;
      const ResultText& result = protocol_->results.protocol;
      const Envelope envelope{unix_ms(), result.code, std::string(result.text)};
      std::string bytes;
      const auto written =
          encoder_.append(bytes, frame, write_envelope(protocol_->response_envelope, envelope));
      if (written && peer.link->unwritten() < settings_.limits.frame_bytes) {
        counters_->bytes_out += bytes.size();
        peer.link->send(std::move(bytes));
      }
    }
  }
  peer.link->read();
}

void DataPort::send(std::optional<ConnectionId> to, std::uint16_t code, std::uint32_t id,
                    const std::string& data, StreamSent sent) {
  std::vector<ConnectionId> audience;
  bool is_ambiguous = false;
  for (const auto& [connection, peer] : peers_) {
    const auto& owners = peer.owners;
    const bool owns = to && std::find(owners.begin(), owners.end(), *to) != owners.end();
    if (!to || *to == connection || (owns && owners.size() == 1)) audience.push_back(connection);
    is_ambiguous = is_ambiguous || (owns && owners.size() > 1);
  }
  if (to && audience.empty()) {
    sent(PushError{is_ambiguous ? PushErrorKind::Ambiguous : PushErrorKind::NoConnection, {}});
    return;
  }
  auto frame = std::make_shared<std::string>();
  if (!encoder_.append(*frame, {false, protocol_->stream_kind, code, id}, data)) {
    sent(PushError{PushErrorKind::Frame, {}});
    return;
  }
  const auto sending = std::make_shared<Sending>();
  sending->open = audience.size();
  sending->sent = std::move(sent);
  if (audience.empty()) sending->sent(std::size_t{0});
  for (const ConnectionId connection : audience) {
    peers_.at(connection)
        .waiting.push_back({frame, sending, after(clock_now(), settings_.stall_timeout)});
    go_on(connection);
  }
  on_held();
}

void DataPort::write(Peer& peer, const std::string& frame) {
  counters_->bytes_out += frame.size();
  ++counters_->stream_frames_out;
  peer.link->send(frame);
}

void DataPort::pace(bool must_rest) {
  if (must_rest) ++counters_->connections_paced;
}

bool DataPort::rest(Peer& peer) {
  if (peer.pace.until() <= clock_now()) return false;
  peer.link->pause();
  if (pacing_.expiry() < clock_now() || peer.pace.until() < pacing_.expiry()) {
    pacing_.expires_at(peer.pace.until());
    pacing_.async_wait([this](std::error_code error) {
      if (!error) resume();
    });
  }
  return true;
}

void DataPort::settle(const std::shared_ptr<Sending>& sending, bool taken) {
  if (taken) ++sending->taken;
  if (--sending->open == 0) sending->sent(sending->taken);
}

/// Writes the next queued frame, and takes up senders that waited for space.
void DataPort::go_on(ConnectionId id) {
  const auto found = peers_.find(id);
  if (found == peers_.end()) return;
  Peer& peer = found->second;
  peer.last_written = clock_now();
  if (peer.link->unwritten() == 0 && !peer.queue.empty()) {
    write(peer, *peer.queue.front());
    peer.queue.pop_front();
  }
  std::vector<std::shared_ptr<Sending>> taken;
  while (!peer.waiting.empty() && peer.queue.size() < kFramesForRobot) {
    Waiting waiting = std::move(peer.waiting.front());
    peer.waiting.pop_front();
    if (peer.queue.empty() && peer.link->unwritten() == 0) {
      write(peer, *waiting.frame);
    } else {
      peer.queue.push_back(std::move(waiting.frame));
    }
    taken.push_back(std::move(waiting.sending));
  }
  const bool is_done = peer.is_draining && peer.queue.empty() && peer.link->unwritten() == 0;
  for (const auto& sending : taken) settle(sending, true);
  if (is_done) end(id);
}

void DataPort::end(ConnectionId id) {
  const auto found = peers_.find(id);
  if (found == peers_.end()) return;
  const Peer peer = std::move(found->second);
  peers_.erase(found);
  peer.link->finish();
  for (const auto& waiting : peer.waiting) settle(waiting.sending, false);
}

void DataPort::drain() {
  std::vector<ConnectionId> ids;
  for (auto& [id, peer] : peers_) {
    peer.is_draining = true;
    ids.push_back(id);
  }
  for (const ConnectionId id : ids) go_on(id);
}

void DataPort::close() {
  while (!peers_.empty()) end(peers_.begin()->first);
  watching_.cancel();
  pacing_.cancel();
  const std::lock_guard held(mutex_);
  is_over_ = true;
  came_.notify_all();
}

std::optional<AppStream> DataPort::next(std::chrono::milliseconds wait,
                                        const std::function<void()>& resume) {
  std::unique_lock held(mutex_);
  is_wanted_ = true;
  came_.wait_for(held, bounded(wait), [this] { return is_over_ || !inbox_.empty(); });
  if (inbox_.empty()) return std::nullopt;
  const bool was_full = inbox_.size() >= kFramesForRobot;
  AppStream first = std::move(inbox_.front());
  inbox_.pop_front();
  held.unlock();
  if (was_full) resume();
  return first;
}

void DataPort::resume() {
  std::vector<ConnectionId> ids;
  for (const auto& [id, peer] : peers_) ids.push_back(id);
  for (const ConnectionId id : ids) {
    const auto found = peers_.find(id);
    if (found != peers_.end()) take_frames(id, found->second);
  }
}

/// Checks periodically that the connections make progress.
void DataPort::watch() {
  const auto shorter = bounded(std::min(settings_.stall_timeout, settings_.header_timeout));
  watching_.expires_after(shorter / 4 + std::chrono::milliseconds(1));
  watching_.async_wait([this](std::error_code error) {
    if (error) return;
    const Instant now = clock_now();
    std::vector<ConnectionId> late;
    bool is_full = false;
    {
      const std::lock_guard held(mutex_);
      is_full = is_wanted_ && inbox_.size() >= kFramesForRobot;
    }
    for (const auto& [id, peer] : peers_) {
      const std::size_t pending = peer.decoder.pending();
      const auto patience =
          pending < protocol_->header.length ? settings_.header_timeout : settings_.stall_timeout;
      const bool stalls = pending > 0 && !is_full && after(peer.last_read, patience) <= now;
      const bool unread =
          peer.link->unwritten() > 0 && after(peer.last_written, settings_.stall_timeout) <= now;
      if (stalls || unread) late.push_back(id);
    }
    counters_->connections_timed_out += late.size();
    for (const ConnectionId id : late) end(id);
    watch();
  });
}

}  // namespace fc_runtime::detail
