// Threads that run handlers.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
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

  /// Runs some work and sets `settled`, unless that has been set before.
  void run(std::function<void()> work,
           std::shared_ptr<std::atomic<bool>> settled = std::make_shared<std::atomic<bool>>(false));
  /// Waits for what is being worked on, and forgets what waits.
  void stop();

 private:
  struct Waiting {
    std::function<void()> work;
    std::shared_ptr<std::atomic<bool>> settled;
  };

  void work();
  void forget_settled();
  [[nodiscard]] bool calls_another();

  static constexpr std::size_t kLeast = 1024;

  std::size_t limit_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Waiting> waiting_;
  /// The length of the queue at which settled work is removed from it.
  std::size_t longest_ = kLeast;
  std::size_t idle_ = 0;
  /// A thread has been called, and has not come yet.
  bool is_called_ = false;
  bool is_over_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace fc_runtime::detail
