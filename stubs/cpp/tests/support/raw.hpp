// The other end of a TCP connection under manual control, for misbehaviour that no client shows.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "fc_runtime/frame.hpp"

namespace tests {

/// A socket that is closed when it goes out of scope.
class Socket {
 public:
  explicit Socket(int handle = -1) : handle_(handle) {}
  Socket(Socket&& other) noexcept : handle_(std::exchange(other.handle_, -1)) {}
  Socket& operator=(Socket&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }
  ~Socket() { close(); }

  void close() {
    if (handle_ >= 0) ::close(std::exchange(handle_, -1));
  }
  /// Closes so that the other end sees a reset.
  void reset() {
    const linger now{1, 0};
    setsockopt(handle_, SOL_SOCKET, SO_LINGER, &now, sizeof now);
    close();
  }
  void finish() const { ::shutdown(handle_, SHUT_WR); }
  [[nodiscard]] int handle() const { return handle_; }
  void send(std::string_view bytes) const {
    while (!bytes.empty()) {
      const auto sent = ::send(handle_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent <= 0) return;
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
  }
  /// Returns received bytes, or nothing at the end.
  [[nodiscard]] std::string receive() const {
    std::string bytes(65536, '\0');
    const auto count = ::recv(handle_, bytes.data(), bytes.size(), 0);
    bytes.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
    return bytes;
  }

 private:
  int handle_;
};

inline sockaddr_in loopback(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

inline Socket dial(std::uint16_t port) {
  Socket socket(::socket(AF_INET, SOCK_STREAM, 0));
  const sockaddr_in address = loopback(port);
  ::connect(socket.handle(), reinterpret_cast<const sockaddr*>(&address), sizeof address);
  return socket;
}

/// Accepts connections at a free port.
class Listener {
 public:
  Listener() : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address = loopback(0);
    socklen_t length = sizeof address;
    ::bind(socket_.handle(), reinterpret_cast<const sockaddr*>(&address), length);
    ::listen(socket_.handle(), 16);
    ::getsockname(socket_.handle(), reinterpret_cast<sockaddr*>(&address), &length);
    port_ = ntohs(address.sin_port);
  }
  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] Socket accept() const {
    return Socket(::accept(socket_.handle(), nullptr, nullptr));
  }

 private:
  Socket socket_;
  std::uint16_t port_ = 0;
};

/// Frames over a socket.
class Frames {
 public:
  Frames(Socket socket, const fc_runtime::Protocol& protocol)
      : socket_(std::move(socket)), protocol_(&protocol), decoder_(protocol) {}

  [[nodiscard]] Socket& socket() { return socket_; }
  void send(fc_runtime::FrameId id, std::string_view body) {
    std::string bytes;
    if (fc_runtime::Encoder(*protocol_).append(bytes, id, body)) socket_.send(bytes);
  }
  /// Returns the next frame and its data, or nothing at the end.
  [[nodiscard]] std::optional<std::pair<fc_runtime::FrameId, std::string>> receive() {
    for (;;) {
      const auto next = decoder_.next();
      if (!next) return std::nullopt;
      if (*next) return std::pair((*next)->header.frame, std::string((*next)->data));
      const std::string bytes = socket_.receive();
      if (bytes.empty()) return std::nullopt;
      decoder_.push(bytes);
    }
  }

 private:
  Socket socket_;
  const fc_runtime::Protocol* protocol_;
  fc_runtime::Decoder decoder_;
};

}  // namespace tests
