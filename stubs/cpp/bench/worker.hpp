// A process that answers, or one that asks, on a core of its own.
#pragma once

#include <sys/types.h>

#include <cstdio>
#include <string>

namespace bench {

struct Peer;

/// Serves a peer and says at which port; then does what it is told, until its input ends: `begin`
/// and `end` are around what costs CPU time, which `end` answers in microseconds.
int serve(const Peer& peer);

/// Calls a peer at a port, and does what it is told: also `IN_FLIGHT CALLS`, which is answered by
/// seconds, and by the time of the middle call and of one of the slowest of a hundred in microseconds.
int call(const Peer& peer, int port);

/// Such a process, started.
class Worker {
 public:
  /// Starts this program with other words, on a core where there are several.
  Worker(int core, const std::string& words);
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;
  ~Worker();

  /// Asks, and waits for the answer.
  std::string ask(const std::string& question);
  /// What it has said first.
  [[nodiscard]] const std::string& first() const { return first_; }

 private:
  std::string answer();

  pid_t process_ = 0;
  std::FILE* questions_ = nullptr;
  std::FILE* answers_ = nullptr;
  std::string first_;
};

}  // namespace bench
