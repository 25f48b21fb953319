// Who answers and who asks, with the same question and the same answer.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

namespace bench {

constexpr const char* kHost = "127.0.0.1";
constexpr std::int64_t kStation = 1'671'124'918'008;
constexpr const char* kName = "gate1";

/// One that answers, as long as it exists.
class Answering {
 public:
  Answering() = default;
  Answering(const Answering&) = delete;
  Answering& operator=(const Answering&) = delete;
  virtual ~Answering() = default;
  [[nodiscard]] virtual std::uint16_t port() const = 0;
};

/// One that asks. All that it gives says whether the answer was the right one.
class Asking {
 public:
  Asking() = default;
  Asking(const Asking&) = delete;
  Asking& operator=(const Asking&) = delete;
  virtual ~Asking() = default;
  /// Makes a call, or a window of them, and waits.
  virtual bool call() = 0;
  /// Makes a call without waiting.
  virtual void begin(std::function<void(bool good)> done) = 0;
};

/// One of those that are compared.
struct Peer {
  const char* name;
  /// Its requests go in windows, one write each.
  bool windows;
  std::unique_ptr<Answering> (*answers)();
  /// Connects to a port, for windows of so many calls.
  std::unique_ptr<Asking> (*asks)(std::uint16_t port, int window);
};

/// As many bytes, and nothing done with them.
extern const Peer raw;
/// This package.
extern const Peer ours;
/// gRPC.
extern const Peer theirs;

}  // namespace bench
