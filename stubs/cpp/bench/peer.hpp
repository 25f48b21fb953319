// The compared servers and callers. All exchange the same request and response.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

namespace bench {

constexpr const char* kHost = "127.0.0.1";
constexpr std::int64_t kStation = 1'671'124'918'008;
constexpr const char* kName = "gate1";

/// A server, until its destruction.
class Answering {
 public:
  Answering() = default;
  Answering(const Answering&) = delete;
  Answering& operator=(const Answering&) = delete;
  virtual ~Answering() = default;
  [[nodiscard]] virtual std::uint16_t port() const = 0;
};

/// A caller. Its results tell whether the response was correct.
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

/// A compared peer.
struct Peer {
  const char* name;
  /// `true` if requests are sent in windows, one write each.
  bool windows;
  std::unique_ptr<Answering> (*answers)();
  /// Connects to a port, for windows of `window` calls.
  std::unique_ptr<Asking> (*asks)(std::uint16_t port, int window);
};

/// The baseline: the same number of bytes without processing.
extern const Peer raw;
/// This package.
extern const Peer ours;
/// gRPC.
extern const Peer theirs;

}  // namespace bench
