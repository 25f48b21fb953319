// Counts and prints the outcomes of tests.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>

namespace tests {

/// Counts passed and failed checks, and prints the failed ones.
class Tally {
 public:
  void check(bool holds, const std::string& what) {
    (holds ? passed_ : failed_) += 1;
    if (!holds) std::fprintf(stderr, "does not hold: %s\n", what.c_str());
  }

  /// Ends a case. Its kind is from `conformance/README.md`; empty for no kind.
  void end_case(const std::string& kind) {
    if (!kind.empty() && failed_ == failed_before_) ++held_[kind];
    failed_before_ = failed_;
  }

  /// Returns the exit code of `main`. A test with fewer than `least` checks has failed.
  [[nodiscard]] int outcome(const char* of, int least) const {
    std::printf("%d of %d %s\n", passed_, passed_ + failed_, of);
    if (passed_ < least) std::fprintf(stderr, "fewer than %d\n", least);
    say_what_held();
    return failed_ == 0 && passed_ >= least ? 0 : 1;
  }

 private:
  /// Appends a line `KIND NUMBER` for each kind to the file in `FC_CONFORMANCE`, if set.
  void say_what_held() const {
    const char* path = std::getenv("FC_CONFORMANCE");
    std::FILE* file = path == nullptr ? nullptr : std::fopen(path, "a");
    if (file == nullptr) return;
    for (const auto& [kind, number] : held_) std::fprintf(file, "%s %d\n", kind.c_str(), number);
    std::fclose(file);
  }

  int passed_ = 0;
  int failed_ = 0;
  int failed_before_ = 0;
  std::map<std::string, int> held_;
};

}  // namespace tests
