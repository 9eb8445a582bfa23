#pragma once

#include <gtest/gtest.h>

#include <cctype>
#include <string>
#include <tuple>
#include <type_traits>

namespace trackbed {

/// Returns a parameter of a test as text: a text itself, the members of a pair or tuple with '_'
/// between them, and other values as GoogleTest prints them.
template <class Value>
std::string CaseText(const Value& value) {
  if constexpr (std::is_convertible_v<Value, std::string>) {
    return value;
  } else if constexpr (requires { std::tuple_size<Value>::value; }) {
    return std::apply(
        [](const auto&... members) {
          std::string text;
          ((text += (text.empty() ? "" : "_") + CaseText(members)), ...);
          return text;
        },
        value);
  } else {
    return testing::PrintToString(value);
  }
}

/// Returns a text as the name of a case of a test: letters, digits and '_' only. A sign before a
/// digit becomes the word minus.
inline std::string AsCaseName(const std::string& text) {
  std::string name;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    const bool negates = c == '-' && i + 1 < text.size() && std::isdigit(text[i + 1]) != 0;
    if (std::isalnum(c) != 0) {
      name += text[i];
    } else if (!name.empty() && name.back() != '_') {
      name += '_';
    }
    name += negates ? "minus_" : "";
  }
  while (name.ends_with('_')) {
    name.pop_back();
  }
  return name;
}

/// Names the cases of INSTANTIATE_TEST_SUITE_P by their parameters. GoogleTest refuses two cases
/// of the same name.
inline constexpr auto kNamedByParameter = [](const auto& tested) {
  return AsCaseName(CaseText(tested.param));
};

}  // namespace trackbed
