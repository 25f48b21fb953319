// Bodies at the limits of JSON (`bodies.json`), read as messages with one key and written again.
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "fc_runtime/codec.hpp"
#include "support/check.hpp"
#include "support/hex.hpp"

template <class T>
struct OneKey {
  std::optional<T> value;
  fc_runtime::Extra extra;

  friend bool operator==(const OneKey& left, const OneKey& right) {
    return fc_runtime::Codec<OneKey>::equal(left, right);
  }
};

template <class T>
struct fc_runtime::Fields<OneKey<T>> {
  static constexpr std::string_view name = "OneKey";
  static constexpr std::string_view example = "{}";
  template <class Visitor, class Message>
  static void each(Visitor& visit, Message& message) {
    constexpr Field field("value");
    if constexpr (std::is_same_v<T, Bytes>) {
      visit(field.base64(), message.value);
    } else {
      visit(field, message.value);
    }
  }
  static void conditions(Conditions& /*asked*/, const OneKey<T>& /*message*/) {}
};

namespace {

using Outcome = fc_runtime::Result<std::string, fc_runtime::BodyError>;

template <class T>
Outcome transcode(const std::string& text) {
  auto read = fc_runtime::from_json<OneKey<T>>(text);
  if (!read) return read.error();
  if (!(*read == *read)) return fc_runtime::BodyError{};
  return fc_runtime::to_json(*read);
}

template <class T>
std::string printed(T value) {
  std::ostringstream out;
  out << std::setprecision(2);
  fc_runtime::Codec<OneKey<T>>::print(out, OneKey<T>{std::move(value), {}});
  return out.str();
}

std::optional<Outcome> transcode_as(const std::string& type, const std::string& text) {
  if (type == "i8") return transcode<std::int8_t>(text);
  if (type == "i16") return transcode<std::int16_t>(text);
  if (type == "i32") return transcode<std::int32_t>(text);
  if (type == "i64" || type == "timestamp_ms" || type == "timestamp_s") {
    return transcode<std::int64_t>(text);
  }
  if (type == "u8") return transcode<std::uint8_t>(text);
  if (type == "u16") return transcode<std::uint16_t>(text);
  if (type == "u32") return transcode<std::uint32_t>(text);
  if (type == "u64") return transcode<std::uint64_t>(text);
  if (type == "f32") return transcode<float>(text);
  if (type == "f64") return transcode<double>(text);
  if (type == "string") return transcode<std::string>(text);
  if (type == "base64") return transcode<fc_runtime::Bytes>(text);
  if (type == "json") return transcode<fc_runtime::Json>(text);
  if (type == "object") return transcode<OneKey<std::int32_t>>(text);
  return std::nullopt;
}

/// Returns `true` if the texts are equal. Floats and the escapes of strings may have another
/// spelling.
bool is_as_written(const std::string& type, const std::string& found, const std::string& wanted) {
  if (found == wanted) return true;
  const bool may_differ = type == "f32" || type == "f64" || type == "string";
  return may_differ && nlohmann::json::parse(found) == nlohmann::json::parse(wanted);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fprintf(stderr, "usage: bodies bodies.json\n");
    return 2;
  }
  std::ifstream file(arguments[1]);
  const auto vectors = nlohmann::json::parse(file);
  tests::Tally tally;
  for (const char* list : {"accepted", "rejected"}) {
    const bool accepted = std::string(list) == "accepted";
    for (const auto& vector : vectors.at(list)) {
      const std::string type = vector.at("type");
      const auto outcome = transcode_as(type, tests::unhex(vector.at("bytes")));
      const std::string wanted = vector.at(accepted ? "written" : "error");
      std::string found = "a type that this test does not know";
      bool good = false;
      if (outcome && *outcome) {
        found = **outcome;
        good = accepted && is_as_written(type, found, wanted);
      } else if (outcome) {
        found = to_string(outcome->error());
        good = !accepted && outcome->error().name() == wanted;
      }
      const std::string name = vector.at("name");
      tally.check(good, name + ": wanted " + wanted + ", found " + found);
      tally.end_case("bodies");
    }
  }
  // A printed float parses to the same number, whatever the settings of the stream.
  tally.check(printed(12345.6789) == "OneKey{value: 12345.6789}", printed(12345.6789));
  tally.check(printed(0.1F) == "OneKey{value: 0.1}", printed(0.1F));
  tally.check(printed(5.0) == "OneKey{value: 5.0}", printed(5.0));
  tally.check(printed(-1e300) == "OneKey{value: -1e+300}", printed(-1e300));
  for (const double none : {-INFINITY, INFINITY, NAN}) {
    const auto text = printed(std::vector<double>{none, 0.5});
    const std::string name = std::isnan(none) ? "nan" : none > 0 ? "inf" : "-inf";
    tally.check(text == "OneKey{value: [" + name + ", 0.5]}", text);
  }
  // Unknown keys and JSON are sent exactly as received.
  for (const std::string& odd :
       {std::string(
            R"({"value":{ "a" : [ 1.50, 1E+2 , "\u00e9\/" ] , "a":null},"k\u0065y":{"b" : -0.0 },)"
            R"("\/":"\ud83d\ude00","key":[ ]})"),
        std::string(R"({"x":"\ud800","x":1,"y":{ "z":9007199254740993 }})")}) {
    const auto read = fc_runtime::from_json<OneKey<fc_runtime::Json>>(odd);
    const auto again = read ? fc_runtime::to_json(*read) : read.error();
    tally.check(again && *again == odd, "byte for byte: " + again.value_or(""));
  }
  auto kept = *fc_runtime::from_json<OneKey<int>>(R"({"k\u0065y":1,"other":"\/","key":2})");
  tally.check(kept.extra.get("key") == fc_runtime::Json::integer(2), "a key by its name");
  kept.extra.set("key", fc_runtime::Json::integer(3));
  tally.check(fc_runtime::to_json(kept).value_or("") == R"({"k\u0065y":3,"other":"\/"})", "is set");
  kept.extra.erase("key");
  tally.check(fc_runtime::to_json(kept).value_or("") == R"({"other":"\/"})", "and taken out");
  // Values are counted during reading: the rest of the text costs nothing.
  std::string lists = "{";
  for (int at = 0; at < 100'000; ++at) lists += R"("a":[[]],)";
  fc_runtime::Allowance few;
  few.values = 1000;
  const auto many = fc_runtime::from_json<OneKey<int>>(lists + R"("a":0})", few);
  tally.check(!many && many.error().name() == "too_many_values" && many.error().offset < 20'000,
              "a hundred thousand lists");
  fc_runtime::Allowance small;
  small.list_bytes = 1000;
  std::string numbers = "1";
  for (int at = 0; at < 1000; ++at) numbers += ",1";
  const auto wide = fc_runtime::from_json<OneKey<std::vector<std::int32_t>>>(
      "{\"value\":[" + numbers + "]}", small);
  tally.check(!wide && wide.error().name() == "lists_too_large", "a thousand numbers");
  // Nesting far beyond the stack is refused by the depth limit.
  const auto deep =
      fc_runtime::from_json<OneKey<fc_runtime::Json>>("{\"value\":" + std::string(100'000, '['));
  tally.check(!deep && deep.error().name() == "too_deep", "a hundred thousand brackets");
  return tally.outcome("bodies", 200);
}
