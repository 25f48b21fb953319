// Measures work on one thread, in CPU time of this process.
#pragma once

#include <functional>
#include <vector>

namespace bench {

/// The length of a measurement.
struct Effort {
  /// Rounds over all cases.
  int rounds;
  /// Least length of a batch, in seconds.
  double seconds;
};

/// Returns the median.
[[nodiscard]] double median(std::vector<double> figures);

/// Returns the CPU time of this process so far, in microseconds.
[[nodiscard]] double cpu();

/// Returns the time of each case in microseconds, the median of its rounds. Each round runs the
/// cases in another order, so that a disturbance affects them all.
[[nodiscard]] std::vector<double> measure(const std::vector<std::function<void()>>& cases,
                                          Effort effort);

}  // namespace bench
