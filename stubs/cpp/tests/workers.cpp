// The threads of handlers: each handler gets one, up to the limit.
#include "../src/net/workers.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <vector>

#include "support/check.hpp"

namespace {

using tests::Tally;

/// Time after which a test has failed. No passing test waits so long.
constexpr std::chrono::seconds kPatience{20};

/// A barrier for a number of threads.
class Meeting {
 public:
  explicit Meeting(int all) : missing_(all) {}
  bool join() {
    std::unique_lock held(mutex_);
    --missing_;
    changed_.notify_all();
    return wait(held);
  }
  bool has_met() {
    std::unique_lock held(mutex_);
    return wait(held);
  }

 private:
  bool wait(std::unique_lock<std::mutex>& held) {
    return changed_.wait_for(held, kPatience, [this] { return missing_ == 0; });
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  int missing_;
};

constexpr int kThreads = 8;

void all_at_once(Tally& tally) {
  fc_runtime::detail::Workers workers(kThreads);
  // New threads first, then idle ones; one by one, and many at once.
  for (const int heap : {kThreads, kThreads, 1, 3, kThreads}) {
    // Some threads may still leave the barrier when the next round begins.
    const auto meeting = std::make_shared<Meeting>(heap);
    for (int one = 0; one < heap; ++one) workers.run([meeting] { meeting->join(); });
    tally.check(meeting->has_met(), "work that waits for other work gets a thread each");
  }
}

void in_turn(Tally& tally) {
  Meeting first(kThreads + 1);
  Meeting second(kThreads);
  fc_runtime::detail::Workers workers(kThreads);
  for (int one = 0; one < kThreads; ++one) workers.run([&first] { first.join(); });
  for (int one = 0; one < kThreads; ++one) workers.run([&second] { second.join(); });
  tally.check(first.join(), "as many as there are threads");
  tally.check(second.has_met(), "and the others when these are free");
}

/// Settled work does not run, and does not accumulate.
void settled(Tally& tally) {
  Meeting first(2);
  std::atomic<int> done{0};
  fc_runtime::detail::Workers workers(1);
  workers.run([&first] { first.join(); });
  std::vector<std::weak_ptr<std::atomic<bool>>> dropped;
  for (int at = 0; at < 100'000; ++at) {
    const auto is_settled = std::make_shared<std::atomic<bool>>(false);
    workers.run([&done] { ++done; }, is_settled);
    *is_settled = true;
    dropped.push_back(is_settled);
  }
  const auto is_left = [](const auto& one) { return !one.expired(); };
  tally.check(std::count_if(dropped.begin(), dropped.end(), is_left) < 3000, "it is forgotten");
  Meeting last(2);
  workers.run([&last] { last.join(); });
  first.join();
  last.join();
  tally.check(done == 0, "and not done");
}

}  // namespace

int main() {
  Tally tally;
  for (const auto test : {all_at_once, in_turn, settled}) test(tally);
  return tally.outcome("things about threads", 3);
}
