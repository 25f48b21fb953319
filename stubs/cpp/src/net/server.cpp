#include "fc_runtime/server.hpp"

#include <algorithm>
#include <asio/executor_work_guard.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/post.hpp>
#include <asio/steady_timer.hpp>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <map>
#include <mutex>
#include <thread>

#include "admission.hpp"
#include "allow.hpp"
#include "clock.hpp"
#include "data_port.hpp"
#include "link.hpp"
#include "logger.hpp"
#include "settings.hpp"
#include "waiting.hpp"
#include "workers.hpp"

namespace fc_runtime {

std::string_view name(PushErrorKind kind) noexcept {
  switch (kind) {
    case PushErrorKind::Invalid:
      return "invalid_report";
    case PushErrorKind::Frame:
      return "frame";
    case PushErrorKind::NoConnection:
      return "no_connection";
    case PushErrorKind::Ambiguous:
      return "ambiguous";
  }
  return "";
}

std::string to_string(const PushError& error) {
  std::string text(name(error.kind));
  if (error.body) text += ": " + to_string(*error.body);
  return text;
}

namespace detail {

namespace {

using asio::ip::tcp;

RobotSettings filled_in(const Protocol& protocol, const ServerConfig& config) {
  RobotSettings settings;
  settings.limits = config.limits.value_or(protocol.defaults.limits);
  settings.handler_timeout = config.handler_timeout.value_or(protocol.defaults.handler_timeout);
  settings.header_timeout = config.header_timeout;
  settings.stall_timeout = config.stall_timeout;
  settings.least_rate = config.least_rate;
  settings.idle_timeout = config.idle_timeout;
  settings.queued_bytes = config.queued_bytes.value_or(settings.limits.inflated_bytes);
  settings.abandoned_handlers = config.abandoned_handlers;
  settings.first_id = config.first_id.value_or(first_id_now());
  settings.gzip = config.gzip;
  settings.verify_digest = config.verify_digest;
  settings.resync = config.resync;
  settings.hands_on_unknown = true;
  return settings;
}

}  // namespace

/// The implementation of a server. All functions run on its thread, except those marked otherwise.
class ServerImpl {
 public:
  ServerImpl(const Protocol& protocol, Service service, const ServerConfig& config)
      : protocol_(&protocol),
        config_(config),
        settings_(filled_in(protocol, config)),
        logger_(config.log, protocol.name),
        service_(std::move(service)),
        core_(protocol, settings_, [this](const Request& request) { begin(request); }),
        work_(asio::make_work_guard(io_)),
        commands_(io_),
        streams_(io_),
        timer_(io_),
        data_(io_, protocol, settings_, core_.counting()),
        workers_(config.handler_threads) {
    core_.set_unsendable([this](ConnectionId id, FrameId frame, const FrameError& error) {
      Context context;
      context.connection = id;
      context.code = frame.code;
      context.id = frame.id;
      context.address = address_of(id);
      note_failure(context, std::make_exception_ptr(UnsendableResponse(error)));
    });
    if (config_.on_call) {
      core_.set_on_call(
          [this](const EndedCall& call) { logger_.call("`on_call`", config_.on_call, call); });
    }
    data_.on_held = [this] {
      if (held() > config_.memory) after_work();
    };
  }
  ServerImpl(const ServerImpl&) = delete;
  ServerImpl& operator=(const ServerImpl&) = delete;
  ~ServerImpl() {
    if (!thread_.joinable()) return;
    // Releases handlers that wait for the end of a report. They run to their end.
    asio::post(io_, [this] { stop(); });
    workers_.stop();
    asio::post(io_, [this] { work_.reset(); });
    thread_.join();
  }

  // Functions for any thread.
  std::optional<BindError> listen();
  void post(std::function<void()> work) { asio::post(io_, std::move(work)); }
  [[nodiscard]] const Protocol& protocol() const { return *protocol_; }
  [[nodiscard]] const std::string& address() const { return config_.address; }
  [[nodiscard]] std::uint16_t command_port() const { return command_port_; }
  [[nodiscard]] std::uint16_t data_port() const { return data_port_; }
  [[nodiscard]] const ServerCounters& counters() const { return core_.counters(); }
  [[nodiscard]] DataPort& data() { return data_; }
  [[nodiscard]] Logger& logger() { return logger_; }
  [[nodiscard]] std::vector<ConnectionId> connections() const {
    const std::lock_guard held(mutex_);
    return connected_;
  }

  // Functions for its thread.
  void push(std::uint16_t code, std::string body, std::optional<ConnectionId> to, Pushed done) {
    core_.push(code, std::move(body), to, std::move(done), clock_now());
    after_work();
  }
  void shutdown(std::chrono::milliseconds grace, std::function<void()> over);

 private:
  struct Peer {
    std::shared_ptr<Link> link;
    std::string address;
  };

  std::optional<BindError> open(tcp::acceptor& acceptor, std::uint16_t port, std::uint16_t& bound);
  void accept(tcp::acceptor& acceptor, bool is_data);
  void accept_later(tcp::acceptor& acceptor, bool is_data);
  void accepted(tcp::socket socket, bool is_data);
  [[nodiscard]] bool secure(Link& link, const std::string& address);
  void connected(std::shared_ptr<Link> link, const std::string& address,
                 const std::vector<Effect>& effects);
  template <class Peers, class IsSilent, class GiveWay>
  [[nodiscard]] bool admit(const Crowd<Peers>& crowd, const std::string& address,
                           const IsSilent& is_silent, const GiveWay& give_way);
  [[nodiscard]] std::string address_of(ConnectionId id) const;
  void begin(const Request& request);
  [[nodiscard]] Handled handle(const Context& context, std::string_view text);
  void note_failure(const Context& context, const std::exception_ptr& error);
  void ended(std::uint64_t handler, Handled handled);
  void answer();
  [[nodiscard]] bool speaks(const std::string& address) const;
  [[nodiscard]] std::size_t held() const;
  void weigh();
  void evict_largest();
  void forget(ConnectionId id);
  void note();
  void after_work();
  void serve(ConnectionId id, Peer& peer);
  void arm();
  void look_whether_over();
  void stop();

  const Protocol* protocol_;
  ServerConfig config_;
  RobotSettings settings_;
  Logger logger_;
  Service service_;
  RobotCore core_;
  asio::io_context io_{1};
  asio::executor_work_guard<asio::io_context::executor_type> work_;
  tcp::acceptor commands_;
  tcp::acceptor streams_;
  asio::steady_timer timer_;
  std::optional<Instant> armed_;
  DataPort data_;
  AllowList allowed_;
  std::map<ConnectionId, Peer> peers_;
  /// Ids of data connections are from the upper range of the same type.
  ConnectionId next_data_ = ConnectionId{1} << 32U;
  std::vector<std::function<void()>> over_;
  bool is_stopped_ = false;
  std::uint16_t command_port_ = 0;
  std::uint16_t data_port_ = 0;
  mutable std::mutex mutex_;
  std::vector<ConnectionId> connected_;
  std::mutex ended_mutex_;
  std::vector<std::pair<std::uint64_t, Handled>> ended_;
  std::thread thread_;
  /// The last member is destroyed first: its handlers may still use the others.
  Workers workers_;
};

std::optional<BindError> ServerImpl::open(tcp::acceptor& acceptor, std::uint16_t port,
                                          std::uint16_t& bound) {
  std::error_code error;
  const auto address = asio::ip::make_address(config_.address, error);
  if (error) return BindError{config_.address + " is no address"};
  const tcp::endpoint endpoint(address, port);
  acceptor.open(endpoint.protocol(), error);
  if (!error) acceptor.set_option(asio::socket_base::reuse_address(true), error);
  if (!error) acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (!error) bound = acceptor.local_endpoint(error).port();
  if (!error) return std::nullopt;
  return BindError{config_.address + ":" + std::to_string(port) + ": " + error.message()};
}

std::optional<BindError> ServerImpl::listen() {
  if (auto fault = fault_of(config_)) return BindError{*std::move(fault)};
  if (auto error = allowed_.read(config_.allow)) return error;
  const auto command_port = config_.command_port.value_or(protocol_->command_port);
  if (auto error = open(commands_, command_port, command_port_)) return error;
  const auto data_port = config_.data_port.value_or(protocol_->data_port);
  if (auto error = open(streams_, data_port, data_port_)) return error;
  accept(commands_, false);
  accept(streams_, true);
  thread_ = std::thread([this] { io_.run(); });
  return std::nullopt;
}

void ServerImpl::accept(tcp::acceptor& acceptor, bool is_data) {
  acceptor.async_accept([this, &acceptor, is_data](std::error_code error, tcp::socket socket) {
    if (is_stopped_ || !acceptor.is_open()) return;
    if (error) {
      accept_later(acceptor, is_data);
      return;
    }
    accepted(std::move(socket), is_data);
    accept(acceptor, is_data);
  });
}

/// Accepts again after a moment. If the system has no more file handles, it would fail endlessly.
void ServerImpl::accept_later(tcp::acceptor& acceptor, bool is_data) {
  const auto timer = std::make_shared<asio::steady_timer>(io_, std::chrono::milliseconds(100));
  timer->async_wait([this, &acceptor, is_data, timer](std::error_code) {
    if (!is_stopped_ && acceptor.is_open()) accept(acceptor, is_data);
  });
}

/// Returns `true` if an app at an address has sent something to the command port.
bool ServerImpl::speaks(const std::string& address) const {
  return std::any_of(peers_.begin(), peers_.end(), [&](const auto& entry) {
    return entry.second.address == address && core_.is_heard(entry.first);
  });
}

/// Makes room for a connection. Returns `false` if that is impossible; counts and logs it.
template <class Peers, class IsSilent, class GiveWay>
bool ServerImpl::admit(const Crowd<Peers>& crowd, const std::string& address,
                       const IsSilent& is_silent, const GiveWay& give_way) {
  if (crowd.has_room(address)) return true;
  const auto silent = crowd.gives_way(address, is_silent);
  if (!silent) {
    ++core_.counting().connections_refused;
    logger_.write(LogLevel::Warning, "refused", "refused " + address + ": too many connections");
    return false;
  }
  ++core_.counting().connections_displaced;
  logger_.write(LogLevel::Warning, "displaced",
                "closed connection " + std::to_string(*silent) +
                    ", which was silent, to make room for " + address);
  give_way(*silent);
  return true;
}

void ServerImpl::accepted(tcp::socket socket, bool is_data) {
  std::error_code error;
  const auto place = socket.remote_endpoint(error).address();
  if (error) return;
  const auto* effects = allowed_.effects(place);
  const std::string address = place.to_string();
  if (effects == nullptr) {
    ++core_.counting().connections_forbidden;
    logger_.write(LogLevel::Warning, "forbidden", "refused " + address + ": it is not allowed");
    return;
  }
  auto link = std::make_shared<Link>(std::move(socket));
  link->prepare(config_.keepalive);
  if (config_.channel && !secure(*link, address)) return;
  if (!is_data) {
    connected(std::move(link), address, *effects);
    return;
  }
  std::vector<ConnectionId> owners;
  for (const auto& [id, peer] : peers_) {
    if (peer.address == address) owners.push_back(id);
  }
  // An app that only receives streams is recognized by its commands.
  const auto is_silent = [this](ConnectionId, const DataPort::Peer& peer) {
    return !peer.is_heard && !speaks(peer.address);
  };
  const auto crowd = data_.crowd(config_.connections_per_address);
  const bool has_room =
      admit(crowd, address, is_silent, [this](ConnectionId id) { data_.end(id); });
  if (has_room) {
    data_.connect(next_data_++, address, link, owners);
  } else {
    link->finish();
  }
}

/// Starts the handshake of a connection. Returns `false` if there is no channel for it.
bool ServerImpl::secure(Link& link, const std::string& address) {
  std::unique_ptr<SecureChannel> channel;
  try {
    channel = config_.channel();
  } catch (...) {
    logger_.write_thrown("`ServerConfig::channel`");
  }
  if (!channel) return false;
  link.on_handshake = [this, address](const std::optional<std::string>& fault) {
    if (!fault) return;
    ++core_.counting().handshakes_failed;
    logger_.write(LogLevel::Warning, "handshake",
                  "the handshake with " + address + " failed: " + *fault);
  };
  link.secure(std::move(channel), bounded(config_.header_timeout));
  return true;
}

void ServerImpl::connected(std::shared_ptr<Link> link, const std::string& address,
                           const std::vector<Effect>& effects) {
  const auto is_silent = [this](ConnectionId id, const Peer&) { return !core_.is_heard(id); };
  const Crowd<Peer> crowd(peers_, config_.connections_per_address, settings_.limits.connections);
  const bool has_room = admit(crowd, address, is_silent, [this](ConnectionId id) { forget(id); });
  std::optional<ConnectionId> id;
  if (has_room) id = core_.connect(clock_now(), effects);
  if (!id) {
    link->finish();
    return;
  }
  link->on_bytes = [this, id = *id](std::string_view bytes) {
    core_.received(id, bytes, clock_now());
    after_work();
  };
  link->on_end = [this, id = *id](const std::error_code& error) {
    if (error == asio::error::eof) {
      core_.ended(id);
    } else {
      forget(id);
    }
    after_work();
  };
  link->on_written = [this, id = *id] {
    const auto found = peers_.find(id);
    if (found == peers_.end()) return;
    core_.set_unwritten(id, found->second.link->unwritten(), clock_now());
    after_work();
  };
  data_.saw(*id, address);
  peers_[*id] = {std::move(link), address};
  note();
  after_work();
}

void ServerImpl::note() {
  const std::lock_guard held(mutex_);
  connected_ = core_.connections();
}

/// Removes a connection.
void ServerImpl::forget(ConnectionId id) {
  const auto found = peers_.find(id);
  if (found == peers_.end()) return;
  const auto link = found->second.link;
  peers_.erase(found);
  core_.closed(id);
  link->close();
  note();
}

std::string ServerImpl::address_of(ConnectionId id) const {
  const auto found = peers_.find(id);
  return found == peers_.end() ? std::string() : found->second.address;
}

void ServerImpl::begin(const Request& request) {
  const auto work = [this, request, address = address_of(request.connection)] {
    auto text = request.text.lock();
    if (!text) {
      // The app has just disconnected.
      ended(request.handler, Refusal(protocol_->results.timeout));
      return;
    }
    const Context context{request.connection,
                          request.frame.code,
                          request.frame.id,
                          std::nullopt,
                          request.abandoned,
                          settings_.limits.json(),
                          config_.max_age ? config_.max_age : protocol_->defaults.max_age,
                          address};
    Handled handled = handle(context, *text);
    // Frees its memory before the server measures the use of memory.
    text.reset();
    ended(request.handler, std::move(handled));
  };
  workers_.run(work, request.settled);
}

/// Runs the handler of a request. An exception becomes a response, so that the server survives.
Handled ServerImpl::handle(const Context& context, std::string_view text) {
  try {
    return service_(context, text);
  } catch (...) {
    note_failure(context, std::current_exception());
  }
  return handler_failed(*protocol_);
}

/// Counts and logs an error of a handler and passes it on. For any thread.
void ServerImpl::note_failure(const Context& context, const std::exception_ptr& error) {
  ++core_.counting().handlers_panicked;
  const std::string command = command_name(*protocol_, context.code);
  // Apps choose the codes, so all unknown codes are one cause.
  const bool is_known = protocol_->find(OperationKind::Command, context.code) != nullptr;
  const std::string cause = "handler " + (is_known ? command : std::string());
  try {
    std::rethrow_exception(error);
  } catch (const UnsendableResponse& unsendable) {
    logger_.write(LogLevel::Error, cause,
                  "the response to " + command + " cannot be sent: " + unsendable.what());
  } catch (...) {
    logger_.write(LogLevel::Error, cause,
                  "the handler of " + command + " threw `" + thrown_type() + "`");
  }
  if (config_.on_handler_error) {
    logger_.call("`on_handler_error`", config_.on_handler_error, error, context);
  }
}

/// Bytes that the server holds for apps.
std::size_t ServerImpl::held() const {
  std::size_t held = data_.held();
  for (const auto& [id, peer] : peers_) held += core_.held(id);
  return held;
}

/// Closes the connections that hold most until the others have room.
void ServerImpl::weigh() {
  while (held() > config_.memory && (!peers_.empty() || !data_.is_empty())) evict_largest();
  core_.set_pressed(held() + core_.held_for_nobody() > config_.memory);
}

void ServerImpl::evict_largest() {
  std::optional<ConnectionId> command;
  std::size_t most = 0;
  for (const auto& [id, peer] : peers_) {
    if (core_.held(id) < most) continue;
    most = core_.held(id);
    command = id;
  }
  const auto data = data_.largest();
  const bool is_data = data && (!command || data->second > most);
  const ConnectionId id = is_data ? data->first : *command;
  ++core_.counting().connections_evicted;
  logger_.write(LogLevel::Warning, "evicted",
                "closed connection " + std::to_string(id) + ", which held " +
                    std::to_string(is_data ? data->second : most) + " bytes: memory is short");
  if (is_data) {
    data_.evict(id);
  } else {
    forget(id);
  }
}

/// Takes the outcome of a handler. For any thread.
void ServerImpl::ended(std::uint64_t handler, Handled handled) {
  {
    const std::lock_guard held(ended_mutex_);
    ended_.emplace_back(handler, std::move(handled));
    // The first caller posts the work. Responses that arrive until then are sent with one write.
    if (ended_.size() > 1) return;
  }
  asio::post(io_, [this] { answer(); });
}

void ServerImpl::answer() {
  std::vector<std::pair<std::uint64_t, Handled>> ended;
  {
    const std::lock_guard held(ended_mutex_);
    ended.swap(ended_);
  }
  for (const auto& [handler, handled] : ended) core_.finish(handler, handled, clock_now());
  after_work();
}

void ServerImpl::serve(ConnectionId id, Peer& peer) {
  std::string out = core_.take_out(id);
  if (!out.empty()) peer.link->send(std::move(out));
  core_.set_unwritten(id, peer.link->unwritten(), clock_now());
  if (core_.wants_bytes(id)) {
    peer.link->read();
  } else {
    peer.link->pause();
  }
}

void ServerImpl::after_work() {
  weigh();
  std::vector<ConnectionId> done;
  for (auto& [id, peer] : peers_) {
    serve(id, peer);
    if (core_.is_done(id)) done.push_back(id);
  }
  for (const ConnectionId id : done) {
    const auto link = peers_.at(id).link;
    peers_.erase(id);
    core_.closed(id);
    link->finish();
  }
  if (!done.empty()) note();
  core_.settle();
  look_whether_over();
  arm();
}

void ServerImpl::arm() {
  const auto due = core_.next_due();
  if (!due || is_stopped_ || (armed_ && *armed_ <= *due)) return;
  armed_ = due;
  timer_.expires_at(*due);
  timer_.async_wait([this](std::error_code error) {
    if (error) return;
    armed_.reset();
    core_.advance(clock_now());
    after_work();
  });
}

void ServerImpl::shutdown(std::chrono::milliseconds grace, std::function<void()> over) {
  std::error_code ignored;
  commands_.close(ignored);
  streams_.close(ignored);
  over_.push_back(std::move(over));
  data_.drain();
  core_.shutdown(grace, clock_now());
  armed_.reset();
  after_work();
}

void ServerImpl::look_whether_over() {
  if (over_.empty() || !core_.is_over()) return;
  data_.close();
  for (const auto& over : std::exchange(over_, {})) over();
}

void ServerImpl::stop() {
  is_stopped_ = true;
  std::error_code ignored;
  commands_.close(ignored);
  streams_.close(ignored);
  timer_.cancel();
  while (!peers_.empty()) {
    const ConnectionId id = peers_.begin()->first;
    const auto link = peers_.begin()->second.link;
    peers_.erase(peers_.begin());
    core_.closed(id);
    link->finish();
  }
  core_.settle();
  data_.close();
  for (const auto& over : std::exchange(over_, {})) over();
}

}  // namespace detail

Server::Server(std::shared_ptr<detail::ServerImpl> impl) : impl_(std::move(impl)) {}
Server::Server(Server&&) noexcept = default;
Server& Server::operator=(Server&&) noexcept = default;
Server::~Server() = default;

Result<Server, BindError> Server::bind(const Protocol& protocol, Service service,
                                       const ServerConfig& config) {
  auto impl = std::make_shared<detail::ServerImpl>(protocol, std::move(service), config);
  if (auto error = impl->listen()) return *std::move(error);
  return Server(std::move(impl));
}

const std::string& Server::address() const { return impl_->address(); }
std::uint16_t Server::command_port() const { return impl_->command_port(); }
std::uint16_t Server::data_port() const { return impl_->data_port(); }
const ServerCounters& Server::counters() const { return impl_->counters(); }
const Protocol& Server::protocol() const { return impl_->protocol(); }
std::vector<ConnectionId> Server::connections() const { return impl_->connections(); }

void Server::push_body_async(std::uint16_t code, std::string body, Pushed done,
                             std::optional<ConnectionId> to) const {
  auto* impl = impl_.get();
  Pushed guarded;
  if (done) {
    guarded = [impl, done = std::move(done)](std::vector<AckOutcome> outcomes) {
      impl->logger().call("a callback of a report", done, std::move(outcomes));
    };
  }
  impl->post([impl, code, body = std::move(body), done = std::move(guarded), to]() mutable {
    impl->push(code, std::move(body), to, std::move(done));
  });
}

Result<std::vector<AckOutcome>, PushError> Server::push_body(std::uint16_t code, std::string body,
                                                             std::optional<ConnectionId> to) const {
  const auto ended = std::make_shared<detail::Waiting<std::vector<AckOutcome>>>();
  push_body_async(
      code, std::move(body),
      [ended](std::vector<AckOutcome> outcomes) { ended->give(std::move(outcomes)); }, to);
  auto outcomes = ended->take();
  if (to && outcomes.empty()) return PushError{PushErrorKind::NoConnection, {}};
  return outcomes;
}

Result<std::size_t, PushError> Server::send_stream(std::optional<ConnectionId> to,
                                                   std::uint16_t code, std::uint32_t id,
                                                   std::string data) const {
  const auto sent = std::make_shared<detail::Waiting<Result<std::size_t, PushError>>>();
  auto* impl = impl_.get();
  impl->post([impl, sent, to, code, id, data = std::move(data)] {
    impl->data().send(to, code, id, data, [sent](Result<std::size_t, PushError> outcome) {
      sent->give(std::move(outcome));
    });
  });
  return sent->take();
}

std::optional<AppStream> Server::next_stream(std::chrono::milliseconds wait) const {
  auto* impl = impl_.get();
  return impl->data().next(wait, [impl] { impl->post([impl] { impl->data().resume(); }); });
}

void Server::shutdown(std::chrono::milliseconds grace) const {
  const auto over = std::make_shared<detail::Waiting<Done>>();
  auto* impl = impl_.get();
  impl->post([impl, over, grace] { impl->shutdown(grace, [over] { over->give(Done{}); }); });
  static_cast<void>(over->take());
}

}  // namespace fc_runtime
