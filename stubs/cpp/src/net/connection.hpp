// The thread of a client, and its connection to the command port.
#pragma once

#include <asio/executor_work_guard.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/steady_timer.hpp>
#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "dialler.hpp"
#include "fc_runtime/client.hpp"
#include "fc_runtime/client_core.hpp"
#include "link.hpp"
#include "logger.hpp"

namespace fc_runtime::detail {

/// The interface through which a data connection follows the command connection.
class Companion {
 public:
  Companion() = default;
  Companion(const Companion&) = delete;
  Companion& operator=(const Companion&) = delete;
  virtual ~Companion() = default;
  /// The command connection is up, for the first time or again.
  virtual void commands_connected() = 0;
  /// The command connection is closed.
  virtual void commands_closed(const Loss& why) = 0;
};

/// The shared state of the handles of a connection. All functions run on its thread, except the
/// constructor and those marked otherwise.
class ConnectionImpl : public std::enable_shared_from_this<ConnectionImpl> {
 public:
  ConnectionImpl(const Protocol& protocol, const ClientConfig& config);

  // Functions for any thread.
  void start(std::function<void(std::optional<Loss>)> first);
  [[nodiscard]] bool is_own_thread() const { return std::this_thread::get_id() == own_; }
  void post(std::function<void()> work);
  /// Ends the thread and waits for it.
  void stop();
  [[nodiscard]] const Protocol& protocol() const { return *protocol_; }
  [[nodiscard]] const ClientConfig& config() const { return config_; }
  [[nodiscard]] const ClientSettings& settings() const { return settings_; }
  [[nodiscard]] const Limits& limits() const { return settings_.limits; }
  [[nodiscard]] Life& life() { return core_.life(); }
  [[nodiscard]] Receivers& receivers() { return core_.receivers(); }
  [[nodiscard]] const ClientCounters& counters() const { return core_.counters(); }
  [[nodiscard]] std::size_t in_flight() const { return in_flight_; }
  void note_out_of_order() { core_.note_out_of_order(); }
  [[nodiscard]] Logger& logger() { return logger_; }

  // Functions for its thread.
  std::uint64_t call(std::uint16_t code, std::string body, const CallOptions& options,
                     Completion done);
  void cancel(std::uint64_t call);
  void close(const Loss& why);
  void attend(const std::shared_ptr<Companion>& companion);
  [[nodiscard]] asio::io_context& io() { return io_; }

 private:
  void dial();
  void dialled(Result<std::shared_ptr<Link>, Loss> link);
  void down(const Loss& why);
  void work_off();
  void after_work();
  void arm();
  void tell(const std::function<void(Companion&)>& what);

  const Protocol* protocol_;
  ClientConfig config_;
  ClientSettings settings_;
  Logger logger_;
  ClientCore core_;
  asio::io_context io_{1};
  asio::executor_work_guard<asio::io_context::executor_type> work_;
  Dialler dialler_;
  asio::steady_timer timer_;
  std::optional<Instant> armed_;
  bool is_closed_ = false;
  std::shared_ptr<Link> link_;
  std::function<void(std::optional<Loss>)> first_;
  std::vector<std::weak_ptr<Companion>> companions_;
  std::mutex posted_mutex_;
  std::vector<std::function<void()>> posted_;
  std::atomic<std::size_t> in_flight_{0};
  std::atomic<std::thread::id> own_{};
  std::thread thread_;
};

}  // namespace fc_runtime::detail
