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

/// A thread pool that grows up to a limit. Threads wake one by one: each calls the next if there is
/// still work. Mostly the work is done by then.
class Workers {
 public:
  explicit Workers(std::size_t limit) : limit_(limit > 0 ? limit : 1) {}
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;
  ~Workers() { stop(); }

  /// Runs some work and sets `settled`, unless it was set before.
  void run(std::function<void()> work,
           std::shared_ptr<std::atomic<bool>> settled = std::make_shared<std::atomic<bool>>(false));
  /// Waits for running work, and drops queued work.
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
  /// The length of the queue at which settled work is removed.
  std::size_t longest_ = kLeast;
  std::size_t idle_ = 0;
  /// `true` if a thread was called and has not arrived yet.
  bool is_called_ = false;
  bool is_over_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace fc_runtime::detail
