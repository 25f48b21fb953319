// Messages to bytes.
#include "fc_runtime/frame.hpp"

namespace fc_runtime {

Encoder::Encoder(const Protocol& protocol)
    : protocol_(&protocol), frame_bytes_(protocol.defaults.limits.frame_bytes) {}

void Encoder::set_gzip(std::optional<Gzip> gzip) {
  gzip_ = gzip;
  deflater_.reset();
}

Result<Done, FrameError> Encoder::append(std::string& out, FrameId id, std::string_view data) {
  Header header;
  header.frame = id;
  header.encoding = protocol_->plain_encoding;
  const std::size_t plain = data.size();
  if (gzip_ && protocol_->gzip_encoding && plain >= gzip_->from_bytes) {
    if (!deflater_) deflater_.emplace(gzip_->level);
    if (deflater_->member(data, packed_)) {
      data = packed_;
      header.encoding = *protocol_->gzip_encoding;
    }
  }
  const std::size_t total = protocol_->header.length + data.size();
  if (total > frame_bytes_ || plain > UINT32_MAX) {
    return FrameError{FrameErrorKind::FrameTooLong, id};
  }
  header.total_length = static_cast<std::uint32_t>(total);
  header.plain_length = static_cast<std::uint32_t>(plain);
  header.digest = digest_of(protocol_->header.digest, data);
  out.reserve(out.size() + total);
  detail::write_header(*protocol_, header, out);
  out.append(data);
  return Done{};
}

}  // namespace fc_runtime
