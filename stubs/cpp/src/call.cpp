#include "fc_runtime/call.hpp"

#include <ostream>

namespace fc_runtime {

std::string to_string(const Refusal& refusal) {
  return "refused with result " + std::to_string(refusal.code) + ": " + refusal.text;
}

std::string_view Loss::name() const noexcept {
  switch (kind) {
    case LossKind::NotYet:
      return "not_yet";
    case LossKind::Closed:
      return "closed_by_robot";
    case LossKind::Unheard:
      return "closed_unheard";
    case LossKind::Broken:
      return "broken";
    case LossKind::Frame:
      return frame ? fc_runtime::name(*frame) : std::string_view("frame");
    case LossKind::Stalled:
      return "stalled";
    case LossKind::Unread:
      return "unread";
    case LossKind::Unreachable:
      return "unreachable";
    case LossKind::ConnectTimeout:
      return "connect_timeout";
    case LossKind::Renewed:
      return "renewed";
    case LossKind::Here:
      return "closed_here";
    case LossKind::Ended:
      return "ended";
    case LossKind::Settings:
      return "invalid_settings";
  }
  return "";
}

std::string to_string(const Loss& loss) {
  std::string text(loss.name());
  if (!loss.detail.empty()) text += ": " + loss.detail;
  return text;
}

std::string_view name(CallErrorKind kind) noexcept {
  switch (kind) {
    case CallErrorKind::Refused:
      return "refused";
    case CallErrorKind::Timeout:
      return "timeout";
    case CallErrorKind::NotConnected:
      return "not_connected";
    case CallErrorKind::Closed:
      return "closed";
    case CallErrorKind::Lost:
      return "lost";
    case CallErrorKind::Busy:
      return "busy";
    case CallErrorKind::InvalidRequest:
      return "invalid_request";
    case CallErrorKind::InvalidResponse:
      return "invalid_response";
    case CallErrorKind::Frame:
      return "frame";
  }
  return "";
}

bool CallError::was_not_sent() const noexcept {
  return kind == CallErrorKind::NotConnected || kind == CallErrorKind::Closed ||
         kind == CallErrorKind::Busy || kind == CallErrorKind::InvalidRequest;
}

std::string to_string(const CallError& error) {
  if (error.refusal) return to_string(*error.refusal);
  std::string text(error.name());
  if (error.loss) text += ": " + to_string(*error.loss);
  if (error.body) text += ": " + to_string(*error.body);
  if (error.frame) text += ": " + to_string(*error.frame);
  return text;
}

std::ostream& operator<<(std::ostream& out, const CallError& error) {
  return out << to_string(error);
}

}  // namespace fc_runtime
