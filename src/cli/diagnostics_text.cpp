#include "src/cli/diagnostics_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "src/cli/text_columns.h"

namespace trackbed::cli {
namespace {

using Texts = std::vector<std::string>;

/// Column heading made from a field name; for example, the field "ramp_time_s" has the heading
/// words {"ramp", "time"} and the unit s.
struct Heading {
  Texts words;
  std::string unit;  ///< unit of the field; empty for dimensionless fields
};

Heading HeadingFor(std::string_view name) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 7> kUnits{{
      {"m", "m"},
      {"s", "s"},
      {"rad", "rad"},
      {"mps", "m/s"},
      {"mps2", "m/s^2"},
      {"radps", "rad/s"},
      {"radpm", "rad/m"},
  }};
  Heading heading;
  std::istringstream in{std::string(name)};
  for (std::string word; std::getline(in, word, '_');) {
    heading.words.push_back(word);
  }
  for (const auto& [suffix, unit] : kUnits) {
    if (heading.words.size() > 1 && heading.words.back() == suffix) {
      heading.words.pop_back();
      heading.unit = unit;
      break;
    }
  }
  return heading;
}

/// One field of a plan's diagnostics, formatted as text.
struct TextCell {
  std::string name;  ///< name of the field, prefixed by the names of the enclosing sections
  std::string text;
};

/// The fields of one list element in the diagnostics, or the fields of the plan outside all lists.
struct Fields {
  std::vector<TextCell> cells;
  Texts remarks;  ///< texts of several words, which are too long for a column of the table
};

/// A list in the diagnostics, such as the list of turns, which is printed as a table with one row
/// per element.
struct NamedList {
  std::string name;
  std::vector<Fields> rows;
};

/// Collects the fields and lists of a plan's diagnostics. The name of a field in a section begins
/// with the name of the section, as in "search_evaluations".
class Collector : public DiagnosticsVisitor {
 public:
  Collector(Fields& fields, std::vector<NamedList>& lists, std::string prefix = "")
      : fields_(fields), lists_(lists), prefix_(std::move(prefix)) {}

  [[nodiscard]] bool full() const override { return false; }

  void Number(const char* name, double value) override { Add(name, fmt::format("{:.5g}", value)); }
  void Integer(const char* name, std::int64_t value) override {
    Add(name, fmt::format("{}", value));
  }
  void Flag(const char* name, bool value) override { Add(name, value ? "yes" : "no"); }
  void Text(const char* name, const std::string& value) override {
    if (value.find(' ') != std::string::npos) {
      fields_.remarks.push_back(fmt::format("{}: {}", name, value));
    } else if (!value.empty()) {
      Add(name, value);
    }
  }
  void Numbers(const char* name, const std::vector<double>& values) override {
    Texts texts;
    for (const double value : values) {
      texts.push_back(fmt::format("{:.5g}", value));
    }
    Add(name, fmt::format("{}", fmt::join(texts, ", ")));
  }
  void Point(const char* name, const Vec2& value) override {
    Add(name, fmt::format("({:.4g}, {:.4g})", value.x(), value.y()));
  }
  void Points(const char* name, const std::vector<Vec2>& values) override {
    Add(name, fmt::format("{} points", values.size()));
  }

 protected:
  void VisitSection(const char* name, const Inside& inside) override {
    Collector inner(fields_, lists_, prefix_ + name + "_");
    inside(inner);
  }
  void VisitList(const char* name, std::size_t size, const Element& element) override {
    NamedList list{prefix_ + name, {}};
    for (std::size_t i = 0; i < size; ++i) {
      Fields& row = list.rows.emplace_back();
      Collector inner(row, lists_);
      element(inner, i);
    }
    if (!list.rows.empty()) {
      lists_.push_back(std::move(list));
    }
  }

 private:
  void Add(const char* name, std::string text) {
    fields_.cells.push_back({prefix_ + name, std::move(text)});
  }

  Fields& fields_;
  std::vector<NamedList>& lists_;
  std::string prefix_;
};

TextColumns MakeColumns(const NamedList& list) {
  struct Column {
    std::string name;
    Texts texts;  ///< cells of the column, one per row; "-" in rows without the field
  };
  std::vector<Column> columns;
  for (std::size_t row = 0; row < list.rows.size(); ++row) {
    for (const TextCell& cell : list.rows[row].cells) {
      auto column = std::find_if(columns.begin(), columns.end(),
                                 [&](const Column& each) { return each.name == cell.name; });
      if (column == columns.end()) {
        column = columns.insert(columns.end(), {cell.name, Texts(list.rows.size(), "-")});
      }
      column->texts[row] = cell.text;
    }
  }
  TextColumns laid;
  for (Column& column : columns) {
    Heading heading = HeadingFor(column.name);
    laid.Add({std::move(heading.words), std::move(heading.unit), std::move(column.texts)});
  }
  return laid;
}

std::string TableText(const NamedList& list) {
  const Texts lines = MakeColumns(list).Lines();
  const std::size_t heading = lines.size() - list.rows.size();
  std::string text = fmt::format("  {}\n", list.name);
  for (std::size_t line = 0; line < lines.size(); ++line) {
    text += lines[line] + "\n";
    if (line >= heading) {
      for (const std::string& remark : list.rows[line - heading].remarks) {
        text += fmt::format("      {}\n", remark);
      }
    }
  }
  return text;
}

}  // namespace

std::string DiagnosticsText(const Plan& plan) {
  Fields fields;
  std::vector<NamedList> lists;
  Collector collector(fields, lists);
  Visit(collector, plan);
  std::string text;
  for (const NamedList& list : lists) {
    text += TableText(list);
  }
  for (const TextCell& cell : fields.cells) {
    const Heading heading = HeadingFor(cell.name);
    text += fmt::format("  {}: {}{}{}\n", fmt::join(heading.words, " "), cell.text,
                        heading.unit.empty() ? "" : " ", heading.unit);
  }
  for (const std::string& remark : fields.remarks) {
    text += fmt::format("  {}\n", remark);
  }
  return text;
}

}  // namespace trackbed::cli
