#include "src/core/csv_number.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <utility>

#include "trackbed/core/text_table.h"

namespace trackbed {
namespace {

bool IsDigit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

}  // namespace

bool HasDecimalCommas(const std::vector<std::vector<std::string>>& rows) {
  bool has_decimals = false;
  for (const std::vector<std::string>& row : rows) {
    for (std::string cell : row) {
      const std::size_t comma = cell.find(',');
      NormalizeNumber(cell, true);
      const bool is_number = CellNumber(cell).has_value();
      if (comma == std::string::npos) {
        if (is_number && cell.find('.') != std::string::npos) {
          return false;
        }
        continue;
      }
      // In a number with a point or with several commas, the commas separate thousands.
      if (!is_number && std::all_of(cell.begin(), cell.end(), [](char c) {
            return IsDigit(c) || c == ',' || c == '.' || c == '-';
          })) {
        return false;
      }
      if (!is_number) {
        continue;
      }
      const std::size_t point = cell.find('.');
      const auto end = std::find_if_not(cell.begin() + static_cast<std::ptrdiff_t>(point + 1),
                                        cell.end(), IsDigit);
      const std::ptrdiff_t decimals = end - cell.begin() - static_cast<std::ptrdiff_t>(point) - 1;
      has_decimals = has_decimals || decimals != 3;
    }
  }
  return has_decimals;
}

void NormalizeNumber(std::string& cell, bool has_decimal_commas) {
  if (cell.size() > 1 && cell.front() == '+' && (IsDigit(cell[1]) || cell[1] == '.')) {
    cell.erase(0, 1);
  }
  if (!has_decimal_commas) {
    return;
  }
  const std::size_t comma = cell.find(',');
  if (comma == std::string::npos) {
    return;
  }
  std::string pointed = cell;
  pointed[comma] = '.';
  if (CellNumber(pointed)) {
    cell = std::move(pointed);
  }
}

}  // namespace trackbed
