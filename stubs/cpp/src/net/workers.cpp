#include "workers.hpp"

#include <algorithm>

namespace fc_runtime::detail {

void Workers::run(std::function<void()> work, std::shared_ptr<std::atomic<bool>> settled) {
  {
    const std::lock_guard held(mutex_);
    if (is_over_) return;
    if (waiting_.size() >= longest_) forget_settled();
    waiting_.push_back({std::move(work), std::move(settled)});
    if (!calls_another()) return;
  }
  changed_.notify_one();
}

/// Removes settled work. The queue thus has at most twice as many entries as open work.
void Workers::forget_settled() {
  const auto is_settled = [](const Waiting& waiting) { return waiting.settled->load(); };
  waiting_.erase(std::remove_if(waiting_.begin(), waiting_.end(), is_settled), waiting_.end());
  longest_ = std::max(kLeast, 2 * waiting_.size());
}

/// Returns `true` if an idle thread is to be notified after the mutex is released. Starts a thread
/// if none is idle.
bool Workers::calls_another() {
  if (is_called_ || waiting_.empty() || is_over_) return false;
  if (idle_ > 0) return is_called_ = true;
  if (threads_.size() == limit_) return false;
  is_called_ = true;
  threads_.emplace_back([this] { this->work(); });
  return false;
}

void Workers::work() {
  std::unique_lock held(mutex_);
  is_called_ = false;
  for (;;) {
    while (waiting_.empty() && !is_over_) {
      ++idle_;
      changed_.wait(held);
      --idle_;
      is_called_ = false;
    }
    if (is_over_) return;
    const Waiting next = std::move(waiting_.front());
    waiting_.pop_front();
    const bool calls = calls_another();
    held.unlock();
    if (calls) changed_.notify_one();
    if (!next.settled->exchange(true)) next.work();
    held.lock();
  }
}

void Workers::stop() {
  std::vector<std::thread> threads;
  {
    const std::lock_guard held(mutex_);
    is_over_ = true;
    waiting_.clear();
    threads.swap(threads_);
    changed_.notify_all();
  }
  for (auto& thread : threads) thread.join();
}

}  // namespace fc_runtime::detail
