#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <stdexcept>
#include <string>
#include <thread>

#include "peer.hpp"

namespace bench {

namespace {

/// Bytes of the request frame and of the response frame.
constexpr std::size_t kAsks = 95;
constexpr std::size_t kAnswers = 204;

sockaddr_in place(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  inet_pton(AF_INET, kHost, &address.sin_addr);
  return address;
}

int checked(int result) {
  if (result < 0) throw std::runtime_error("a socket does not work");
  return result;
}

int ready(int socket) {
  const int yes = 1;
  setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  return socket;
}

bool write_all(int socket, const char* data, std::size_t size) {
  while (size > 0) {
    const auto count = send(socket, data, size, MSG_NOSIGNAL);
    if (count <= 0) return false;
    data += count;
    size -= static_cast<std::size_t>(count);
  }
  return true;
}

void answer_all(int socket) {
  std::array<char, 64 * kAsks> input{};
  const std::string answers(64 * kAnswers, '\1');
  std::size_t held = 0;
  for (;;) {
    const auto count = recv(socket, input.data(), input.size() - held, 0);
    if (count <= 0) break;
    held += static_cast<std::size_t>(count);
    const std::size_t whole = held / kAsks;
    held -= whole * kAsks;
    if (!write_all(socket, answers.data(), whole * kAnswers)) break;
  }
  close(socket);
}

/// Uses blocking threads, which end with the process.
class RawAnswers : public Answering {
 public:
  RawAnswers() {
    auto address = place(0);
    socklen_t length = sizeof address;
    auto* any = reinterpret_cast<sockaddr*>(&address);
    checked(bind(listener_, any, length));
    checked(listen(listener_, SOMAXCONN));
    checked(getsockname(listener_, any, &length));
    port_ = ntohs(address.sin_port);
    std::thread([listener = listener_] {
      for (;;) {
        const int socket = accept(listener, nullptr, nullptr);
        if (socket < 0) return;
        std::thread(answer_all, ready(socket)).detach();
      }
    }).detach();
  }
  [[nodiscard]] std::uint16_t port() const override { return port_; }

 private:
  int listener_ = checked(socket(AF_INET, SOCK_STREAM, 0));
  std::uint16_t port_ = 0;
};

class RawAsks : public Asking {
 public:
  RawAsks(std::uint16_t port, int window)
      : asks_(static_cast<std::size_t>(window) * kAsks, '\1'),
        answers_(static_cast<std::size_t>(window) * kAnswers, '\0') {
    const auto address = place(port);
    checked(connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address));
  }
  ~RawAsks() override { close(socket_); }

  bool call() override {
    if (!write_all(socket_, asks_.data(), asks_.size())) return false;
    std::size_t missing = answers_.size();
    while (missing > 0) {
      const auto count = recv(socket_, answers_.data(), missing, 0);
      if (count <= 0) return false;
      missing -= static_cast<std::size_t>(count);
    }
    return true;
  }
  void begin(std::function<void(bool)> done) override { done(call()); }

 private:
  int socket_ = ready(checked(socket(AF_INET, SOCK_STREAM, 0)));
  std::string asks_;
  std::string answers_;
};

}  // namespace

const Peer raw{"raw", true,
               []() -> std::unique_ptr<Answering> { return std::make_unique<RawAnswers>(); },
               [](std::uint16_t port, int window) -> std::unique_ptr<Asking> {
                 return std::make_unique<RawAsks>(port, window);
               }};

}  // namespace bench
