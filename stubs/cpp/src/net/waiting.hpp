// A value passed from one thread to another.
#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <utility>

namespace fc_runtime::detail {

/// A slot for one value. Both threads share ownership: the giver may still use it when the taker is
/// done.
template <class T>
class Waiting {
 public:
  void give(T value) {
    {
      const std::lock_guard held(mutex_);
      value_.emplace(std::move(value));
    }
    given_.notify_one();
  }
  T take() {
    std::unique_lock held(mutex_);
    given_.wait(held, [this] { return value_.has_value(); });
    return *std::move(value_);
  }

 private:
  std::mutex mutex_;
  std::condition_variable given_;
  std::optional<T> value_;
};

}  // namespace fc_runtime::detail
