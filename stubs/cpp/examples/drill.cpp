// An app that tests a connection under external disturbance. It continues to read while the
// connection is cut, cancels calls, and calls while the robot shuts down.
#include <atomic>
#include <mutex>
#include <optional>
#include <thread>

#include "fc/client.hpp"
#include "support.hpp"

namespace {

constexpr const char* kUsage =
    "Tries out the connection to a robot: reads while it is cut, gives calls up, calls while the "
    "robot ends.\n\n"
    "Usage: drill [--host 127.0.0.1] [--command-port PORT] [--gzip-from BYTES]\n\n"
    "From `reading` on the connection may be cut; `calling` asks for the robot to be ended.\n";

/// Calls in flight at a time.
constexpr int kAtOnce = 64;
/// Reads that must succeed although the connection is cut.
constexpr int kReads = 1000;

using Fault = std::optional<fc_runtime::CallError>;

/// Runs `kAtOnce` threads and returns the first error.
template <class Work>
Fault all(const Work& work) {
  std::mutex mutex;
  Fault first;
  std::vector<std::thread> threads;
  for (int at = 0; at < kAtOnce; ++at) {
    threads.emplace_back([&] {
      Fault fault = work();
      const std::lock_guard held(mutex);
      if (fault && !first) first = std::move(fault);
    });
  }
  for (auto& thread : threads) thread.join();
  return first;
}

Fault call(const fc::Client& client) {
  auto answer = client.get_robot_sn({});
  if (answer) return std::nullopt;
  return std::move(answer).error();
}

/// Each call is a read and is repeated after a loss, so every call succeeds.
Fault read(const fc::Client& client) {
  std::atomic<int> left{kReads};
  return all([&]() -> Fault {
    while (left.fetch_sub(1) > 0) {
      if (Fault fault = call(client)) return fault;
    }
    return std::nullopt;
  });
}

/// Sends calls and cancels them before a response can arrive. The connection remains usable.
Fault give_up(const fc::Client& client) {
  std::vector<fc_runtime::PendingCall> calls;
  for (int at = 0; at < kAtOnce; ++at) {
    // The outcome is ignored.
    calls.push_back(client.connection().call_async(fc::GetRobotSnRequest{}, [](const auto&) {}));
  }
  for (const auto& pending : calls) pending.cancel();
  return call(client);
}

/// Calls until the robot has gone. Every call ends, and the last ones report a lost connection.
Fault call_to_the_end(const fc::Client& client, std::atomic<int>& answered) {
  return all([&]() -> Fault {
    for (;;) {
      Fault fault = call(client);
      if (!fault) {
        answered.fetch_add(1);
      } else if (fault->loss) {
        return std::nullopt;
      } else {
        return fault;
      }
    }
  });
}

int failed(const std::string& why) {
  std::fprintf(stderr, "%s\n", why.c_str());
  return 1;
}

void say(const std::string& line) {
  std::puts(line.c_str());
  std::fflush(stdout);
}

}  // namespace

int main(int count, char** words) {
  const Args args = parse(count, words, kUsage);
  fc_runtime::ClientConfig config = client_of(args);
  {
    const auto client = fc::Client::connect(config);
    if (!client) return failed(to_string(client.error()));
    say("reading");
    if (const Fault fault = read(*client)) return failed(to_string(*fault));
    say("read: " + std::to_string(kReads) + " answered");
    if (const Fault fault = give_up(*client)) return failed(to_string(*fault));
    say("given up: " + std::to_string(kAtOnce) + ", and the next one answered");
  }
  // A client without reconnection: the end of the robot ends its calls.
  config.reconnect = std::nullopt;
  const auto client = fc::Client::connect(config);
  if (!client) return failed(to_string(client.error()));
  say("calling");
  std::atomic<int> answered{0};
  if (const Fault fault = call_to_the_end(*client, answered)) return failed(to_string(*fault));
  say("ended: " + std::to_string(answered.load()) + " answered, " + std::to_string(kAtOnce) +
      " lost");
  return 0;
}
