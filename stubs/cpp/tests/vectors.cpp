// Every golden frame is read as its typed message and written again, or refused.
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "fc/protocol.hpp"
#include "fc_runtime/frame.hpp"
#include "support/check.hpp"
#include "support/hex.hpp"
#include "support/transcode.hpp"

namespace {

using nlohmann::json;

/// The outcome of reading a vector: the data of its frame, or the name of the error.
struct Read {
  std::string data;
  std::string error;
};

Read read_frame(const json& vector) {
  if (vector.contains("text")) return {vector["text"], ""};
  const std::string bytes = tests::unhex(vector.at("frame"));
  fc_runtime::Decoder decoder(fc::protocol());
  decoder.push(bytes);
  const auto next = decoder.next();
  if (!next) return {"", std::string(next.error().name())};
  if (!*next) return {"", std::string(decoder.finish()->name())};
  return {std::string((*next)->data), ""};
}

/// Reads a body as its typed message and writes it again, or returns the name of the error.
Read transcode(const json& vector, const fc_runtime::OperationInfo& operation,
               const std::string& text) {
  auto again = tests::transcode(operation, vector.at("direction") == "request", text);
  if (!again) return {"", std::string(again.error().name())};
  return {*std::move(again), ""};
}

void accepted(tests::Tally& tally, const std::string& stem,
              const fc_runtime::OperationInfo& operation, const json& vector) {
  const std::string name = stem + " " + vector.at("name").get<std::string>();
  const Read frame = read_frame(vector);
  tally.check(frame.error.empty(), name + " " + frame.error);
  if (vector.contains("data")) {
    tally.check(tests::hex(frame.data) == vector["data"], name);
    return;
  }
  const Read body = transcode(vector, operation, frame.data);
  const json& wanted = vector.contains("canonical") ? vector["canonical"] : vector["body"];
  const json found = body.error.empty() ? json::parse(body.data) : json(body.error);
  tally.check(found == wanted, name + ": wanted " + wanted.dump() + ", found " + found.dump());
  if (vector.at("case") == "plain" && vector.contains("frame")) {
    std::string again;
    fc_runtime::Decoder decoder(fc::protocol());
    const std::string bytes = tests::unhex(vector["frame"]);
    decoder.push(bytes);
    const auto id = (**decoder.next()).header.frame;
    const auto written = fc_runtime::Encoder(fc::protocol()).append(again, id, body.data);
    tally.check(written && again == bytes, name + ", byte for byte: " + body.data);
  }
}

void rejected(tests::Tally& tally, const std::string& stem,
              const fc_runtime::OperationInfo& operation, const json& vector) {
  const std::string name = stem + " " + vector.at("name").get<std::string>();
  Read found = read_frame(vector);
  if (found.error.empty()) found = transcode(vector, operation, found.data);
  const std::string wanted = vector.at("error");
  tally.check(found.error == wanted, name + ": wanted " + wanted + ", found " + found.error);
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 2) return 2;
  tests::Tally tally;
  for (const auto& entry : std::filesystem::directory_iterator(arguments[1])) {
    const std::string stem = entry.path().stem().string();
    if (entry.path().extension() != ".json" || stem == "bodies" || stem == "frames") continue;
    std::ifstream file(entry.path());
    const json vectors = json::parse(file);
    const fc_runtime::OperationInfo* operation = nullptr;
    for (const auto& known : fc::protocol().operations) {
      if (known.name == vectors.at("operation").get<std::string>()) operation = &known;
    }
    tally.check(operation != nullptr, stem + " is no operation");
    if (operation == nullptr) continue;
    for (const json& vector : vectors.at("accepted")) {
      accepted(tally, stem, *operation, vector);
      tally.end_case("accepted");
    }
    for (const json& vector : vectors.at("rejected")) {
      rejected(tally, stem, *operation, vector);
      tally.end_case("rejected");
    }
  }
  const int least = count > 2 ? std::stoi(arguments[2]) : 1900;
  return tally.outcome("golden frames and bodies", least);
}
