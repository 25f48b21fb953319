#include "fc_runtime/json.hpp"

#include <ostream>

#include "fc_runtime/reader.hpp"
#include "fc_runtime/writer.hpp"

namespace fc_runtime {

namespace {

/// The limits for a text that was checked before.
constexpr Allowance kAny{1024, static_cast<std::size_t>(-1), static_cast<std::size_t>(-1)};

}  // namespace

Result<Json, BodyError> Json::parse(std::string_view text) {
  if (!is_utf8(text)) return BodyError{BodyErrorKind::NotUtf8, "", 0, "send UTF-8"};
  Reader reader(text, Allowance{});
  Json value;
  if (!reader.json(value) || !reader.finish()) return reader.take_error();
  return value;
}

Json Json::boolean(bool value) { return Json(std::string(value ? "true" : "false")); }

Json Json::integer(std::int64_t value) { return Json(std::to_string(value)); }

Json Json::number(double value) {
  std::string text;
  Writer writer(text);
  writer.float64(value);
  return writer.has_failed() ? Json() : Json(std::move(text));
}

Json Json::string(std::string_view value) {
  std::string text;
  Writer(text).string(value);
  return Json(std::move(text));
}

std::ostream& operator<<(std::ostream& out, const Json& value) { return out << value.text(); }

namespace {

/// Visits the members of an `Extra`: the key, the text of the key, and the value.
template <class Visit>
void each_member(const std::string& members, const Visit& visit) {
  std::string text = "{";
  if (!members.empty()) text.append(members, 1);
  text.push_back('}');
  Reader reader(text, kAny);
  if (!reader.begin_object()) return;
  while (!reader.end_object()) {
    std::string_view key;
    if (!reader.key(key)) return;
    const std::string name(key);
    const std::string_view raw = reader.raw_key();
    Json value;
    if (!reader.json(value) || !reader.end_value()) return;
    visit(name, raw, std::move(value));
  }
}

}  // namespace

std::vector<std::pair<std::string, Json>> Extra::members() const {
  std::vector<std::pair<std::string, Json>> members;
  each_member(text_, [&members](const std::string& name, std::string_view /*raw*/, Json value) {
    members.emplace_back(name, std::move(value));
  });
  return members;
}

std::size_t Extra::size() const { return members().size(); }

std::optional<Json> Extra::get(std::string_view key) const {
  std::optional<Json> found;
  for (auto& [name, value] : members()) {
    if (name == key) found = std::move(value);
  }
  return found;
}

void Extra::append(std::string_view key, std::string_view value) {
  text_.push_back(',');
  text_.append(key);
  text_.push_back(':');
  text_.append(value);
}

void Extra::replace(std::string_view key, const Json* value) {
  const std::string before = std::exchange(text_, std::string());
  each_member(before, [&](const std::string& name, std::string_view raw, const Json& held) {
    if (name != key) {
      append(raw, held.text());
    } else if (value != nullptr) {
      append(raw, std::exchange(value, nullptr)->text());
    }
  });
  if (value != nullptr) append(Json::string(key).text(), value->text());
}

void Extra::set(std::string_view key, const Json& value) { replace(key, &value); }

void Extra::erase(std::string_view key) { replace(key, nullptr); }

}  // namespace fc_runtime
