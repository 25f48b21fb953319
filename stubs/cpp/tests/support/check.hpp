// What tests say of what they find.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>

namespace tests {

/// Counts what holds and what does not, and says of the latter where it is.
class Tally {
 public:
  void check(bool holds, const std::string& what) {
    (holds ? passed_ : failed_) += 1;
    if (!holds) std::fprintf(stderr, "does not hold: %s\n", what.c_str());
  }

  /// What has been checked since the last case was one of a kind of `conformance/README.md`; of none, if it is empty.
  void end_case(const std::string& kind) {
    if (!kind.empty() && failed_ == failed_before_) ++held_[kind];
    failed_before_ = failed_;
  }

  /// What `main` gives back: a test that looked at less than it should has failed.
  [[nodiscard]] int outcome(const char* of, int least) const {
    std::printf("%d of %d %s\n", passed_, passed_ + failed_, of);
    if (passed_ < least) std::fprintf(stderr, "fewer than %d\n", least);
    say_what_held();
    return failed_ == 0 && passed_ >= least ? 0 : 1;
  }

 private:
  /// A line `KIND NUMBER` for each behind what is in the file that `FC_CONFORMANCE` names, if it names one.
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
