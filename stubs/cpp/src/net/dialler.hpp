// Connects and reconnects.
#pragma once

#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/steady_timer.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "fc_runtime/client.hpp"
#include "link.hpp"

namespace fc_runtime::detail {

/// Makes a connection on request, after a wait that grows while attempts fail.
class Dialler {
 public:
  using Dialled = std::function<void(Result<std::shared_ptr<Link>, Loss>)>;

  Dialler(asio::io_context& io, std::string host, std::uint16_t port, const ClientConfig& config);

  /// Starts one attempt after its wait and calls `done` with the outcome. Returns `false` if the
  /// attempts are used up.
  [[nodiscard]] bool dial(Dialled done);
  /// Notes that a connection has ended. If the robot was `heard` on it, the next attempt starts at
  /// once. If it only accepted and closed, the wait grows.
  void ended(bool heard);
  /// Cancels the current attempt.
  void cancel();

 private:
  struct Attempt;

  [[nodiscard]] std::optional<std::chrono::milliseconds> next_wait();
  void resolve(const std::shared_ptr<Attempt>& attempt);
  void connect(const std::shared_ptr<Attempt>& attempt,
               const asio::ip::tcp::resolver::results_type& endpoints);
  /// Makes the handshake of a channel, and finishes the attempt.
  void secure(const std::shared_ptr<Attempt>& attempt, const std::shared_ptr<Link>& link);
  void fail(Attempt& attempt, Loss why);

  asio::io_context* io_;
  std::string host_;
  std::uint16_t port_;
  std::chrono::milliseconds limit_;
  std::optional<std::chrono::milliseconds> keepalive_;
  std::optional<Backoff> backoff_;
  ClientChannel channel_;
  bool is_first_ = true;
  /// Consecutive failed attempts.
  std::uint32_t failed_ = 0;
  /// Waits since the robot was last heard.
  std::uint32_t waits_ = 0;
  std::shared_ptr<Attempt> attempt_;
};

}  // namespace fc_runtime::detail
