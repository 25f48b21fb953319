// Counters with one writing thread and any number of readers.
#pragma once

#include <atomic>
#include <cstdint>

namespace fc_runtime {

/// A counter that one thread increments and any thread reads.
class Count {
 public:
  void operator+=(std::uint64_t more) noexcept {
    value_.fetch_add(more, std::memory_order_relaxed);
  }
  void operator++() noexcept { *this += 1; }
  // NOLINTNEXTLINE(google-explicit-constructor): it is a number
  operator std::uint64_t() const noexcept { return value_.load(std::memory_order_relaxed); }

 private:
  std::atomic<std::uint64_t> value_{0};
};

}  // namespace fc_runtime
