// SPDX-License-Identifier: GPL-3.0-or-later
#include "json_text.hpp"

#include <algorithm>

#include "study/text/json_writer.hpp"
#include "study/text/string_sink.hpp"

namespace cordon::apps {

namespace {

using detail::JsonWriter;
using Json = nlohmann::ordered_json;

JsonWriter::Layout layout_of(const Json& value) {
  const bool flat =
      value.is_array() &&
      std::none_of(value.begin(), value.end(), [](const Json& one) { return one.is_structured(); });
  return flat ? JsonWriter::Layout::line : JsonWriter::Layout::lines;
}

void write(JsonWriter& to, const Json& value) {
  switch (value.type()) {
    case Json::value_t::object:
      to.begin_object(layout_of(value));
      for (const auto& [name, member] : value.items()) write(to.key(name), member);
      to.end_object();
      break;
    case Json::value_t::array:
      to.begin_array(layout_of(value));
      for (const Json& element : value) write(to, element);
      to.end_array();
      break;
    case Json::value_t::string:
      to.value(std::string_view(value.get_ref<const std::string&>()));
      break;
    case Json::value_t::boolean:
      to.value(value.get<bool>());
      break;
    case Json::value_t::number_integer:
    case Json::value_t::number_unsigned:
      to.value(value.get<std::int64_t>());
      break;
    case Json::value_t::number_float:
      to.value(value.get<double>());
      break;
    default:
      to.null();
  }
}

}  // namespace

std::string json_text(const Json& value) {
  detail::StringSink text;
  JsonWriter writer(text);
  write(writer, value);
  return text.text + "\n";
}

}  // namespace cordon::apps
