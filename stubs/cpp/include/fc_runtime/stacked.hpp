// A robot composed of one part per group of commands.
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

/// `Base` with all parts. Each part derives from the next.
template <class Base, template <class> class... Parts>
using Stacked = typename detail::Stack<Base, Parts...>::Type;

/// A robot that refuses each command as not implemented.
template <class Robot, const Protocol& (*protocol)()>
class Refusing : public Robot {
 protected:
  /// Refuses the command.
  template <class Request>
  [[nodiscard]] Replied<typename Command<Request>::Response> answer_(
      const Request& /*request*/) const {
    return not_implemented(protocol());
  }
};

/// A robot that responds to each command with the example in the spec. Commands with effect
/// `Motion` or `Unknown` are refused as not implemented unless `pretend_motion_` is set.
template <class Robot, const Protocol& (*protocol)()>
class Exemplary : public Robot {
 protected:
  /// Responds to `Motion` and `Unknown` commands as well.
  bool pretend_motion_ = false;

  /// Responds with the example, or refuses the command.
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
