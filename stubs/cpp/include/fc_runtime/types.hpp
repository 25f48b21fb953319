// Lists of types: the requests and reports of each group of a protocol.
#pragma once

#include <type_traits>
#include <variant>

namespace fc_runtime {

/// A list of types that ends with `End`.
template <class... Each>
struct Types {};

/// The end marker of a list. With it, an added type does not change the line of the previous one.
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

/// A `std::variant` over the types of all these lists, in order.
template <class... Lists>
using VariantOf = typename detail::Joined<Types<>, Lists...>::Variant;

/// Calls `visit` with a value of each type of a list.
template <class Visitor, class... Each>
void visit_each(Visitor& visit, Types<Each...> /*list*/) {
  (detail::visit_one<Each>(visit), ...);
}

}  // namespace fc_runtime
