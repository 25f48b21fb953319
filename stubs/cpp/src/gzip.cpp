#include "fc_runtime/gzip.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

namespace fc_runtime {

namespace {

constexpr std::string_view kHeader("\x1F\x8B\x08\0\0\0\0\0\0\xFF", 10);
constexpr std::size_t kTrailer = 8;
/// Raw deflate: this file reads and writes the gzip header and trailer.
constexpr int kRaw = -15;
/// Least size of the output for a first step, in bytes.
constexpr std::size_t kFirstRoom = 4096;

const Bytef* bytes_of(std::string_view data) { return reinterpret_cast<const Bytef*>(data.data()); }

/// zlib counts in 32 bits. No frame is longer.
uInt short_length(std::size_t length) {
  return static_cast<uInt>(std::min<std::size_t>(length, std::numeric_limits<uInt>::max()));
}

/// Returns the trailer of a member: the checksum and the length modulo 2^32 of its data.
std::array<char, kTrailer> trailer_of(std::string_view data) {
  const auto sum = static_cast<std::uint32_t>(crc32_z(0, bytes_of(data), data.size()));
  const auto length = static_cast<std::uint32_t>(data.size());
  std::array<char, kTrailer> out{};
  for (std::size_t at = 0; at < 4; ++at) {
    out[at] = static_cast<char>(sum >> (8 * at) & 0xFFU);
    out[4 + at] = static_cast<char>(length >> (8 * at) & 0xFFU);
  }
  return out;
}

/// Returns the rest of a member after its header, including optional fields that some compressors
/// write.
std::optional<std::string_view> skip_header(std::string_view member) {
  if (member.size() < kHeader.size() || member.substr(0, 3) != kHeader.substr(0, 3)) return {};
  const auto flags = static_cast<unsigned char>(member[3]);
  if ((flags & 0xE0U) != 0) return {};
  std::string_view rest = member.substr(kHeader.size());
  if ((flags & 0x04U) != 0) {
    if (rest.size() < 2) return {};
    const auto low = static_cast<unsigned char>(rest[0]);
    const auto high = static_cast<unsigned char>(rest[1]);
    const std::size_t length = low + 256U * high;
    if (rest.size() < 2 + length) return {};
    rest.remove_prefix(2 + length);
  }
  for (const unsigned text : {0x08U, 0x10U}) {
    if ((flags & text) == 0) continue;
    const std::size_t end = rest.find('\0');
    if (end == std::string_view::npos) return {};
    rest.remove_prefix(end + 1);
  }
  if ((flags & 0x02U) != 0) {
    if (rest.size() < 2) return {};
    rest.remove_prefix(2);
  }
  return rest;
}

}  // namespace

struct Deflater::State {
  z_stream stream{};
  bool good = false;

  explicit State(int level) {
    good = deflateInit2(&stream, std::clamp(level, 0, 9), Z_DEFLATED, kRaw, 8,
                        Z_DEFAULT_STRATEGY) == Z_OK;
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() {
    if (good) deflateEnd(&stream);
  }
};

Deflater::Deflater(int level) : state_(std::make_unique<State>(level)) {}
Deflater::Deflater(Deflater&&) noexcept = default;
Deflater& Deflater::operator=(Deflater&&) noexcept = default;
Deflater::~Deflater() = default;

bool Deflater::member(std::string_view data, std::string& out) {
  if (!state_->good || data.size() <= kHeader.size() + kTrailer) return false;
  z_stream& stream = state_->stream;
  if (deflateReset(&stream) != Z_OK) return false;
  // Data that does not shrink is sent uncompressed.
  out.resize(data.size() - kTrailer);
  std::copy(kHeader.begin(), kHeader.end(), out.begin());
  stream.next_in = const_cast<Bytef*>(bytes_of(data));
  stream.avail_in = short_length(data.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data() + kHeader.size());
  stream.avail_out = short_length(out.size() - kHeader.size());
  if (deflate(&stream, Z_FINISH) != Z_STREAM_END) return false;
  out.resize(kHeader.size() + stream.total_out);
  const auto trailer = trailer_of(data);
  out.append(trailer.data(), trailer.size());
  return out.size() < data.size();
}

struct Inflater::State {
  z_stream stream{};
  bool good = false;

  State() { good = inflateInit2(&stream, kRaw) == Z_OK; }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() {
    if (good) inflateEnd(&stream);
  }
};

Inflater::Inflater() : state_(std::make_unique<State>()) {}
Inflater::Inflater(Inflater&&) noexcept = default;
Inflater& Inflater::operator=(Inflater&&) noexcept = default;
Inflater::~Inflater() = default;

Inflated Inflater::inflate(std::string_view member, std::size_t plain, std::string& out) {
  out.clear();
  const auto deflated = skip_header(member);
  z_stream& stream = state_->stream;
  if (!deflated || !state_->good || inflateReset(&stream) != Z_OK) return Inflated::Damaged;
  stream.next_in = const_cast<Bytef*>(bytes_of(*deflated));
  stream.avail_in = short_length(deflated->size());
  std::size_t filled = 0;
  std::size_t room = std::max(deflated->size() * 4, kFirstRoom);
  for (bool ended = false; !ended;) {
    // A stream that continues after the announced length is too long.
    char one_too_many = 0;
    out.resize(std::min(plain, room));
    const std::size_t left = out.size() - filled;
    const uInt offered = left > 0 ? short_length(left) : 1;
    stream.next_out = reinterpret_cast<Bytef*>(left > 0 ? out.data() + filled : &one_too_many);
    stream.avail_out = offered;
    const int status = ::inflate(&stream, Z_NO_FLUSH);
    if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR) return Inflated::Damaged;
    const std::size_t produced = offered - stream.avail_out;
    if (left == 0 && produced > 0) return Inflated::Length;
    filled += produced;
    ended = status == Z_STREAM_END;
    // The input has ended before the stream.
    if (!ended && (stream.avail_out > 0 || produced == 0)) return Inflated::Damaged;
    if (filled == out.size()) room *= 2;
  }
  out.resize(filled);
  const auto trailer = trailer_of(out);
  const std::string_view rest = deflated->substr(deflated->size() - stream.avail_in);
  if (rest != std::string_view(trailer.data(), trailer.size())) return Inflated::Damaged;
  return filled == plain ? Inflated::Whole : Inflated::Length;
}

}  // namespace fc_runtime
