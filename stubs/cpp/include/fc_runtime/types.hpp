// Lists of types, in which each group of a protocol names its requests and reports.
#pragma once

#include <variant>

namespace fc_runtime {

/// A list of types.
template <class... Each>
struct Types {};

namespace detail {

template <class... Lists>
struct Joined;

template <class... Each>
struct Joined<Types<Each...>> {
  using Variant = std::variant<Each...>;
};

template <class... Left, class... Right, class... Rest>
struct Joined<Types<Left...>, Types<Right...>, Rest...>
    : Joined<Types<Left..., Right...>, Rest...> {};

}  // namespace detail

/// A `std::variant` over the types of all these lists, in their order.
template <class... Lists>
using VariantOf = typename detail::Joined<Lists...>::Variant;

/// Calls `visit` once for each type of a list, with a value of it.
template <class Visitor, class... Each>
void visit_each(Visitor& visit, Types<Each...> /*list*/) {
  (visit(Each()), ...);
}

}  // namespace fc_runtime
