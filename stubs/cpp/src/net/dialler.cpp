#include "dialler.hpp"

#include <algorithm>
#include <asio/connect.hpp>
#include <exception>
#include <random>

#include "fc_runtime/session.hpp"

namespace fc_runtime::detail {

/// A connection attempt. It is over when `done` is empty.
struct Dialler::Attempt {
  Attempt(asio::io_context& io, Dialled told)
      : socket(io), resolver(io), timer(io), done(std::move(told)) {}

  void finish(Result<std::shared_ptr<Link>, Loss> result) {
    const Dialled told = std::exchange(done, nullptr);
    timer.cancel();
    resolver.cancel();
    if (!result) {
      std::error_code ignored;
      socket.close(ignored);
      if (securing) securing->close();
    }
    securing.reset();
    if (told) told(std::move(result));
  }

  asio::ip::tcp::socket socket;
  /// The link during the handshake of its channel.
  std::shared_ptr<Link> securing;
  asio::ip::tcp::resolver resolver;
  asio::steady_timer timer;
  Dialled done;
};

Dialler::Dialler(asio::io_context& io, std::string host, std::uint16_t port,
                 const ClientConfig& config)
    : io_(&io),
      host_(std::move(host)),
      port_(port),
      limit_(bounded(config.connect_timeout)),
      keepalive_(config.keepalive),
      backoff_(config.reconnect),
      channel_(config.channel) {}

std::optional<std::chrono::milliseconds> Dialler::next_wait() {
  if (std::exchange(is_first_, false)) return std::chrono::milliseconds(0);
  if (!backoff_ || (backoff_->attempts && failed_ >= *backoff_->attempts)) return std::nullopt;
  // A year, doubled 20 times, does not overflow.
  const auto doubled =
      bounded(backoff_->first) * (std::int64_t{1} << std::min<std::uint32_t>(waits_, 20));
  ++waits_;
  const auto wait = std::min<std::chrono::milliseconds>(doubled, bounded(backoff_->longest));
  // The random part keeps many apps from reconnecting at once.
  std::random_device chance;
  return wait - wait * static_cast<std::int64_t>(chance() % 256) / 1024;
}

bool Dialler::dial(Dialled done) {
  const auto wait = next_wait();
  if (!wait) return false;
  attempt_ = std::make_shared<Attempt>(*io_, std::move(done));
  attempt_->timer.expires_after(*wait);
  attempt_->timer.async_wait([this, attempt = attempt_](std::error_code error) {
    if (!error && attempt->done) resolve(attempt);
  });
  return true;
}

void Dialler::resolve(const std::shared_ptr<Attempt>& attempt) {
  attempt->timer.expires_after(limit_);
  attempt->timer.async_wait([this, attempt](std::error_code error) {
    if (!error && attempt->done) fail(*attempt, {LossKind::ConnectTimeout, {}, host_});
  });
  attempt->resolver.async_resolve(
      host_, std::to_string(port_), asio::ip::tcp::resolver::numeric_service,
      [this, attempt](std::error_code error,
                      const asio::ip::tcp::resolver::results_type& endpoints) {
        if (!attempt->done) return;
        if (!error) {
          connect(attempt, endpoints);
          return;
        }
        fail(*attempt, {LossKind::Unreachable, {}, error.message()});
      });
}

void Dialler::connect(const std::shared_ptr<Attempt>& attempt,
                      const asio::ip::tcp::resolver::results_type& endpoints) {
  asio::async_connect(attempt->socket, endpoints,
                      [this, attempt](std::error_code error, const asio::ip::tcp::endpoint&) {
                        if (!attempt->done) return;
                        if (error) {
                          fail(*attempt, {LossKind::Unreachable, {}, error.message()});
                          return;
                        }
                        auto link = std::make_shared<Link>(std::move(attempt->socket));
                        link->prepare(keepalive_);
                        if (channel_) {
                          secure(attempt, link);
                          return;
                        }
                        failed_ = 0;
                        attempt->finish(std::move(link));
                      });
}

void Dialler::secure(const std::shared_ptr<Attempt>& attempt, const std::shared_ptr<Link>& link) {
  attempt->securing = link;
  link->on_handshake = [this, attempt, link = link.get()](const std::optional<std::string>& fault) {
    if (!attempt->done) return;
    if (fault) {
      fail(*attempt, {LossKind::Unreachable, {}, "the handshake failed: " + *fault});
      return;
    }
    failed_ = 0;
    link->on_handshake = nullptr;
    attempt->finish(std::shared_ptr<Link>(attempt->securing));
  };
  std::string fault = "the channel of the settings is empty";
  try {
    if (auto channel = channel_(host_)) {
      link->secure(std::move(channel));
      return;
    }
  } catch (const std::exception& error) {
    fault = error.what();
  } catch (...) {
    fault = "the channel of the settings threw";
  }
  fail(*attempt, {LossKind::Unreachable, {}, fault});
}

void Dialler::fail(Attempt& attempt, Loss why) {
  ++failed_;
  attempt.finish(std::move(why));
}

void Dialler::ended(bool heard) {
  if (heard) waits_ = 0;
}

void Dialler::cancel() {
  if (const auto attempt = std::exchange(attempt_, nullptr)) {
    attempt->done = nullptr;
    attempt->finish(Loss{LossKind::Here, {}, {}});
  }
}

}  // namespace fc_runtime::detail
