// Work on one thread, in CPU time of this process.
#pragma once

#include <functional>
#include <vector>

namespace bench {

/// How long to measure.
struct Effort {
  /// Rounds of all cases.
  int rounds;
  /// Least seconds of a batch.
  double seconds;
};

/// The middle of some figures.
[[nodiscard]] double median(std::vector<double> figures);

/// CPU time of this process so far, in microseconds.
[[nodiscard]] double cpu();

/// Microseconds that each of some cases takes, the median of its rounds. The cases take turns, in
/// another order each round, so that what disturbs one disturbs all.
[[nodiscard]] std::vector<double> measure(const std::vector<std::function<void()>>& cases,
                                          Effort effort);

}  // namespace bench
