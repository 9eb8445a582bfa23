#include "src/cli/text_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace trackbed::cli {
namespace {

/// Returns the number of UTF-8 characters in a text; each character counts as one column.
std::size_t Width(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char byte) {
    return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U;
  }));
}

std::string FlushRight(const std::string& text, std::size_t width) {
  return std::string(width - std::min(width, Width(text)), ' ') + text;
}

}  // namespace

void TextColumns::Add(TextColumn column) {
  constexpr std::size_t kMinWidth = 9;
  LaidOutColumn laid{.heading = {}, .texts = std::move(column.texts), .width = kMinWidth};
  for (const auto* texts : {&column.words, &laid.texts}) {
    for (const std::string& text : *texts) {
      laid.width = std::max(laid.width, Width(text));
    }
  }
  for (const std::string& word : column.words) {
    if (!laid.heading.empty() && Width(laid.heading.back()) + 1 + Width(word) <= laid.width) {
      laid.heading.back() += " " + word;
    } else {
      laid.heading.push_back(word);
    }
  }
  laid.heading.push_back(column.unit.empty() ? "" : "[" + column.unit + "]");
  columns_.push_back(std::move(laid));
}

std::size_t TextColumns::CountWithin(std::size_t width) const {
  std::size_t used = 1;
  std::size_t count = 0;
  while (count < columns_.size() && used + 1 + columns_[count].width <= width) {
    used += 1 + columns_[count].width;
    ++count;
  }
  return count;
}

std::vector<std::string> TextColumns::Lines(std::size_t count) const {
  std::size_t height = 0;
  std::size_t rows = 0;
  for (std::size_t i = 0; i < count; ++i) {
    height = std::max(height, columns_[i].heading.size());
    rows = std::max(rows, columns_[i].texts.size());
  }
  std::vector<std::string> lines(height + rows, kIndent);
  for (std::size_t i = 0; i < count; ++i) {
    const LaidOutColumn& column = columns_[i];
    const std::size_t empty = height - column.heading.size();
    for (std::size_t line = 0; line < height; ++line) {
      lines[line] += kIndent;
      lines[line] += FlushRight(line < empty ? "" : column.heading[line - empty], column.width);
    }
    for (std::size_t row = 0; row < column.texts.size(); ++row) {
      lines[height + row] += kIndent;
      lines[height + row] += FlushRight(column.texts[row], column.width);
    }
  }
  return lines;
}

}  // namespace trackbed::cli
