#include "codec.hpp"

#include <openssl/evp.h>

#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>

#include "fc/groups/station.hpp"
#include "fc/protocol.hpp"
#include "fc_runtime/envelope.hpp"
#include "fc_runtime/frame.hpp"

namespace bench {

namespace {

using nlohmann::json;

/// Uses the results, so that the compiler does not remove the work.
volatile std::size_t made = 0;

void demand(bool holds, const char* what) {
  if (!holds) throw std::runtime_error(what);
}

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  demand(file.is_open(), "there is no such frame");
  return {std::istreambuf_iterator<char>(file), {}};
}

/// MD5 by OpenSSL, so that the baseline is independent of the package.
class Digest {
 public:
  static constexpr std::size_t kSize = 16;

  Digest() = default;
  Digest(const Digest&) = delete;
  Digest& operator=(const Digest&) = delete;
  ~Digest() { EVP_MD_CTX_free(context_); }

  /// Returns a digest. The view is valid until the next call.
  std::string_view of(std::string_view data) {
    const bool is_made = EVP_DigestInit_ex(context_, EVP_md5(), nullptr) == 1 &&
                         EVP_DigestUpdate(context_, data.data(), data.size()) == 1 &&
                         EVP_DigestFinal_ex(context_, sum_, nullptr) == 1;
    demand(is_made, "OpenSSL makes no MD5");
    return {reinterpret_cast<const char*>(sum_), kSize};
  }

 private:
  EVP_MD_CTX* context_ = EVP_MD_CTX_new();
  unsigned char sum_[EVP_MAX_MD_SIZE] = {};
};

/// The least work of reading and writing: the digest, and all of the JSON.
class Least {
 public:
  explicit Least(std::string frame) : frame_(std::move(frame)) {}

  json decode() {
    const std::string_view body = std::string_view(frame_).substr(kHeader);
    demand(digest_.of(body) == std::string_view(frame_).substr(kDigest, Digest::kSize),
           "another digest");
    return json::parse(body);
  }

  /// Encodes with a prepared header, in which only the digest changes.
  std::string encode(const json& value) {
    const std::string body = value.dump();
    std::string out;
    out.reserve(kHeader + body.size());
    out.append(frame_, 0, kDigest).append(digest_.of(body)).append(body);
    return out;
  }

 private:
  /// The digest is the last field of the header.
  const std::size_t kHeader = fc::protocol().header.length;
  const std::size_t kDigest = kHeader - Digest::kSize;

  std::string frame_;
  Digest digest_;
};

template <class Message>
nlohmann::ordered_json message(const char* name, Effort effort) {
  const std::string frame = read_file(std::string(FC_BENCH "/frames/") + name + ".bin");
  const auto& protocol = fc::protocol();
  const auto& keys = protocol.response_envelope;
  const auto allowance = protocol.defaults.limits.json();
  fc_runtime::Decoder decoder(protocol);
  fc_runtime::FrameId id;
  const auto decode = [&](std::string_view bytes) {
    decoder.push(bytes);
    const auto next = decoder.next();
    demand(next && *next, "this is no frame");
    id = (*next)->header.frame;
    auto read = fc_runtime::read_enveloped<Message>(keys, (*next)->data, allowance);
    demand(read && read->body, "this is no such message");
    return *std::move(read);
  };
  const auto known = decode(frame);
  fc_runtime::Encoder encoder(protocol);
  std::string out;
  const auto encode = [&] {
    out.clear();
    const auto body = fc_runtime::write_enveloped(keys, known.envelope, *known.body);
    demand(body && encoder.append(out, id, *body), "this cannot be written");
  };
  Least least(frame);
  const json plain = least.decode();
  // Each side writes everything that it reads; nlohmann-json sorts the keys.
  encode();
  demand(out.size() == frame.size() && *decode(out).body == *known.body, "another message");
  demand(least.encode(plain).size() == frame.size(), "another text");
  const auto found = measure({[&] { made = made + least.decode().size(); },
                              [&] { made = made + (decode(frame).body ? 1 : 0); },
                              [&] { made = made + least.encode(plain).size(); },
                              [&] {
                                encode();
                                made = made + out.size();
                              }},
                             effort);
  return {{"message", name},
          {"bytes", frame.size()},
          {"decode", {{"least", found[0]}, {"fc", found[1]}}},
          {"encode", {{"least", found[2]}, {"fc", found[3]}}}};
}

}  // namespace

nlohmann::ordered_json codec(Effort effort) {
  return nlohmann::ordered_json::array({message<fc::GetStationResponse>("small", effort),
                                        message<fc::ListStationsResponse>("medium", effort),
                                        message<fc::ListStationsResponse>("long", effort)});
}

}  // namespace bench
