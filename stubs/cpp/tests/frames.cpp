// Every golden frame is read and written again, with only the envelope of its body.
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "fc_runtime/envelope.hpp"
#include "fc_runtime/frame.hpp"
#include "support/check.hpp"
#include "support/fc.hpp"
#include "support/hex.hpp"

namespace {

using fc_runtime::Decoder;
using fc_runtime::Encoder;
using fc_runtime::Frame;
using fc_runtime::FrameError;
using nlohmann::json;

const fc_runtime::Protocol& protocol() {
  static const fc_runtime::Protocol fc = tests::fc_protocol();
  return fc;
}

/// Names of errors that need no type.
const std::set<std::string> kOfAnyBody = {"not_utf8", "bad_json", "not_an_object", "too_deep"};

/// The outcome of reading bytes in steps of `step`: a frame and its data, or the name of the error.
struct Read {
  std::optional<fc_runtime::Header> header;
  std::string data;
  std::string error;
};

Read read(const std::string& bytes, std::size_t step) {
  Decoder decoder(protocol());
  Read out;
  for (std::size_t at = 0; at < bytes.size(); at += step) {
    decoder.push(std::string_view(bytes).substr(at, step));
    const auto next = decoder.next();
    if (!next) {
      out.error = next.error().name();
      return out;
    }
    if (!*next) continue;
    out.header = (*next)->header;
    out.data = (*next)->data;
  }
  if (const auto error = decoder.finish()) out.error = error->name();
  return out;
}

const std::vector<fc_runtime::EnvelopeKey>& envelope_of(const json& vector) {
  const bool is_request = vector.at("direction") == "request";
  return is_request ? protocol().request_envelope : protocol().response_envelope;
}

/// Returns the error in the body of a frame that is not a stream, as far as it needs no type.
std::string body_error(const json& vector, const std::string& text) {
  const auto envelope =
      fc_runtime::read_envelope(envelope_of(vector), text, protocol().defaults.limits.json());
  return envelope ? "" : std::string(envelope.error().name());
}

void accepted(tests::Tally& tally, const std::string& file, const json& vector) {
  const std::string name = file + " " + vector.at("name").get<std::string>();
  const std::string bytes = tests::unhex(vector.at("frame"));
  for (const std::size_t step : {bytes.size(), std::size_t{1}, std::size_t{7}}) {
    const Read frame = read(bytes, step);
    tally.check(frame.error.empty() && frame.header, name + " " + frame.error);
    if (!frame.header) return;
    if (vector.contains("data")) tally.check(tests::hex(frame.data) == vector["data"], name);
    if (vector.contains("body")) {
      tally.check(json::parse(frame.data.empty() ? "{}" : frame.data) == vector["body"], name);
      tally.check(body_error(vector, frame.data).empty(), name + ", its envelope");
    }
    if (vector.contains("header")) {
      const json& header = vector["header"];
      tally.check(header.at("kind") == frame.header->frame.kind &&
                      header.at("code") == frame.header->frame.code &&
                      header.at("id") == frame.header->frame.id &&
                      header.at("encoding") == frame.header->encoding &&
                      header.at("total_length") == frame.header->total_length &&
                      header.at("plain_length") == frame.header->plain_length,
                  name + ", its header");
    }
    std::string again;
    Encoder encoder(protocol());
    tally.check(bool(encoder.append(again, frame.header->frame, frame.data)), name);
    if (vector.at("case") == "plain") tally.check(again == bytes, name + ", written again");
    // A reader gets the same data, compressed or not.
    encoder.set_gzip(fc_runtime::Gzip{0, 9});
    std::string packed;
    tally.check(bool(encoder.append(packed, frame.header->frame, frame.data)), name);
    const Read unpacked = read(packed, packed.size());
    tally.check(unpacked.error.empty() && unpacked.data == frame.data, name + ", packed");
  }
}

/// Returns `true` if the vector can be judged without types.
bool rejected(tests::Tally& tally, const std::string& file, const json& vector) {
  const std::string name = file + " " + vector.at("name").get<std::string>();
  const std::string wanted = vector.at("error");
  const std::string bytes = tests::unhex(vector.at("frame"));
  bool judged = false;
  for (const std::size_t step : {bytes.size(), std::size_t{1}, std::size_t{7}}) {
    const Read frame = read(bytes, step);
    std::string found = frame.error;
    if (found.empty()) found = body_error(vector, frame.data);
    if (found.empty() && kOfAnyBody.count(wanted) == 0) continue;
    judged = true;
    tally.check(found == wanted, name + ": wanted " + wanted + ", found " + found);
  }
  return judged;
}

/// Cases without vectors: the compression ratio, searches, several frames, and a long one in
/// pieces.
void others(tests::Tally& tally) {
  const fc_runtime::FrameId id{false, 1, 7, 9};
  Encoder encoder(protocol());
  encoder.set_gzip(fc_runtime::Gzip{0, 9});
  std::string bomb;
  tally.check(bool(encoder.append(bomb, id, std::string(2U << 20U, ' '))), "a bomb is written");
  tally.check(read(bomb, bomb.size()).error == "inflates_too_much", "a bomb is not inflated");
  encoder.set_gzip(std::nullopt);
  std::string two;
  tally.check(bool(encoder.append(two, id, "{}")), "one");
  tally.check(bool(encoder.append(two, id, "[]")), "two");
  Decoder decoder(protocol());
  decoder.push("garbage" + two);
  const auto lost = decoder.next();
  tally.check(!lost && lost.error().name() == "bad_head" && lost.error().is_fatal(), "garbage");
  Decoder searching(protocol());
  searching.set_resync(true);
  searching.push("garbage" + two);
  const auto found = searching.next();
  tally.check(found && *found && (*found)->data == "{}", "found behind garbage");
  const auto next = searching.next();
  tally.check(next && *next && (*next)->data == "[]" && searching.skipped() == 7, "and the next");
  const auto none = searching.next();
  tally.check(none && !*none && !searching.finish(), "and no more");
  encoder.set_frame_bytes(36);
  std::string too_long = "before";
  const auto refused = encoder.append(too_long, id, "{}");
  tally.check(!refused && refused.error().name() == "frame_too_long" && too_long == "before",
              "too long to be sent");
  // A length that is only announced takes no memory.
  Decoder lied_to(protocol());
  std::string head = bomb.substr(0, 35);
  head[12] = '\x7F';
  lied_to.push(head);
  const auto waiting = lied_to.next();
  tally.check(waiting && !*waiting && lied_to.capacity() < 4096, "an announced length");
  // RFC 1321, and lengths around the size of a block.
  using fc_runtime::digest_of;
  using fc_runtime::DigestAlgorithm;
  const auto sum = [](DigestAlgorithm algorithm, std::string_view text) {
    const auto digest = digest_of(algorithm, text);
    return tests::hex({reinterpret_cast<const char*>(digest.data()), digest.size()});
  };
  tally.check(sum(DigestAlgorithm::Md5, "") == "d41d8cd98f00b204e9800998ecf8427e",
              "md5 of nothing");
  tally.check(sum(DigestAlgorithm::Md5,
                  "1234567890123456789012345678901234567890123456789012345678901234567890123456789"
                  "0") == "57edf4a22be3c955ac49da2e2107b67a",
              "md5 of eighty digits");
  tally.check(sum(DigestAlgorithm::Crc32, "123456789").substr(0, 8) == "cbf43926", "crc32");
  for (std::size_t length = 50; length < 140; ++length) {
    const std::string text(length, 'x');
    fc_runtime::Md5 pieces;
    for (std::size_t at = 0; at < length; at += 13) {
      pieces.update(std::string_view(text).substr(at, 13));
    }
    tally.check(pieces.finish() == digest_of(DigestAlgorithm::Md5, text), "md5 in pieces");
  }
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return 2;
  tests::Tally tally;
  int with_types = 0;
  for (const auto& entry : std::filesystem::directory_iterator(arguments[1])) {
    if (entry.path().extension() != ".json" || entry.path().stem() == "bodies") continue;
    std::ifstream file(entry.path());
    const json vectors = json::parse(file);
    const std::string name = entry.path().stem().string();
    // Vectors of operations are cases of the message test.
    const std::string kind = name == "frames" ? name : "";
    for (const json& vector : vectors.at("accepted")) {
      if (!vector.contains("frame")) continue;
      accepted(tally, name, vector);
      tally.end_case(kind);
    }
    for (const json& vector : vectors.at("rejected")) {
      if (!vector.contains("frame")) continue;
      const bool is_judged = rejected(tally, name, vector);
      with_types += is_judged ? 0 : 1;
      tally.check(is_judged || kind.empty(), name + " takes a type");
      tally.end_case(kind);
    }
  }
  others(tally);
  std::printf("%d refused ones take the type of the body\n", with_types);
  return tally.outcome("things about frames", 5000);
}
