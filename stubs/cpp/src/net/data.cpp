#include "data.hpp"

#include <algorithm>

#include "clock.hpp"

namespace fc_runtime {

std::string_view name(DataErrorKind kind) noexcept {
  switch (kind) {
    case DataErrorKind::NotConnected:
      return "not_connected";
    case DataErrorKind::Closed:
      return "closed";
    case DataErrorKind::Lost:
      return "lost";
    case DataErrorKind::Frame:
      return "frame";
    case DataErrorKind::Invalid:
      return "invalid_content";
    case DataErrorKind::Timeout:
      return "timeout";
  }
  return "";
}

std::string to_string(const DataError& error) {
  std::string text(name(error.kind));
  if (error.loss) text += ": " + to_string(*error.loss);
  if (error.frame) text += ": " + to_string(*error.frame);
  if (error.body) text += ": " + to_string(*error.body);
  return text;
}

namespace detail {

namespace {

/// Most frames that wait for the app, or for one of its subscriptions.
constexpr std::size_t kFramesForApp = 4;

DataError failed(DataErrorKind kind, const Loss& why) { return {kind, why, {}, {}}; }

}  // namespace

std::shared_ptr<DataImpl> open_data(ConnectionImpl& commands, std::shared_ptr<void> handle) {
  auto impl = std::make_shared<DataImpl>(commands);
  impl->post_start();
  return {impl.get(), [handle = std::move(handle), impl](DataImpl*) { impl->post_close(); }};
}

DataImpl::DataImpl(ConnectionImpl& commands)
    : commands_(&commands),
      dialler_(
          commands.io(), commands.config().host.value_or(std::string(commands.protocol().host)),
          commands.config().data_port.value_or(commands.protocol().data_port), commands.config()),
      watching_(commands.io()),
      encoder_(commands.protocol()) {
  encoder_.set_gzip(commands.config().gzip);
  encoder_.set_frame_bytes(commands.limits().frame_bytes);
}

void DataImpl::post_start() {
  commands_->post([self = shared_from_this()] { self->commands_->attend(self); });
}

void DataImpl::post_close() {
  commands_->post([self = shared_from_this()] { self->close({LossKind::Here, {}, {}}); });
}

void DataImpl::commands_connected() {
  if (is_closed_) return;
  if (link_) down({LossKind::Renewed, {}, {}}, false);
  dialler_.cancel();
  dialler_.ended(true);
  dial();
}

void DataImpl::dial() {
  const bool tries = dialler_.dial([this](Result<std::shared_ptr<Link>, Loss> link) {
    if (link) {
      up(*std::move(link));
      return;
    }
    life_.lost(link.error());
    dial();
  });
  if (!tries) close(life_.now().why);
}

void DataImpl::up(std::shared_ptr<Link> link) {
  link_ = std::move(link);
  is_heard_ = false;
  decoder_.emplace(commands_->protocol());
  decoder_->set_limits(commands_->limits());
  decoder_->set_verify_digest(commands_->config().verify_digest);
  decoder_->set_resync(commands_->config().resync);
  last_read_ = last_written_ = clock_now();
  unwritten_ = 0;
  link_->on_bytes = [this](std::string_view bytes) { received(bytes); };
  link_->on_end = [this](const std::error_code& error) {
    const auto inside = decoder_->finish();
    Loss why{is_heard_ ? LossKind::Closed : LossKind::Unheard, {}, {}};
    const std::string& fault = link_->fault();
    if (error != asio::error::eof) {
      why = {LossKind::Broken, {}, fault.empty() ? error.message() : fault};
    }
    if (error == asio::error::eof && inside) why = {LossKind::Frame, inside->kind, {}};
    down(why, false);
    dial();
  };
  link_->on_written = [this] {
    last_written_ = clock_now();
    send_next();
  };
  {
    const std::lock_guard held(mutex_);
    has_sent_ = false;
    life_.connected();
    changed_.notify_all();
  }
  link_->read();
  send_next();
  watch();
}

void DataImpl::received(std::string_view bytes) {
  last_read_ = clock_now();
  decoder_->push(bytes);
  take_frames();
}

/// Takes frames from the decoder until the inbox is full. Then the client stops reading from the
/// robot.
void DataImpl::take_frames() {
  for (;;) {
    std::unique_lock held(mutex_);
    if (inbox_.size() >= kFramesForApp) {
      if (link_) link_->pause();
      return;
    }
    auto next = decoder_->next();
    if (next && !*next) break;
    is_heard_ = true;
    if (next) {
      const Frame& frame = **next;
      const FrameId id = frame.header.frame;
      if (id.response || id.kind != commands_->protocol().stream_kind) continue;
      give(id.code, StreamFrame{id.code, id.id, std::string(frame.data)});
    } else if (!next.error().is_fatal()) {
      give(next.error().frame.code, DataError{DataErrorKind::Frame, {}, next.error(), {}});
    } else {
      held.unlock();
      down({LossKind::Frame, next.error().kind, {}}, false);
      dial();
      return;
    }
    changed_.notify_all();
  }
  if (link_) link_->read();
}

/// Gives a frame or its error to the subscribers of its code, or else to `next`. Needs the lock.
void DataImpl::give(std::uint16_t code, const Result<StreamFrame, DataError>& frame) {
  bool is_taken = false;
  bool are_any = false;
  for (const auto& weak : subscriptions_) {
    const auto subscribed = weak.lock();
    are_any = are_any || subscribed;
    if (!subscribed || subscribed->code != code) continue;
    is_taken = true;
    queue(*subscribed, frame);
  }
  if (!is_taken && (is_asked_ || !are_any)) inbox_.push_back(frame);
}

void DataImpl::queue(Subscribed& subscribed, const Result<StreamFrame, DataError>& frame) {
  if (subscribed.inbox.size() >= kFramesForApp) {
    subscribed.inbox.pop_front();
    ++subscribed.missed;
  }
  subscribed.inbox.push_back(frame);
}

std::shared_ptr<Subscribed> DataImpl::subscribe(std::uint16_t code) {
  auto subscribed = std::make_shared<Subscribed>();
  subscribed->code = code;
  std::unique_lock held(mutex_);
  const auto is_gone = [](const std::weak_ptr<Subscribed>& it) { return it.expired(); };
  subscriptions_.erase(std::remove_if(subscriptions_.begin(), subscriptions_.end(), is_gone),
                       subscriptions_.end());
  subscriptions_.push_back(subscribed);
  // Frames that arrived before the first subscription no longer block reading from the robot.
  const bool was_full = !is_asked_ && inbox_.size() >= kFramesForApp;
  if (was_full) inbox_.clear();
  held.unlock();
  if (was_full) {
    commands_->post([self = shared_from_this()] {
      if (self->link_) self->take_frames();
    });
  }
  return subscribed;
}

Result<StreamFrame, DataError> DataImpl::next_of(Subscribed& subscribed,
                                                 std::chrono::milliseconds wait) {
  std::unique_lock held(mutex_);
  changed_.wait_for(held, bounded(wait), [&] { return !subscribed.inbox.empty() || is_over(); });
  if (!subscribed.inbox.empty()) {
    Result<StreamFrame, DataError> first = std::move(subscribed.inbox.front());
    subscribed.inbox.pop_front();
    return first;
  }
  return none();
}

bool DataImpl::is_over() const { return life_.now().status == ConnectionStatus::Closed; }

/// Returns the error of a receiver without a frame.
DataError DataImpl::none() const {
  const ConnectionState state = life_.now();
  if (state.status == ConnectionStatus::Closed) return failed(DataErrorKind::Closed, state.why);
  return DataError{DataErrorKind::Timeout, {}, {}, {}};
}

std::uint64_t DataImpl::missed_by(const Subscribed& subscribed) {
  const std::lock_guard held(mutex_);
  return subscribed.missed;
}

void DataImpl::down(const Loss& why, bool for_good) {
  if (link_) {
    const auto link = std::exchange(link_, nullptr);
    for_good ? link->finish() : link->close();
  }
  watching_.cancel();
  dialler_.ended(is_heard_);
  const std::lock_guard held(mutex_);
  const bool was_there = life_.now().status == ConnectionStatus::Connected;
  for_good ? life_.close(why) : life_.lost(why);
  if (was_there && !for_good) {
    bool are_any = false;
    for (const auto& weak : subscriptions_) {
      const auto subscribed = weak.lock();
      are_any = are_any || subscribed;
      if (subscribed) queue(*subscribed, failed(DataErrorKind::Lost, why));
    }
    if (is_asked_ || !are_any) inbox_.emplace_back(failed(DataErrorKind::Lost, why));
    if (has_sent_) untold_loss_ = why;
  }
  // Frames in transit may have arrived. The others are sent over the next connection.
  while (!sending_.empty() && (for_good || sending_.front()->is_begun)) {
    Sending& first = *sending_.front();
    first.ended.emplace(failed(first.is_begun ? DataErrorKind::Lost : DataErrorKind::Closed, why));
    if (first.is_begun) untold_loss_.reset();
    sending_.pop_front();
  }
  changed_.notify_all();
}

void DataImpl::close(const Loss& why) {
  if (std::exchange(is_closed_, true)) return;
  dialler_.cancel();
  down(why, true);
}

void DataImpl::send_next() {
  if (!link_) return;
  const std::lock_guard held(mutex_);
  unwritten_ = link_->unwritten();
  while (!sending_.empty() && unwritten_ == 0) {
    Sending& first = *sending_.front();
    if (first.is_begun) {
      first.ended.emplace(Done{});
    } else if (const auto loss = std::exchange(untold_loss_, std::nullopt)) {
      first.ended.emplace(failed(DataErrorKind::Lost, *loss));
    } else if (!first.is_given_up) {
      first.is_begun = true;
      has_sent_ = true;
      last_written_ = clock_now();
      link_->send(std::move(first.bytes));
      unwritten_ = link_->unwritten();
      return;
    }
    sending_.pop_front();
    changed_.notify_all();
  }
}

/// Checks periodically that the connection makes progress.
void DataImpl::watch() {
  const auto patience = bounded(commands_->config().stall_timeout);
  watching_.expires_after(patience / 4 + std::chrono::milliseconds(1));
  watching_.async_wait([this, patience](std::error_code error) {
    if (error || !link_) return;
    const Instant now = clock_now();
    bool is_full = false;
    {
      const std::lock_guard held(mutex_);
      is_full = inbox_.size() >= kFramesForApp;
    }
    if (decoder_->pending() > 0 && !is_full && after(last_read_, patience) <= now) {
      down({LossKind::Stalled, {}, std::to_string(decoder_->pending()) + " bytes have come"},
           false);
      dial();
    } else if (link_->unwritten() > 0 && after(last_written_, patience) <= now) {
      down({LossKind::Unread, {}, {}}, false);
      dial();
    } else {
      watch();
    }
  });
}

Result<Done, DataError> DataImpl::wait_for_connection() {
  std::unique_lock held(mutex_);
  changed_.wait_for(held, bounded(commands_->settings().call_timeout),
                    [this] { return life_.now().status != ConnectionStatus::Connecting; });
  const ConnectionState state = life_.now();
  if (state.status == ConnectionStatus::Connected) return Done{};
  return failed(state.status == ConnectionStatus::Closed ? DataErrorKind::Closed
                                                         : DataErrorKind::NotConnected,
                state.why);
}

Result<StreamFrame, DataError> DataImpl::next(std::chrono::milliseconds wait) {
  std::unique_lock held(mutex_);
  is_asked_ = true;
  changed_.wait_for(held, bounded(wait), [this] { return !inbox_.empty() || is_over(); });
  if (inbox_.empty()) return none();
  const bool was_full = inbox_.size() >= kFramesForApp;
  Result<StreamFrame, DataError> first = std::move(inbox_.front());
  inbox_.pop_front();
  held.unlock();
  if (was_full) {
    commands_->post([self = shared_from_this()] {
      if (self->link_) self->take_frames();
    });
  }
  return first;
}

Result<Done, DataError> DataImpl::send(std::uint16_t code, std::uint32_t id,
                                       std::string_view data) {
  const auto sending = std::make_shared<Sending>();
  std::unique_lock held(mutex_);
  const FrameId frame{false, commands_->protocol().stream_kind, code, id};
  if (const auto written = encoder_.append(sending->bytes, frame, data); !written) {
    return DataError{DataErrorKind::Frame, {}, written.error(), {}};
  }
  if (is_over()) return none();
  sending_.push_back(sending);
  commands_->post([self = shared_from_this()] { self->send_next(); });
  const auto is_ended = [&] { return sending->ended.has_value(); };
  changed_.wait_for(held, bounded(commands_->settings().call_timeout),
                    [&] { return is_ended() || sending->is_begun; });
  if (!is_ended() && !sending->is_begun) {
    sending->is_given_up = true;
    return failed(DataErrorKind::NotConnected, life_.now().why);
  }
  changed_.wait(held, is_ended);
  return *sending->ended;
}

}  // namespace detail

DataConnection::DataConnection(std::shared_ptr<detail::DataImpl> impl) : impl_(std::move(impl)) {}

Subscription::Subscription(std::shared_ptr<detail::DataImpl> impl,
                           std::shared_ptr<detail::Subscribed> subscribed)
    : impl_(std::move(impl)), subscribed_(std::move(subscribed)) {}

Result<StreamFrame, DataError> Subscription::next(std::chrono::milliseconds wait) const {
  return impl_->next_of(*subscribed_, wait);
}

std::uint64_t Subscription::missed() const { return impl_->missed_by(*subscribed_); }

Subscription DataConnection::subscribe(std::uint16_t code) const {
  return {impl_, impl_->subscribe(code)};
}

ConnectionState DataConnection::state() const { return impl_->life().now(); }

ConnectionStates DataConnection::states() const {
  return ConnectionStates({impl_, &impl_->life()});
}

Allowance DataConnection::allowance() const { return impl_->allowance(); }

Result<Done, DataError> DataConnection::connected() const { return impl_->wait_for_connection(); }

Result<StreamFrame, DataError> DataConnection::next(std::chrono::milliseconds wait) const {
  return impl_->next(wait);
}

Result<Done, DataError> DataConnection::send(std::uint16_t code, std::uint32_t id,
                                             std::string_view data) const {
  return impl_->send(code, id, data);
}

}  // namespace fc_runtime
