#include "connection.hpp"

#include <asio/post.hpp>
#include <ctime>

#include "clock.hpp"
#include "data.hpp"
#include "settings.hpp"
#include "waiting.hpp"

namespace fc_runtime {

namespace detail {

namespace {

ClientSettings filled_in(const Protocol& protocol, const ClientConfig& config) {
  ClientSettings settings;
  settings.limits = config.limits.value_or(protocol.defaults.limits);
  settings.call_timeout = config.call_timeout.value_or(protocol.defaults.call_timeout);
  settings.stall_timeout = config.stall_timeout;
  settings.queued_bytes = config.queued_bytes.value_or(settings.limits.inflated_bytes);
  settings.first_id = config.first_id.value_or(first_id_now());
  settings.gzip = config.gzip;
  settings.verify_digest = config.verify_digest;
  settings.resync = config.resync;
  return settings;
}

}  // namespace

/// Returns the local time of day, so that a restarted peer does not reuse its ids.
std::uint32_t first_id_now() {
  const std::int64_t now = unix_ms();
  const std::time_t seconds = now / 1000;
  std::tm local{};
  localtime_r(&seconds, &local);
  const auto of_day = ((local.tm_hour * 60 + local.tm_min) * 60 + local.tm_sec) * 1000;
  return static_cast<std::uint32_t>(of_day + now % 1000);
}

ConnectionImpl::ConnectionImpl(const Protocol& protocol, const ClientConfig& config)
    : protocol_(&protocol),
      config_(config),
      settings_(filled_in(protocol, config)),
      logger_(config.log, protocol.name),
      core_(protocol, settings_),
      work_(asio::make_work_guard(io_)),
      dialler_(io_, config.host.value_or(std::string(protocol.host)),
               config.command_port.value_or(protocol.command_port), config),
      timer_(io_) {}

void ConnectionImpl::start(std::function<void(std::optional<Loss>)> first) {
  first_ = std::move(first);
  asio::post(io_, [this] {
    if (auto fault = fault_of(config_)) {
      close(Loss{LossKind::Settings, {}, *std::move(fault)});
    } else {
      dial();
    }
  });
  // The thread owns the connection that it works on.
  thread_ = std::thread([self = shared_from_this()] {
    self->own_ = std::this_thread::get_id();
    self->io_.run();
  });
}

void ConnectionImpl::post(std::function<void()> work) {
  {
    const std::lock_guard held(posted_mutex_);
    posted_.push_back(std::move(work));
    // The first caller posts the work. Calls that arrive until then are sent with one write.
    if (posted_.size() > 1) return;
  }
  asio::post(io_, [this] { work_off(); });
}

void ConnectionImpl::work_off() {
  std::vector<std::function<void()>> posted;
  {
    const std::lock_guard held(posted_mutex_);
    posted.swap(posted_);
  }
  for (const auto& work : posted) work();
  after_work();
}

void ConnectionImpl::stop() {
  asio::post(io_, [this] {
    close(Loss{LossKind::Here, {}, {}});
    work_.reset();
  });
  if (is_own_thread()) {
    thread_.detach();
  } else if (thread_.joinable()) {
    thread_.join();
  }
}

void ConnectionImpl::dial() {
  const bool tries =
      dialler_.dial([this](Result<std::shared_ptr<Link>, Loss> link) { dialled(std::move(link)); });
  if (!tries) close(core_.life().now().why);
}

void ConnectionImpl::dialled(Result<std::shared_ptr<Link>, Loss> link) {
  const auto first = std::exchange(first_, nullptr);
  if (!link) {
    const Loss why = link.error();
    if (first) {
      close(why);
      first(why);
      return;
    }
    core_.lost(why);
    after_work();
    dial();
    return;
  }
  link_ = *std::move(link);
  link_->on_bytes = [this](std::string_view bytes) {
    if (const auto why = core_.received(bytes, clock_now())) {
      down(*why);
    } else {
      after_work();
    }
  };
  link_->on_end = [this](const std::error_code& error) {
    const bool is_reset = error == asio::error::connection_reset ||
                          error == asio::error::broken_pipe ||
                          error == asio::error::connection_aborted;
    if (error == asio::error::eof) {
      down(core_.ended());
    } else if (is_reset && !core_.is_heard()) {
      down({LossKind::Unheard, {}, {}});
    } else {
      const std::string& fault = link_->fault();
      down({LossKind::Broken, {}, fault.empty() ? error.message() : fault});
    }
  };
  link_->on_written = [this] { core_.set_unwritten(link_->unwritten(), clock_now()); };
  core_.connected();
  after_work();
  link_->read();
  if (first) first(std::nullopt);
  tell([](Companion& companion) { companion.commands_connected(); });
}

void ConnectionImpl::down(const Loss& why) {
  if (link_) std::exchange(link_, nullptr)->close();
  if (is_closed_) return;
  dialler_.ended(core_.is_heard());
  if (config_.reconnect) {
    core_.lost(why);
    after_work();
    dial();
  } else {
    close(why);
  }
}

void ConnectionImpl::close(const Loss& why) {
  if (std::exchange(is_closed_, true)) return;
  dialler_.cancel();
  core_.close(why);
  after_work();
  if (link_) std::exchange(link_, nullptr)->finish();
  timer_.cancel();
  tell([&why](Companion& companion) { companion.commands_closed(why); });
  if (const auto first = std::exchange(first_, nullptr)) first(why);
}

std::uint64_t ConnectionImpl::call(std::uint16_t code, std::string body, const CallOptions& options,
                                   Completion done) {
  return core_.call(code, std::move(body), options, std::move(done), clock_now());
}

void ConnectionImpl::cancel(std::uint64_t call) { core_.cancel(call); }

void ConnectionImpl::after_work() {
  in_flight_ = core_.in_flight();
  core_.settle();
  if (link_) {
    std::string out = core_.take_out();
    if (!out.empty()) link_->send(std::move(out));
    core_.set_unwritten(link_->unwritten(), clock_now());
  }
  arm();
}

void ConnectionImpl::arm() {
  const auto due = core_.next_due(clock_now());
  if (!due || is_closed_) return;
  // A timer that fires earlier arms itself again.
  if (armed_ && *armed_ <= *due) return;
  armed_ = due;
  timer_.expires_at(*due);
  timer_.async_wait([this](std::error_code error) {
    if (error) return;
    armed_.reset();
    if (const auto why = core_.advance(clock_now())) {
      down(*why);
    } else {
      after_work();
    }
  });
}

void ConnectionImpl::attend(const std::shared_ptr<Companion>& companion) {
  companions_.push_back(companion);
  const ConnectionState state = core_.life().now();
  if (state.status == ConnectionStatus::Connected) companion->commands_connected();
  if (state.status == ConnectionStatus::Closed) companion->commands_closed(state.why);
}

void ConnectionImpl::tell(const std::function<void(Companion&)>& what) {
  auto all = std::exchange(companions_, {});
  for (const auto& weak : all) {
    const auto companion = weak.lock();
    if (!companion) continue;
    companions_.push_back(weak);
    what(*companion);
  }
}

}  // namespace detail

/// Keeps the connection open during its lifetime.
class Connection::Handle {
 public:
  explicit Handle(std::shared_ptr<detail::ConnectionImpl> shared) : impl(std::move(shared)) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() { impl->stop(); }

  std::shared_ptr<detail::ConnectionImpl> impl;
};

Connection::Connection(std::shared_ptr<Handle> handle) : handle_(std::move(handle)) {}

Result<Connection, Loss> Connection::connect(const Protocol& protocol, const ClientConfig& config) {
  auto impl = std::make_shared<detail::ConnectionImpl>(protocol, config);
  const auto first = std::make_shared<detail::Waiting<std::optional<Loss>>>();
  impl->start([first](std::optional<Loss> why) { first->give(std::move(why)); });
  Connection connection(std::make_shared<Handle>(std::move(impl)));
  if (auto why = first->take()) return *std::move(why);
  return connection;
}

Connection Connection::connect_lazy(const Protocol& protocol, const ClientConfig& config) {
  auto impl = std::make_shared<detail::ConnectionImpl>(protocol, config);
  impl->start(nullptr);
  return Connection(std::make_shared<Handle>(std::move(impl)));
}

std::shared_ptr<detail::CallEnd> Connection::end_of(std::uint16_t code) const {
  const auto& impl = handle_->impl;
  const CallHook& hook = impl->config().on_call;
  if (!hook) return nullptr;
  const OperationInfo* known = protocol().find(OperationKind::Command, code);
  // The protocol outlives the connection.
  const std::string_view operation = known == nullptr ? "unknown" : known->name;
  const auto begun = std::chrono::steady_clock::now();
  return std::make_shared<detail::CallEnd>([weak = std::weak_ptr<detail::ConnectionImpl>(impl),
                                            hook, operation, begun](std::string_view result) {
    const EndedCall call{operation, result, std::chrono::steady_clock::now() - begun};
    try {
      hook(call);
    } catch (...) {
      if (const auto there = weak.lock()) there->logger().write_thrown("`on_call`");
    }
  });
}

Answer Connection::call_body(std::uint16_t code, std::string body,
                             const CallOptions& options) const {
  const auto end = end_of(code);
  Answer answer = send_body(code, std::move(body), options);
  if (end) end->tell(answer ? "success" : answer.error().name());
  return answer;
}

PendingCall Connection::call_body_async(std::uint16_t code, std::string body, Completion done,
                                        const CallOptions& options) const {
  if (auto end = end_of(code)) {
    done = [end = std::move(end), done = std::move(done)](Answer answer) {
      end->tell(answer ? "success" : answer.error().name());
      if (done) done(std::move(answer));
    };
  }
  return send_body_async(code, std::move(body), std::move(done), options);
}

Answer Connection::send_body(std::uint16_t code, std::string body,
                             const CallOptions& options) const {
  if (handle_->impl->is_own_thread()) {
    // On its own thread, the wait would never end.
    CallError error;
    error.kind = CallErrorKind::Busy;
    return error;
  }
  const auto answer = std::make_shared<detail::Waiting<Answer>>();
  auto* impl = handle_->impl.get();
  impl->post([impl, answer, code, body = std::move(body), options]() mutable {
    impl->call(code, std::move(body), options,
               [answer](Answer given) { answer->give(std::move(given)); });
  });
  return answer->take();
}

PendingCall Connection::send_body_async(std::uint16_t code, std::string body, Completion done,
                                        const CallOptions& options) const {
  // Used only on the thread of the connection.
  const auto token = std::make_shared<std::uint64_t>(0);
  const auto impl = handle_->impl;
  Completion guarded;
  if (done) {
    guarded = [impl = impl.get(), code, done = std::move(done)](Answer answer) {
      try {
        done(std::move(answer));
      } catch (...) {
        impl->logger().write_thrown("the callback of " +
                                    detail::command_name(impl->protocol(), code));
      }
    };
  }
  impl->post([impl = impl.get(), token, code, body = std::move(body), done = std::move(guarded),
              options]() mutable {
    *token = impl->call(code, std::move(body), options, std::move(done));
  });
  return PendingCall([weak = std::weak_ptr<detail::ConnectionImpl>(impl), token] {
    if (const auto there = weak.lock()) {
      there->post([impl = there.get(), token] { impl->cancel(*token); });
    }
  });
}

DataConnection Connection::data() const {
  return DataConnection(detail::open_data(*handle_->impl, handle_));
}

std::shared_ptr<ReportQueue> Connection::reports(std::optional<std::uint16_t> code) const {
  return handle_->impl->receivers().enter(code);
}

ConnectionState Connection::state() const { return handle_->impl->life().now(); }

ConnectionStates Connection::states() const {
  return ConnectionStates({handle_->impl, &handle_->impl->life()});
}

std::optional<Loss> Connection::closed(std::chrono::milliseconds wait) const {
  using std::chrono::steady_clock;
  const auto until = detail::after(steady_clock::now(), wait);
  ConnectionStates all = states();
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - steady_clock::now());
    const auto next = all.next(std::max(left, std::chrono::milliseconds(0)));
    if (!next) return std::nullopt;
    if (next->status == ConnectionStatus::Closed) return next->why;
  }
}

void Connection::close() const {
  auto* impl = handle_->impl.get();
  impl->post([impl] { impl->close(Loss{LossKind::Here, {}, {}}); });
}

const ClientCounters& Connection::counters() const { return handle_->impl->counters(); }
void Connection::note_out_of_order() const { handle_->impl->note_out_of_order(); }
std::size_t Connection::in_flight() const { return handle_->impl->in_flight(); }
const Protocol& Connection::protocol() const { return handle_->impl->protocol(); }
const Limits& Connection::limits() const { return handle_->impl->limits(); }

}  // namespace fc_runtime
