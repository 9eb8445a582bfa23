#pragma once

#include <cstdlib>
#include <random>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "trackbed/core/text_table.h"

namespace trackbed {

/// Returns a number with a typical input error: scaled, shifted, with the opposite sign, without
/// its decimal point, or with two digits swapped.
inline std::string WrongNumber(const std::string& number, std::mt19937_64& random) {
  const double value = std::strtod(number.c_str(), nullptr);
  const std::vector<double> values{
      10.0 * value, 1000.0 * value, 0.1 * value,    -value,          0.0,
      1e6,          value + 100.0,  value - 1000.0, 1.5 * value + 1, 99'999.0};
  const std::size_t choice = random() % (values.size() + 2);
  if (choice < values.size()) {
    return ShortestText(values[choice]);
  }
  std::string text = number;
  const std::size_t digit = text.find_first_of("0123456789");
  if (choice == values.size() && digit + 1 < text.size()) {
    std::swap(text[digit], text[digit + 1]);
  } else if (const std::size_t point = text.find('.'); point != std::string::npos) {
    text.erase(point, 1);
  }
  return text;
}

/// Returns a text in which one number, at the position `from` or later, has a typical input error.
inline std::string WithWrongNumber(const std::string& text, std::size_t from,
                                   std::mt19937_64& random) {
  static const std::regex number(R"([-+]?[0-9]+(\.[0-9]*)?([eE][-+]?[0-9]+)?)");
  std::vector<std::pair<std::size_t, std::size_t>> places;
  for (auto at = std::sregex_iterator(text.begin() + static_cast<std::ptrdiff_t>(from), text.end(),
                                      number);
       at != std::sregex_iterator(); ++at) {
    places.emplace_back(from + static_cast<std::size_t>(at->position()),
                        static_cast<std::size_t>(at->length()));
  }
  const auto [position, length] = places[random() % places.size()];
  std::string wrong = text;
  return wrong.replace(position, length, WrongNumber(text.substr(position, length), random));
}

}  // namespace trackbed
