// Making connections, and making them again.
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

/// Makes a connection each time it is asked to, after a wait that grows while it fails.
class Dialler {
 public:
  using Dialled = std::function<void(Result<std::shared_ptr<Link>, Loss>)>;

  Dialler(asio::io_context& io, std::string host, std::uint16_t port, const ClientConfig& config);

  /// One attempt, after its wait; `done` is told of it. Says whether there is one: no if it has been
  /// tried often enough.
  [[nodiscard]] bool dial(Dialled done);
  /// A connection has ended. A robot that was `heard` on it is tried at once; one that only accepts
  /// and closes is waited for longer and longer.
  void ended(bool heard);
  /// Gives up the attempt that is under way.
  void cancel();

 private:
  struct Attempt;

  [[nodiscard]] std::optional<std::chrono::milliseconds> next_wait();
  void resolve(const std::shared_ptr<Attempt>& attempt);
  void connect(const std::shared_ptr<Attempt>& attempt,
               const asio::ip::tcp::resolver::results_type& endpoints);

  asio::io_context* io_;
  std::string host_;
  std::uint16_t port_;
  std::chrono::milliseconds limit_;
  std::optional<std::chrono::milliseconds> keepalive_;
  std::optional<Backoff> backoff_;
  bool is_first_ = true;
  /// Attempts in a row that did not connect.
  std::uint32_t failed_ = 0;
  /// Waits since the robot was last heard.
  std::uint32_t waits_ = 0;
  std::shared_ptr<Attempt> attempt_;
};

}  // namespace fc_runtime::detail
