// Compares the package with plain JSON and MD5, and with gRPC.
#include <grpcpp/grpcpp.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>

#include "calls.hpp"
#include "codec.hpp"
#include "worker.hpp"

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kUsage =
    "usage: bench/run [--smoke | --report]\n\n"
    "--smoke   one tiny round: that all of it works, and no figures to go by\n"
    "--report  writes bench/packages/cpp.json, which the page about performance shows\n";

/// Returns the name of the processor, if the system knows it.
std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const auto colon = line.find(": ");
    if (line.rfind("model name", 0) == 0 && colon != std::string::npos) {
      return line.substr(colon + 2);
    }
  }
  return "unknown";
}

std::string today() {
  const std::time_t now = std::time(nullptr);
  char text[16] = {};
  std::strftime(text, sizeof text, "%Y-%m-%d", std::gmtime(&now));
  return text;
}

std::string json_version() {
  return std::to_string(NLOHMANN_JSON_VERSION_MAJOR) + '.' +
         std::to_string(NLOHMANN_JSON_VERSION_MINOR) + '.' +
         std::to_string(NLOHMANN_JSON_VERSION_PATCH);
}

void show(const Json& report) {
  std::printf("Times in microseconds. Floor: JSON and MD5 alone, on the same bytes.\n\n%16s", "");
  for (int side = 0; side < 2; ++side) {
    std::printf("%10s%10s%9s%12s", "floor", "fc", "/ floor", "messages/s");
  }
  for (const auto& one : report["codec"]) {
    std::printf("\n%-8s%8d", one["message"].get<std::string>().c_str(), one["bytes"].get<int>());
    for (const char* what : {"decode", "encode"}) {
      const double least = one[what]["least"];
      const double fc = one[what]["fc"];
      std::printf("%10.2f%10.2f%9.2f%12.0f", least, fc, fc / least, 1e6 / fc);
    }
  }
  std::printf("\n(first decoded, then encoded)\n");
  for (const auto& scenario : report["calls"]) {
    const auto& grpc = scenario["peers"].back();
    std::printf("\nCalls, %d in flight\n%-8s%10s%9s%10s%10s%10s%12s\n",
                scenario["in_flight"].get<int>(), "", "calls/s", "/ gRPC", "p50", "p99", "CPU/call",
                "CPU / gRPC");
    for (const auto& peer : scenario["peers"]) {
      std::printf("%-8s%10.0f%9.2f", peer["name"].get<std::string>().c_str(),
                  peer["rate"].get<double>(),
                  peer["rate"].get<double>() / grpc["rate"].get<double>());
      for (const char* time : {"p50", "p99"}) {
        std::printf("%10s",
                    peer[time].is_null() ? "-" : std::to_string(peer[time].get<int>()).c_str());
      }
      std::printf("%10.2f%12.2f\n", peer["cpu"].get<double>(),
                  peer["cpu"].get<double>() / grpc["cpu"].get<double>());
    }
  }
}

int measured(bool is_smoke, bool is_report) {
  const Json report{
      {"language", "C++"},
      {"date", today()},
      {"processor", processor()},
      {"cores", std::thread::hardware_concurrency()},
      {"versions",
       {{"GCC", __VERSION__}, {"gRPC", grpc::Version()}, {"nlohmann-json", json_version()}}},
      {"json", "nlohmann::json"},
      {"grpc", bench::theirs.name},
      {"goals", {{"codec", 1.5}, {"calls", 2}}},
      {"codec", bench::codec(is_smoke ? bench::Effort{1, 0.001} : bench::Effort{31, 0.01})},
      {"calls", bench::calls(is_smoke ? bench::Effort{1, 0.01} : bench::Effort{9, 0.2})}};
  show(report);
  if (is_report) std::ofstream(FC_BENCH "/packages/cpp.json") << report.dump(2) << '\n';
  return 0;
}

/// Runs a server or caller process.
int work(int count, char** words) {
  for (const auto* peer : bench::peers) {
    if (std::strcmp(peer->name, words[2]) != 0) continue;
    return count == 3 ? bench::serve(*peer) : bench::call(*peer, std::atoi(words[3]));
  }
  return 2;
}

}  // namespace

int main(int count, char** words) {
  const std::string_view first = count > 1 ? words[1] : "";
  try {
    if (count == 1) return measured(false, false);
    if (count == 2 && first == "--smoke") return measured(true, false);
    if (count == 2 && first == "--report") return measured(false, true);
    if ((count == 3 && first == "serve") || (count == 4 && first == "call")) {
      return work(count, words);
    }
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "%s\n", failure.what());
    return 1;
  }
  std::fputs(kUsage, stderr);
  return 2;
}
