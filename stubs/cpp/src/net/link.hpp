// The byte stream of one TCP connection, on the thread of its `io_context`.
#pragma once

#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/steady_timer.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "fc_runtime/secure_channel.hpp"

namespace fc_runtime::detail {

/// Reads on request, and writes in order.
class Link : public std::enable_shared_from_this<Link> {
 public:
  using Socket = asio::ip::tcp::socket;

  explicit Link(Socket socket);

  /// Called with received bytes.
  std::function<void(std::string_view)> on_bytes;
  /// Called at the end: the peer has closed its half (`asio::error::eof`), or the connection broke.
  std::function<void(const std::error_code&)> on_end;
  /// Called after some queued bytes are written.
  std::function<void()> on_written;
  /// Called after the handshake of the channel, with the reason if it failed.
  std::function<void(const std::optional<std::string>&)> on_handshake;

  /// Sets the socket options: small frames leave at once, and a dead peer is detected.
  void prepare(std::optional<std::chrono::milliseconds> keepalive);
  /// Puts a channel in front of the socket and starts its handshake. Without a `limit`, the owner
  /// watches the time.
  void secure(std::unique_ptr<SecureChannel> channel,
              std::optional<std::chrono::milliseconds> limit = std::nullopt);
  void read();
  void pause() { wanted_ = false; }
  void send(std::string bytes);
  /// Number of bytes to be written.
  [[nodiscard]] std::size_t unwritten() const {
    return waiting_.size() + sealed_.size() + writing_.size() - written_;
  }
  /// The reason why the channel broke; empty otherwise.
  [[nodiscard]] const std::string& fault() const { return fault_; }
  /// Closes its half after all is written, and waits a moment for the end of the peer. Closing a
  /// socket with unread bytes resets it, and the peer loses bytes that it has not read yet.
  void finish();
  /// Closes at once, without further callbacks.
  void close();

 private:
  [[nodiscard]] bool is_ready() const { return !channel_ || channel_->is_ready(); }
  void read_some();
  void received(std::string_view bytes);
  /// Ends the link after an error of its channel.
  void broke(const std::string& fault);
  void end(std::error_code error);
  /// Encrypts the waiting bytes.
  void seal();
  void write();
  void write_some();
  void wrote(std::error_code error, std::size_t count);
  void say_goodbye();
  void read_to_end();
  void forget();

  Socket socket_;
  asio::steady_timer closing_;
  std::vector<char> buffer_;
  std::unique_ptr<SecureChannel> channel_;
  std::string fault_;
  std::string waiting_;
  /// Encrypted bytes to be written.
  std::string sealed_;
  std::string writing_;
  std::size_t written_ = 0;
  bool busy_ = false;
  bool wanted_ = false;
  bool reading_ = false;
  bool ended_ = false;
  bool finishing_ = false;
  bool said_goodbye_ = false;
  bool closed_ = false;
};

}  // namespace fc_runtime::detail
