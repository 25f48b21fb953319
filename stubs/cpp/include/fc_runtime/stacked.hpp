// A robot that is put together of a part for each group of commands.
#pragma once

#include "fc_runtime/message.hpp"
#include "fc_runtime/operation.hpp"
#include "fc_runtime/protocol.hpp"
#include "fc_runtime/typed.hpp"

namespace fc_runtime {

namespace detail {

template <class Base, template <class> class... Parts>
struct Stack {
  using Type = Base;
};

template <class Base, template <class> class First, template <class> class... Rest>
struct Stack<Base, First, Rest...> {
  using Type = First<typename Stack<Base, Rest...>::Type>;
};

}  // namespace detail

/// `Base` with all of these parts, each derived from the next.
template <class Base, template <class> class... Parts>
using Stacked = typename detail::Stack<Base, Parts...>::Type;

/// A robot whose parts refuse each command as not implemented.
template <class Robot, const Protocol& (*protocol)()>
class Refusing : public Robot {
 protected:
  /// Refuses it.
  template <class Request>
  [[nodiscard]] Replied<typename Command<Request>::Response> answer_(
      const Request& /*request*/) const {
    return not_implemented(protocol());
  }
};

/// A robot whose parts answer each command with the spec's example. What sets something in motion, or
/// may do so, is refused as not implemented unless the robot pretends to do it.
template <class Robot, const Protocol& (*protocol)()>
class Exemplary : public Robot {
 protected:
  /// Whether it pretends.
  bool pretend_motion_ = false;

  /// Answers it, or refuses it.
  template <class Request>
  [[nodiscard]] Replied<typename Command<Request>::Response> answer_(
      const Request& /*request*/) const {
    constexpr Effect effect = Command<Request>::effect;
    constexpr bool may_move = effect == Effect::Motion || effect == Effect::Unknown;
    if (may_move && !pretend_motion_) return not_implemented(protocol());
    return example<typename Command<Request>::Response>();
  }
};

}  // namespace fc_runtime
