// The frame format and envelope of FC, for tests of the layers below its messages.
#pragma once

#include <limits>

#include "fc_runtime/protocol.hpp"

namespace tests {

inline fc_runtime::Protocol fc_protocol() {
  using fc_runtime::EnvelopeKey;
  using fc_runtime::EnvelopeRole;
  using fc_runtime::Field;
  using fc_runtime::HeaderRole;
  using namespace std::string_view_literals;

  fc_runtime::Protocol protocol;
  protocol.name = "fc";
  protocol.header.length = 35;
  protocol.header.fields = {
      {HeaderRole::Head, 0, 2, 0},         {HeaderRole::Kind, 2, 1, 0},
      {HeaderRole::Code, 3, 2, 0},         {HeaderRole::Id, 5, 4, 0},
      {HeaderRole::Encoding, 9, 1, 0},     {HeaderRole::Fixed, 10, 1, 0},
      {HeaderRole::TotalLength, 11, 4, 0}, {HeaderRole::PlainLength, 15, 4, 0},
      {HeaderRole::Digest, 19, 16, 0}};
  protocol.header.digest = fc_runtime::DigestAlgorithm::Md5;
  protocol.request_head = "\xFC\xAA"sv;
  protocol.response_head = "\xEE\xAA"sv;
  protocol.stream_kind = 0;
  protocol.command_kind = 1;
  protocol.report_kind = 3;
  protocol.reserved_kinds = {2};
  protocol.gzip_encoding = std::uint8_t{1};
  protocol.zero_plain_length = true;
  const EnvelopeKey time{EnvelopeRole::Time, Field("cmdTime"), true};
  const Field code = Field("resultCode")
                         .min(std::numeric_limits<std::int32_t>::min())
                         .max(std::numeric_limits<std::int32_t>::max());
  protocol.request_envelope = {time};
  protocol.response_envelope = {time,
                                {EnvelopeRole::ResultCode, code, false},
                                {EnvelopeRole::ResultText, Field("resultMsg"), true}};
  protocol.results = {{1001, "响应成功"},
                      {2001, "硬件协议错误"},
                      {2002, "硬件通信超时"},
                      {2003, "参数不合法"},
                      {2004, "消息过期"}};
  return protocol;
}

}  // namespace tests
