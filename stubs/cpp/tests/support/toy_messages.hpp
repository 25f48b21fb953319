// The messages of the protocol of the scripts, in the form of generated code.
#pragma once

#include <cstdint>
#include <string>

#include "fc_runtime/codec.hpp"
#include "fc_runtime/operation.hpp"
#include "support/toy.hpp"

namespace tests {

/// A body with one key.
struct Echo {
  fc_runtime::Required<std::string> text;
  fc_runtime::Extra extra;
};
struct Go {
  fc_runtime::Required<std::int32_t> metres;
  fc_runtime::Extra extra;
};
struct Nothing {
  fc_runtime::Extra extra;
};

inline bool operator==(const Nothing& left, const Nothing& right) {
  return left.extra == right.extra;
}

}  // namespace tests

template <>
struct fc_runtime::Fields<tests::Echo> {
  static constexpr std::string_view name = "Echo";
  static constexpr std::string_view example = R"({"text":""})";
  template <class Visitor, class Message>
  static void each(Visitor& visit, Message& message) {
    visit(Field("text"), message.text);
  }
  static void conditions(Conditions& /*asked*/, const tests::Echo& /*message*/) {}
};

template <>
struct fc_runtime::Fields<tests::Go> {
  static constexpr std::string_view name = "Go";
  static constexpr std::string_view example = R"({"metres":1})";
  template <class Visitor, class Message>
  static void each(Visitor& visit, Message& message) {
    visit(Field("metres"), message.metres);
  }
  static void conditions(Conditions& /*asked*/, const tests::Go& /*message*/) {}
};

template <>
struct fc_runtime::Fields<tests::Nothing> {
  static constexpr std::string_view name = "Nothing";
  static constexpr std::string_view example = "{}";
  template <class Visitor, class Message>
  static void each(Visitor& /*visit*/, Message& /*message*/) {}
  static void conditions(Conditions& /*asked*/, const tests::Nothing& /*message*/) {}
};

template <>
struct fc_runtime::Command<tests::Echo> {
  using Response = tests::Echo;
  static constexpr std::uint16_t code = tests::kEcho;
  static constexpr Effect effect = Effect::Read;
};

template <>
struct fc_runtime::Command<tests::Go> {
  using Response = tests::Nothing;
  static constexpr std::uint16_t code = tests::kGo;
  static constexpr Effect effect = Effect::Motion;
};

template <>
struct fc_runtime::Report<tests::Go> {
  static constexpr std::uint16_t code = tests::kMoved;
};

namespace tests {

/// Returns the protocol of the scripts with its operations.
inline fc_runtime::Protocol toy_with_messages() {
  using fc_runtime::Effect;
  using fc_runtime::OperationInfo;
  using fc_runtime::OperationKind;
  using fc_runtime::type_info;

  fc_runtime::Protocol protocol = toy_protocol();
  OperationInfo echo;
  echo.name = "echo";
  echo.code = kEcho;
  echo.effect = Effect::Read;
  echo.request = type_info<Echo>();
  echo.response = type_info<Echo>();
  OperationInfo go;
  go.name = "go";
  go.code = kGo;
  go.effect = Effect::Motion;
  go.request = type_info<Go>();
  go.response = type_info<Nothing>();
  OperationInfo moved;
  moved.name = "moved";
  moved.kind = OperationKind::Report;
  moved.code = kMoved;
  moved.request = type_info<Go>();
  moved.response = type_info<Nothing>();
  protocol.operations = {echo, go, moved};
  return protocol;
}

}  // namespace tests
