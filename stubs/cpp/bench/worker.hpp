// A server or caller process on its own core.
#pragma once

#include <sys/types.h>

#include <cstdio>
#include <string>

namespace bench {

struct Peer;

/// Serves a peer, prints its port, and obeys its input. `begin` starts a measurement; `end` prints
/// its CPU time in microseconds.
int serve(const Peer& peer);

/// Calls a peer at a port and obeys its input. In addition to `begin` and `end`, the line
/// `IN_FLIGHT CALLS` runs a round. It prints the seconds of the round, and the median and 99th
/// percentile of a call in microseconds.
int call(const Peer& peer, int port);

/// A started worker process.
class Worker {
 public:
  /// Starts this program with the arguments `words`, on its own core if there are several.
  Worker(int core, const std::string& words);
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;
  ~Worker();

  /// Sends a line and waits for the reply.
  std::string ask(const std::string& question);
  /// The first line of its output.
  [[nodiscard]] const std::string& first() const { return first_; }

 private:
  std::string answer();

  pid_t process_ = 0;
  std::FILE* questions_ = nullptr;
  std::FILE* answers_ = nullptr;
  std::string first_;
};

}  // namespace bench
