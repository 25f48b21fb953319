// Bytes to frames.
#include <algorithm>

#include "fc_runtime/frame.hpp"

namespace fc_runtime {

namespace {

/// Capacity that an empty buffer may keep for the next frame, in bytes.
constexpr std::size_t kKeep = std::size_t{2} << 20U;
/// Longest search, in multiples of the longest frame. Nested heads must not cause more work than
/// bytes.
constexpr std::uint64_t kSearch = 4;

/// Returns `true` if the bytes match the start of a head.
bool opens(std::string_view bytes, std::string_view head) {
  const std::size_t length = std::min(bytes.size(), head.size());
  return bytes.substr(0, length) == head.substr(0, length);
}

}  // namespace

Decoder::Decoder(const Protocol& protocol)
    : protocol_(&protocol), limits_(protocol.defaults.limits) {}

void Decoder::push(std::string_view bytes) {
  if (start_ == received_.size()) {
    received_.clear();
    start_ = 0;
  } else if (start_ > 0 && received_.size() + bytes.size() > received_.capacity()) {
    received_.erase(0, start_);
    start_ = 0;
  }
  received_.append(bytes);
}

void Decoder::release() {
  if (inflated_.capacity() > kKeep) std::string().swap(inflated_);
  if (start_ == received_.size() && received_.capacity() > kKeep) {
    std::string().swap(received_);
    start_ = 0;
  }
}

bool Decoder::may_open(std::string_view bytes) const {
  return opens(bytes, protocol_->request_head) || opens(bytes, protocol_->response_head);
}

std::optional<std::uint32_t> Decoder::expected() const {
  return detail::peek_total_length(protocol_->header, unread());
}

Result<std::optional<Frame>, FrameError> Decoder::next() {
  release();
  if (failed_) return *failed_;
  for (;;) {
    const auto located = locate();
    if (!located) {
      if (resync_) {
        search();
        continue;
      }
      failed_ = located.error();
      return *failed_;
    }
    if (!*located) return std::optional<Frame>();
    const Header& header = **located;
    const std::string_view whole = unread().substr(0, header.total_length);
    const std::string_view data = whole.substr(protocol_->header.length);
    const auto error = check(header, data);
    if (error && searching_) {
      if (give_up(header)) return *failed_;
      search();
      continue;
    }
    start_ += header.total_length;
    if (error) return *error;
    searching_ = false;
    tried_ = 0;
    const bool packed = header.encoding == protocol_->gzip_encoding;
    return std::optional(Frame{header, packed ? std::string_view(inflated_) : data});
  }
}

std::optional<FrameError> Decoder::finish() const {
  if (failed_) return failed_;
  if (pending() == 0 || searching_) return std::nullopt;
  return FrameError{FrameErrorKind::Truncated, {}};
}

Result<std::optional<Header>, FrameError> Decoder::locate() const {
  const std::string_view held = unread();
  if (!may_open(held)) return FrameError{FrameErrorKind::BadHead, {}};
  const auto total = detail::peek_total_length(protocol_->header, held);
  if (!total) return std::optional<Header>();
  if (*total > limits_.frame_bytes) return FrameError{FrameErrorKind::FrameTooLong, {}};
  if (*total < protocol_->header.length) return FrameError{FrameErrorKind::ShortFrame, {}};
  if (held.size() < *total) return std::optional<Header>();
  return std::optional(detail::read_header(*protocol_, held));
}

/// Checks a complete frame and decompresses its data. The order decides between several errors.
std::optional<FrameError> Decoder::check(const Header& header, std::string_view data) {
  const auto fault = [&](FrameErrorKind kind) { return FrameError{kind, header.frame}; };
  const Protocol& protocol = *protocol_;
  const std::uint8_t kind = header.frame.kind;
  const auto& reserved = protocol.reserved_kinds;
  if (std::find(reserved.begin(), reserved.end(), kind) != reserved.end()) {
    return fault(FrameErrorKind::ReservedKind);
  }
  if (kind != protocol.command_kind && kind != protocol.report_kind &&
      kind != protocol.stream_kind) {
    return fault(FrameErrorKind::UnknownKind);
  }
  const bool packed = header.encoding == protocol.gzip_encoding;
  if (!packed && header.encoding != protocol.plain_encoding) {
    return fault(FrameErrorKind::UnknownEncoding);
  }
  if (verify_digest_ && protocol.header.find(HeaderRole::Digest) != nullptr &&
      digest_of(protocol.header.digest, data) != header.digest) {
    return fault(FrameErrorKind::BadDigest);
  }
  const std::uint32_t plain = header.plain_length;
  if (!packed) {
    if (data.size() == plain || (protocol.zero_plain_length && plain == 0)) return std::nullopt;
    return fault(FrameErrorKind::PlainLengthMismatch);
  }
  if (plain > limits_.inflated_bytes) return fault(FrameErrorKind::InflatedTooLong);
  if (kind != protocol.stream_kind && plain > Limits::inflate_free &&
      plain > std::uint64_t{limits_.inflate_ratio} * data.size()) {
    return fault(FrameErrorKind::InflatesTooMuch);
  }
  if (!inflater_) inflater_.emplace();
  switch (inflater_->inflate(data, plain, inflated_)) {
    case Inflated::Whole:
      break;
    case Inflated::Damaged:
      return fault(FrameErrorKind::BadGzip);
    case Inflated::Length:
      return fault(FrameErrorKind::PlainLengthMismatch);
  }
  return std::nullopt;
}

/// Returns `true` if the search has tried too many bytes without success.
bool Decoder::give_up(const Header& header) {
  tried_ += header.total_length;
  if (tried_ <= kSearch * limits_.frame_bytes) return false;
  failed_ = FrameError{FrameErrorKind::BadHead, {}};
  return true;
}

/// Skips to the next position that may be a head.
void Decoder::search() {
  const std::string_view held = unread();
  std::size_t next = 1;
  while (next < held.size() && !may_open(held.substr(next))) ++next;
  start_ += next;
  searching_ = true;
  skipped_ += next;
}

}  // namespace fc_runtime
