// An app that tests a robot. It calls every command with the example in the spec, receives the
// reports and the picture of a map, and prints the outcome of each.
#include <map>
#include <set>
#include <type_traits>

#include "fc/client.hpp"
#include "support.hpp"

namespace {

constexpr const char* kUsage =
    "Calls every command of a robot and prints what came of it.\n\n"
    "Usage: app [--host 127.0.0.1] [--command-port PORT] [--data-port PORT] "
    "[--gzip-from BYTES]\n           [--lang zh|en]\n\n"
    "Without ports, those of the spec. With --gzip-from, whatever has so many bytes is "
    "compressed.\nWithout --lang, the language of the environment.\n";

/// Longest wait for data that the robot sends unasked.
constexpr std::chrono::seconds kPatience{20};

/// The outcome of each operation so far.
class Tour {
 public:
  explicit Tour(bool is_chinese) : is_chinese_(is_chinese) {
    table_.row({pick("功能码", "Code"), pick("类型", "Kind"), pick("名称", "Name"),
                pick("说明", "Title"), pick("结果", "Outcome")});
  }

  /// Returns the string in the language of the user.
  template <typename T>
  [[nodiscard]] T pick(T zh, T en) const {
    return is_chinese_ ? zh : en;
  }

  void add(fc_runtime::OperationKind kind, std::uint16_t code, const char* what, bool good,
           const std::string& outcome) {
    const auto* known = fc::protocol().find(kind, code);
    char spelled[8];
    std::snprintf(spelled, sizeof spelled, "0x%04X", code);
    table_.row({spelled, what, known != nullptr ? std::string(known->name) : "",
                known != nullptr ? std::string(pick(known->zh, known->en)) : "", outcome});
    if (!good) ++failed_;
  }

  [[nodiscard]] int failed() const { return failed_; }
  void print() const { table_.print(); }

 private:
  bool is_chinese_;
  Table table_;
  int failed_ = 0;
};

void call_all(const fc::Client& client, Tour& tour) {
  fc::for_each_command([&](const auto& any) {
    using Request = std::decay_t<decltype(any)>;
    const auto answer = client.connection().call(fc_runtime::example<Request>());
    tour.add(fc_runtime::OperationKind::Command, fc_runtime::Command<Request>::code,
             tour.pick("指令", "command"), answer.has_value(),
             answer ? tour.pick("成功", "answered") : to_string(answer.error()));
  });
}

/// Waits until every report has arrived once.
bool receive_all(const fc::Reports& reports, Tour& tour) {
  std::set<std::uint16_t> missing;
  fc::for_each_report([&](const auto& any) {
    missing.insert(fc_runtime::Report<std::decay_t<decltype(any)>>::code);
  });
  const auto until = std::chrono::steady_clock::now() + kPatience;
  while (!missing.empty() && std::chrono::steady_clock::now() < until) {
    const auto report = reports.next(kPatience);
    if (!report) break;
    const std::uint16_t code = std::visit(
        [](const auto& known) -> std::uint16_t {
          using Message = std::decay_t<decltype(known)>;
          if constexpr (std::is_same_v<Message, fc_runtime::RawReport>) {
            return known.code;
          } else {
            return fc_runtime::Report<Message>::code;
          }
        },
        *report);
    if (missing.erase(code) > 0) {
      tour.add(fc_runtime::OperationKind::Report, code, tour.pick("主动上报", "report"), true,
               tour.pick("收到", "received"));
    }
  }
  for (const std::uint16_t code : missing) {
    std::fprintf(stderr, "no report 0x%04X for a while\n", code);
  }
  return missing.empty();
}

/// Waits for the picture that the call for a map image requested. The runtime has verified its
/// digest.
bool receive_picture(const fc_runtime::DataConnection& data, Tour& tour) {
  const auto frame = data.next(kPatience);
  if (!frame) {
    std::fprintf(stderr, "no picture came: %s\n", to_string(frame.error()).c_str());
    return false;
  }
  const bool is_asked_for = frame->code == fc_runtime::Command<fc::GetMapImageRequest>::code;
  const auto size = std::to_string(frame->data.size());
  const auto id = std::to_string(frame->id);
  tour.add(fc_runtime::OperationKind::Command, frame->code, tour.pick("数据流", "stream"),
           is_asked_for,
           tour.pick("收到 " + size + " 字节，msgId " + id + "，MD5 一致",
                     "received " + size + " bytes, msgId " + id + ", MD5 verified"));
  return true;
}

}  // namespace

int main(int count, char** words) {
  const Args args = parse(count, words, kUsage);
  const auto client = fc::Client::connect(client_of(args));
  if (!client) {
    std::fprintf(stderr, "cannot connect: %s\n", to_string(client.error()).c_str());
    return 1;
  }
  const fc::Reports reports = client->reports();
  const auto data = client->data();
  if (const auto connected = data.connected(); !connected) {
    std::fprintf(stderr, "no data connection: %s\n", to_string(connected.error()).c_str());
    return 1;
  }
  Tour tour(args.is_chinese);
  call_all(*client, tour);
  const bool all_came = receive_all(reports, tour) && receive_picture(data, tour);
  tour.print();
  if (tour.failed() > 0) std::fprintf(stderr, "%d operations failed\n", tour.failed());
  return all_came && tour.failed() == 0 ? 0 : 1;
}
