#include "measure.hpp"

#include <algorithm>
#include <ctime>
#include <numeric>
#include <random>

namespace bench {

namespace {

double cost(const std::function<void()>& run, int times) {
  const double before = cpu();
  for (int count = 0; count < times; ++count) run();
  return cpu() - before;
}

}  // namespace

double median(std::vector<double> figures) {
  std::sort(figures.begin(), figures.end());
  return figures.at(figures.size() / 2);
}

double cpu() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e6 + static_cast<double>(now.tv_nsec) / 1e3;
}

std::vector<double> measure(const std::vector<std::function<void()>>& cases, Effort effort) {
  std::vector<int> times;
  for (const auto& run : cases) {
    int enough = 1;
    while (cost(run, enough) < effort.seconds * 1e6) enough *= 2;
    times.push_back(enough);
  }
  std::vector<std::size_t> order(cases.size());
  std::iota(order.begin(), order.end(), 0);
  std::mt19937 chance{std::random_device{}()};
  std::vector<std::vector<double>> found(cases.size());
  for (int round = 0; round < effort.rounds; ++round) {
    std::shuffle(order.begin(), order.end(), chance);
    for (const auto at : order) found[at].push_back(cost(cases[at], times[at]) / times[at]);
  }
  std::vector<double> middle;
  for (auto& figures : found) middle.push_back(median(std::move(figures)));
  return middle;
}

}  // namespace bench
