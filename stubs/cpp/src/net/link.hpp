// One TCP connection's bytes, on the thread of its `io_context`.
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

namespace fc_runtime::detail {

/// Reads while it is told to, and writes what it is given, in order.
class Link : public std::enable_shared_from_this<Link> {
 public:
  using Socket = asio::ip::tcp::socket;

  explicit Link(Socket socket);

  /// Bytes have come.
  std::function<void(std::string_view)> on_bytes;
  /// Nothing more comes: the peer has closed its half (`asio::error::eof`), or the connection broke.
  std::function<void(const std::error_code&)> on_end;
  /// Some of what was to be written has been.
  std::function<void()> on_written;

  /// Small frames leave at once, and a peer that is gone without a word is noticed.
  void prepare(std::optional<std::chrono::milliseconds> keepalive);
  void read();
  void pause() { wanted_ = false; }
  void send(std::string bytes);
  /// What is still to be written, in bytes.
  [[nodiscard]] std::size_t unwritten() const {
    return waiting_.size() + writing_.size() - written_;
  }
  /// Says goodbye once all is written, and waits a moment for the peer's: a socket that is closed
  /// while something is unread is reset, and what the peer has not read yet is lost to it.
  void finish();
  /// Closes at once; nothing is told any more.
  void close();

 private:
  void write();
  void write_some();
  void wrote(std::error_code error, std::size_t count);
  void say_goodbye();
  void read_to_end();
  void forget();

  Socket socket_;
  asio::steady_timer closing_;
  std::vector<char> buffer_;
  std::string waiting_;
  std::string writing_;
  std::size_t written_ = 0;
  bool busy_ = false;
  bool wanted_ = false;
  bool reading_ = false;
  bool ended_ = false;
  bool finishing_ = false;
  bool closed_ = false;
};

}  // namespace fc_runtime::detail
