#include "link.hpp"

#include <netinet/tcp.h>
#include <sys/socket.h>

#include <algorithm>
#include <asio/buffer.hpp>
#include <asio/error.hpp>
#include <asio/post.hpp>
#include <utility>

namespace fc_runtime::detail {

namespace {

/// Size of a read, in bytes.
constexpr std::size_t kRead = std::size_t{64} * 1024;
/// Time of a closing connection to send the rest and wait for the end of the peer.
constexpr std::chrono::seconds kClosing{1};

void set_option(int socket, int level, int option, int value) {
  // If the system does not know an option, the connection works without it.
  static_cast<void>(setsockopt(socket, level, option, &value, sizeof value));
}

/// Calls a listener whose owner may release it during the call.
template <class... Arguments>
void tell(const std::function<void(Arguments...)>& listener, Arguments... what) {
  const std::function<void(Arguments...)> kept = listener;
  if (kept) kept(what...);
}

}  // namespace

Link::Link(Socket socket)
    : socket_(std::move(socket)), closing_(socket_.get_executor()), buffer_(kRead) {}

void Link::prepare(std::optional<std::chrono::milliseconds> keepalive) {
  std::error_code ignored;
  socket_.set_option(asio::ip::tcp::no_delay(true), ignored);
  if (!keepalive) return;
  socket_.set_option(asio::socket_base::keep_alive(true), ignored);
  const auto silence = std::max<std::int64_t>(keepalive->count() / 1000, 1);
  const auto probes = std::max<std::int64_t>(silence / 3, 1);
#ifdef TCP_KEEPIDLE
  set_option(socket_.native_handle(), IPPROTO_TCP, TCP_KEEPIDLE, static_cast<int>(silence));
  set_option(socket_.native_handle(), IPPROTO_TCP, TCP_KEEPINTVL, static_cast<int>(probes));
#endif
#ifdef TCP_USER_TIMEOUT
  // Keepalive probes only an idle connection. This option limits unacknowledged data.
  set_option(socket_.native_handle(), IPPROTO_TCP, TCP_USER_TIMEOUT,
             static_cast<int>(keepalive->count() * 2));
#endif
}

void Link::secure(std::unique_ptr<SecureChannel> channel,
                  std::optional<std::chrono::milliseconds> limit) {
  channel_ = std::move(channel);
  if (limit) {
    closing_.expires_after(*limit);
    closing_.async_wait([self = shared_from_this()](std::error_code error) {
      if (!error && !self->is_ready()) self->broke("the handshake took too long");
    });
  }
  received({});
  read_some();
}

void Link::read() {
  wanted_ = true;
  read_some();
}

void Link::read_some() {
  if (reading_ || ended_ || closed_ || finishing_) return;
  reading_ = true;
  socket_.async_read_some(asio::buffer(buffer_),
                          [self = shared_from_this()](std::error_code error, std::size_t count) {
                            self->reading_ = false;
                            if (self->closed_) return;
                            if (self->finishing_) {
                              error ? self->close() : self->read_to_end();
                              return;
                            }
                            if (error) {
                              self->end(error);
                              return;
                            }
                            self->received({self->buffer_.data(), count});
                            if (self->wanted_ || !self->is_ready()) self->read_some();
                          });
}

void Link::received(std::string_view bytes) {
  if (!channel_) {
    tell<std::string_view>(on_bytes, bytes);
    return;
  }
  const bool was_ready = is_ready();
  SecureChannel::Output output;
  const auto fault = channel_->receive(bytes, output);
  sealed_ += output.sealed;
  write();
  if (fault) {
    broke(*fault);
    return;
  }
  if (!was_ready && is_ready()) {
    closing_.cancel();
    tell<const std::optional<std::string>&>(on_handshake, std::nullopt);
    write();
  }
  if (!output.opened.empty()) tell<std::string_view>(on_bytes, output.opened);
}

void Link::broke(const std::string& fault) {
  if (closed_ || ended_) return;
  fault_ = fault;
  end(std::make_error_code(std::errc::protocol_error));
}

void Link::end(std::error_code error) {
  ended_ = true;
  if (!is_ready()) {
    const std::string why = fault_.empty() ? error.message() : fault_;
    tell<const std::optional<std::string>&>(on_handshake, why);
  }
  // The listener may release this link.
  tell<const std::error_code&>(on_end, error);
}

void Link::send(std::string bytes) {
  if (closed_ || finishing_) return;
  if (waiting_.empty()) {
    waiting_ = std::move(bytes);
  } else {
    waiting_.append(bytes);
  }
  write();
}

void Link::write() {
  if (closed_ || busy_) return;
  writing_.clear();
  written_ = 0;
  seal();
  std::string& next = channel_ ? sealed_ : waiting_;
  if (next.empty()) {
    if (finishing_) say_goodbye();
    return;
  }
  writing_.swap(next);
  write_some();
}

void Link::seal() {
  if (!channel_) return;
  SecureChannel::Output output;
  std::optional<std::string> fault;
  if (is_ready() && !waiting_.empty()) fault = channel_->send(std::exchange(waiting_, {}), output);
  if (finishing_ && !std::exchange(said_goodbye_, true)) channel_->finish(output);
  sealed_ += output.sealed;
  if (!fault) return;
  // The caller may be a listener, which expects no other call.
  asio::post(socket_.get_executor(),
             [self = shared_from_this(), why = *std::move(fault)] { self->broke(why); });
}

void Link::write_some() {
  busy_ = true;
  socket_.async_write_some(asio::buffer(writing_.data() + written_, writing_.size() - written_),
                           [self = shared_from_this()](std::error_code error, std::size_t count) {
                             if (!self->closed_) self->wrote(error, count);
                           });
}

void Link::wrote(std::error_code error, std::size_t count) {
  busy_ = false;
  if (error) {
    if (finishing_) {
      close();
    } else {
      end(error);
    }
    return;
  }
  written_ += count;
  if (written_ < writing_.size()) {
    write_some();
  } else {
    write();
  }
  // The listener may write more, or release this link.
  tell<>(on_written);
}

void Link::finish() {
  if (closed_ || finishing_) return;
  finishing_ = true;
  forget();
  closing_.expires_after(kClosing);
  closing_.async_wait([self = shared_from_this()](std::error_code error) {
    if (!error) self->close();
  });
  write();
}

void Link::say_goodbye() {
  std::error_code ignored;
  socket_.shutdown(Socket::shutdown_send, ignored);
  if (ended_) {
    close();
  } else if (!reading_) {
    read_to_end();
  }
}

void Link::read_to_end() {
  socket_.async_read_some(asio::buffer(buffer_),
                          [self = shared_from_this()](std::error_code error, std::size_t) {
                            if (self->closed_) return;
                            if (error) {
                              self->close();
                            } else {
                              self->read_to_end();
                            }
                          });
}

void Link::forget() {
  on_bytes = nullptr;
  on_end = nullptr;
  on_handshake = nullptr;
  on_written = nullptr;
}

void Link::close() {
  if (closed_) return;
  closed_ = true;
  forget();
  closing_.cancel();
  std::error_code ignored;
  socket_.close(ignored);
}

}  // namespace fc_runtime::detail
