// A log for tests.
#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "fc_runtime/log.hpp"

namespace tests {

/// The lines of a log.
class Lines {
 public:
  [[nodiscard]] fc_runtime::Log log() {
    return [this](fc_runtime::LogLevel level, std::string_view line) {
      const std::lock_guard held(mutex_);
      lines_.push_back(std::string(name(level)) + " " + std::string(line));
      changed_.notify_all();
    };
  }
  /// Waits for a line that contains `part`.
  bool has(const std::string& part) {
    std::unique_lock held(mutex_);
    return changed_.wait_for(held, std::chrono::seconds(20), [&] { return is_there(part); });
  }
  bool has_now(const std::string& part) {
    const std::lock_guard held(mutex_);
    return is_there(part);
  }

 private:
  [[nodiscard]] bool is_there(const std::string& part) const {
    return std::any_of(lines_.begin(), lines_.end(), [&](const std::string& line) {
      return line.find(part) != std::string::npos;
    });
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::string> lines_;
};

}  // namespace tests
