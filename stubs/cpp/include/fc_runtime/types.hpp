// Lists of types, in which each group of a protocol names its requests and reports.
#pragma once

#include <type_traits>
#include <variant>

namespace fc_runtime {

/// A list of types, with `End` behind the last.
template <class... Each>
struct Types {};

/// The end of a list, which is none of its types: behind it a list can grow without a change of what stands there.
struct End {};

namespace detail {

template <class... Lists>
struct Joined;

template <class... Each>
struct Joined<Types<Each...>> {
  using Variant = std::variant<Each...>;
};

template <class... Done, class... Lists>
struct Joined<Types<Done...>, Types<>, Lists...> : Joined<Types<Done...>, Lists...> {};

template <class... Done, class... Lists>
struct Joined<Types<Done...>, Types<End>, Lists...> : Joined<Types<Done...>, Lists...> {};

template <class... Done, class Next, class... Rest, class... Lists>
struct Joined<Types<Done...>, Types<Next, Rest...>, Lists...>
    : Joined<Types<Done..., Next>, Types<Rest...>, Lists...> {};

template <class Type, class Visitor>
void visit_one(Visitor& visit) {
  if constexpr (!std::is_same_v<Type, End>) visit(Type());
}

}  // namespace detail

/// A `std::variant` over the types of all these lists, in their order.
template <class... Lists>
using VariantOf = typename detail::Joined<Types<>, Lists...>::Variant;

/// Calls `visit` once for each type of a list, with a value of it.
template <class Visitor, class... Each>
void visit_each(Visitor& visit, Types<Each...> /*list*/) {
  (detail::visit_one<Each>(visit), ...);
}

}  // namespace fc_runtime
