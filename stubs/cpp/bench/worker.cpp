#include "worker.hpp"

#include <fcntl.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <future>
#include <iostream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <thread>
#include <vector>

#include "measure.hpp"
#include "peer.hpp"

namespace bench {

namespace {

using Clock = std::chrono::steady_clock;

double microseconds(Clock::duration time) {
  return std::chrono::duration<double, std::micro>(time).count();
}

/// Makes `calls` calls and measures each.
class Drive {
 public:
  Drive(Asking& asking, int calls) : asking_(&asking), open_(calls), times_(calls) {}

  /// Makes one call after the other.
  void alone() {
    for (double& time : times_) {
      const auto start = Clock::now();
      good_ = asking_->call() && good_;
      time = microseconds(Clock::now() - start);
    }
  }

  /// Keeps `at_once` calls in flight: each completed call starts the next.
  void together(int at_once) {
    for (int index = 0; index < at_once; ++index) next();
    over_.get_future().wait();
  }

  [[nodiscard]] bool good() const { return good_; }

  /// Returns the time at a quantile of all calls.
  [[nodiscard]] double at(double share) {
    std::sort(times_.begin(), times_.end());
    return times_[static_cast<std::size_t>(static_cast<double>(times_.size() - 1) * share)];
  }

 private:
  void next() {
    const std::size_t index = begun_++;
    if (index >= times_.size()) return;
    asking_->begin([this, index, start = Clock::now()](bool is_good) {
      times_[index] = microseconds(Clock::now() - start);
      if (!is_good) good_ = false;
      // Starts the next call first: after the last call, the waiting thread may destroy this
      // object.
      next();
      if (--open_ == 0) over_.set_value();
    });
  }

  Asking* asking_;
  std::atomic<bool> good_{true};
  std::atomic<std::size_t> begun_{0};
  std::atomic<int> open_;
  std::vector<double> times_;
  std::promise<void> over_;
};

std::string drive(const Peer& peer, Asking& asking, int in_flight, int calls) {
  Drive drive(asking, peer.windows ? (calls + in_flight - 1) / in_flight : calls);
  const auto start = Clock::now();
  if (peer.windows || in_flight == 1) {
    drive.alone();
  } else {
    drive.together(in_flight);
  }
  const double seconds = microseconds(Clock::now() - start) / 1e6;
  if (!drive.good()) throw std::runtime_error("not all calls were answered");
  std::ostringstream said;
  said << seconds << ' ' << drive.at(0.5) << ' ' << drive.at(0.99);
  return said.str();
}

/// Prints a reply to each line until the input ends.
template <class Other>
int obey(const std::string& first, const Other& other) {
  std::cout << first << std::endl;
  double begun = 0;
  std::string line;
  while (std::getline(std::cin, line)) {
    if (line == "begin") {
      begun = cpu();
      std::cout << "begun" << std::endl;
    } else if (line == "end") {
      std::cout << cpu() - begun << std::endl;
    } else {
      std::cout << other(line) << std::endl;
    }
  }
  return 0;
}

}  // namespace

int serve(const Peer& peer) {
  const auto answering = peer.answers();
  return obey(std::to_string(answering->port()), [](const std::string& line) { return line; });
}

int call(const Peer& peer, int port) {
  // One connection for all, or one per window size.
  std::map<int, std::unique_ptr<Asking>> asking;
  return obey("ready", [&](const std::string& line) {
    int in_flight = 0;
    int calls = 0;
    std::istringstream(line) >> in_flight >> calls;
    auto& one = asking[peer.windows ? in_flight : 1];
    if (!one) one = peer.asks(static_cast<std::uint16_t>(port), in_flight);
    return drive(peer, *one, in_flight, calls);
  });
}

Worker::Worker(int core, const std::string& words) {
  std::array<int, 2> in{};
  std::array<int, 2> out{};
  if (pipe2(in.data(), O_CLOEXEC) != 0 || pipe2(out.data(), O_CLOEXEC) != 0) {
    throw std::runtime_error("no pipe can be had");
  }
  std::istringstream split(words);
  std::vector<std::string> arguments{"bench"};
  for (std::string word; split >> word;) arguments.push_back(word);
  std::vector<char*> pointers;
  for (auto& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  const bool has_cores = std::thread::hardware_concurrency() > 1;
  process_ = fork();
  if (process_ < 0) throw std::runtime_error("no process can be had");
  if (process_ == 0) {
    dup2(in[0], STDIN_FILENO);
    dup2(out[1], STDOUT_FILENO);
    if (has_cores) {
      cpu_set_t set;
      CPU_ZERO(&set);
      CPU_SET(core, &set);
      // Without permission, the process shares its core.
      sched_setaffinity(0, sizeof set, &set);
    }
    execv("/proc/self/exe", pointers.data());
    _exit(127);
  }
  close(in[0]);
  close(out[1]);
  questions_ = fdopen(in[1], "w");
  answers_ = fdopen(out[0], "r");
  first_ = answer();
}

Worker::~Worker() {
  // Closing its input ends the process.
  std::fclose(questions_);
  std::fclose(answers_);
  waitpid(process_, nullptr, 0);
}

std::string Worker::answer() {
  std::string line;
  for (int next = std::fgetc(answers_); next != '\n'; next = std::fgetc(answers_)) {
    if (next == EOF) throw std::runtime_error("a process has ended");
    line += static_cast<char>(next);
  }
  return line;
}

std::string Worker::ask(const std::string& question) {
  std::fprintf(questions_, "%s\n", question.c_str());
  std::fflush(questions_);
  return answer();
}

}  // namespace bench
