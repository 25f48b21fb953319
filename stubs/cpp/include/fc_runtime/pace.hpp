// The cost of useless work that a connection causes.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>

#include "fc_runtime/frame.hpp"
#include "fc_runtime/session.hpp"

namespace fc_runtime::detail {

/// The cost of useless frames of a connection. While the connection pays, the robot does not read
/// from it and serves the others.
class Pace {
 public:
  /// Counts an unusable frame. Returns `true` if the connection must rest.
  bool unusable(Instant now) {
    owed_ = std::max(Instant::duration::zero(), owed_ - (now - at_)) + kUnusable;
    at_ = now;
    return rest(owed_ - kUnusable * kFree, now);
  }

  /// Counts decompressed bytes in excess of the compressed ones. Returns `true` if the connection
  /// must rest.
  bool inflated(std::size_t surplus, Instant now) {
    return rest(std::chrono::milliseconds(surplus * 1000 / kInflated), now);
  }

  /// The time until which the connection is not read.
  [[nodiscard]] Instant until() const { return until_; }

 private:
  /// The cost of an unusable frame.
  static constexpr std::chrono::milliseconds kUnusable{1};
  /// Number of free unusable frames. They become free again after their cost in time.
  static constexpr int kFree = 256;
  /// Free rate of decompressed bytes in excess of the compressed ones, in bytes per second.
  static constexpr std::size_t kInflated = std::size_t{128} * 1024 * 1024;

  bool rest(Instant::duration cost, Instant now) {
    if (cost <= Instant::duration::zero()) return false;
    until_ = std::max(until_, now + cost);
    return true;
  }

  Instant::duration owed_{0};
  Instant at_;
  Instant until_;
};

/// Returns the bytes by which the data of a frame is longer than as sent.
[[nodiscard]] inline std::size_t surplus_of(const Frame& frame, std::size_t header_length) {
  const std::size_t sent = frame.header.total_length - header_length;
  return frame.data.size() > sent ? frame.data.size() - sent : 0;
}

}  // namespace fc_runtime::detail
