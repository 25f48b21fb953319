// Threads that run handlers.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace fc_runtime::detail {

/// As many threads as are needed at the same time, up to a limit. They get up one by one: who has got up has the next called if
/// there is still work, which mostly is done by then.
class Workers {
 public:
  explicit Workers(std::size_t limit) : limit_(limit > 0 ? limit : 1) {}
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;
  ~Workers() { stop(); }

  void run(std::function<void()> work);
  /// Waits for what is being worked on, and forgets what waits.
  void stop();

 private:
  void work();
  [[nodiscard]] bool calls_another();

  std::size_t limit_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> waiting_;
  std::size_t idle_ = 0;
  /// A thread has been called, and has not come yet.
  bool is_called_ = false;
  bool is_over_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace fc_runtime::detail
