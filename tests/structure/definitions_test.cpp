#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "tests/structure/files.h"

namespace {

namespace fs = std::filesystem;

/// A header whose functions several sources define, and the reason. A table of variants has one
/// source for each variant. Other headers must not be added: split the header instead.
struct OfSeveralSources {
  std::string_view header;
  std::string_view reason;
};
constexpr OfSeveralSources kOfSeveralSources[] = {
    {"include/trackbed/core/version.h", "the build generates the source"},
    {"include/trackbed/render/film.h", "a build without FFmpeg has another source"},
    {"render/gl_context.h", "one source for each library of OpenGL"},
    {"render/video.h", "one source for each file format"},
    {"src/analysis/evaluations.h", "one source for each kind of maneuver"},
    {"src/bag/sources.h", "one source for each format of bags"},
    {"src/cli/verbs.h", "one source for each verb"},
    {"src/optimize/ipopt/ipopt.h", "a build without IPOPT has another source"},
    {"src/path_files/formats.h", "one source for each format of path files"},
    {"src/sim/plants.h", "one source for each plant"},
};

/// Returns the text of a file without comments, preprocessor lines, and the contents of literals.
std::string CodeOf(const fs::path& file) {
  std::ostringstream read;
  read << std::ifstream(file).rdbuf();
  const std::string text = read.str();
  std::string code;
  const auto skip_to = [&](std::size_t& i, std::string_view end) {
    const std::size_t found = text.find(end, i);
    i = found == std::string::npos ? text.size() : found + end.size();
  };
  bool is_line_start = true;
  for (std::size_t i = 0; i < text.size();) {
    const std::string_view rest = std::string_view(text).substr(i);
    if (rest.starts_with("//")) {
      skip_to(i, "\n");
      is_line_start = true;
    } else if (rest.starts_with("/*")) {
      skip_to(i, "*/");
    } else if (is_line_start && rest.front() == '#') {
      while (i < text.size() && text[i] != '\n') {
        i += text[i] == '\\' ? 2U : 1U;
      }
    } else if (rest.starts_with("R\"")) {
      std::string end(1, ')');
      end.append(text, i + 2, text.find('(', i) - i - 2);
      end += '"';
      skip_to(i, end);
    } else if (rest.front() == '"' ||
               (rest.front() == '\'' &&
                (code.empty() || std::isalnum(static_cast<unsigned char>(code.back())) == 0))) {
      const char quote = rest.front();
      for (++i; i < text.size() && text[i] != quote; ++i) {
        i += text[i] == '\\' ? 1U : 0U;
      }
      ++i;
    } else {
      is_line_start = rest.front() == '\n' || (is_line_start && rest.front() == ' ');
      code += rest.front();
      ++i;
    }
  }
  return code;
}

bool IsOfName(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Returns the name of the free function that a declaration or the head of a definition begins; ""
/// for other declarations, for templates and inline functions, and for members of classes.
std::string FunctionName(const std::string& head) {
  static const std::set<std::string> kOthers{"struct",    "class",  "enum",     "union",
                                             "using",     "friend", "typedef",  "template",
                                             "constexpr", "inline", "operator", "static_assert"};
  int templates = 0;
  std::size_t open = 0;
  for (; open < head.size() && (head[open] != '(' || templates > 0); ++open) {
    if (head[open] == '=') {
      return "";
    }
    templates += head[open] == '<' ? 1 : (head[open] == '>' ? -1 : 0);
  }
  if (open == head.size()) {
    return "";
  }
  std::vector<std::string> words{""};
  for (std::size_t i = 0; i < open; ++i) {
    if (IsOfName(head[i])) {
      words.back() += head[i];
    } else if (!words.back().empty()) {
      words.emplace_back();
    }
  }
  if (words.back().empty() || words.size() < 2 ||
      std::any_of(words.begin(), words.end(),
                  [](const std::string& word) { return kOthers.count(word) > 0; })) {
    return "";
  }
  const std::size_t begin = open - words.back().size();
  return begin > 0 && head[begin - 1] == ':' ? "" : words.back();
}

/// The free functions of a file.
struct Functions {
  std::vector<std::string> declared{};
  std::set<std::string> defined{};
};

Functions FunctionsOf(const fs::path& file) {
  Functions functions;
  std::vector<bool> is_namespace;  // for each open brace
  std::string head;                // of the declaration so far, outside of other braces
  int defaults = 0;                // open braces of default arguments
  const auto is_outside = [&] {
    return std::all_of(is_namespace.begin(), is_namespace.end(), [](bool is) { return is; });
  };
  for (const char c : CodeOf(file)) {
    const bool outside = is_outside();
    const std::size_t last = head.find_last_not_of(" \n");
    if (c == '{' && outside && last != std::string::npos && head[last] == '=') {
      ++defaults;  // the default of an argument
    } else if (c == '}' && defaults > 0) {
      --defaults;
    } else if (defaults > 0) {
      continue;
    } else if (c == '{') {
      const bool opens = outside && head.find("namespace") != std::string::npos;
      is_namespace.push_back(opens);
      if (opens) {
        head.clear();
      } else if (const std::string name = FunctionName(head); outside && !name.empty()) {
        functions.defined.insert(name);
      }
      head += opens ? "" : "{";
    } else if (c == '}' && !is_namespace.empty()) {
      is_namespace.pop_back();
      // The body of a function ends without a semicolon.
      if (is_outside() &&
          (head.find('{') == std::string::npos || !FunctionName(head).empty() ||
           head.find(") ") != std::string::npos || head.find(")\n") != std::string::npos)) {
        head.clear();
      }
    } else if (outside && c == ';') {
      const std::string name = FunctionName(head);
      if (!name.empty() && head.find('{') == std::string::npos) {
        functions.declared.push_back(name);
      }
      head.clear();
    } else if (outside) {
      head += c;
    }
  }
  return functions;
}

/// The functions of all sources of a folder, by file name without extension.
std::map<std::string, std::set<std::string>> SourcesOf(const fs::path& folder) {
  std::map<std::string, std::set<std::string>> sources;
  if (fs::exists(folder)) {
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (entry.path().extension() == ".cpp") {
        sources[entry.path().stem().string()] = FunctionsOf(entry.path()).defined;
      }
    }
  }
  return sources;
}

// A function that x.h declares is defined in x.cpp, so that a reader finds the definition.
TEST(Functions, AreDefinedInTheSourceOfTheirHeader) {
  std::size_t seen = 0;
  std::map<fs::path, std::map<std::string, std::set<std::string>>> folders;
  for (const char* tree : {"include/trackbed", "src", "render"}) {
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / tree)) {
      const fs::path& header = entry.path();
      if (header.extension() != ".h") {
        continue;
      }
      const fs::path inside = fs::relative(header.parent_path(), kRoot / tree);
      const fs::path folder = std::string_view(tree) == "render" || inside == "render"
                                  ? kRoot / "render" / (inside == "render" ? "." : inside)
                                  : kRoot / "src" / inside;
      const auto [at, is_new] = folders.try_emplace(folder);
      if (is_new) {
        at->second = SourcesOf(folder);
      }
      const Functions functions = FunctionsOf(header);
      const std::string name = fs::relative(header, kRoot).generic_string();
      const bool is_of_several =
          std::any_of(std::begin(kOfSeveralSources), std::end(kOfSeveralSources),
                      [&](const OfSeveralSources& each) { return each.header == name; });
      bool has_others = false;
      for (const std::string& function : functions.declared) {
        ++seen;
        const auto source = at->second.find(header.stem().string());
        if (functions.defined.count(function) > 0 ||
            (source != at->second.end() && source->second.count(function) > 0)) {
          continue;
        }
        has_others = true;
        EXPECT_TRUE(is_of_several) << name << " declares " << function
                                   << ", which the source of this name does not define";
      }
      EXPECT_EQ(has_others, is_of_several) << name << ": the list kOfSeveralSources is outdated";
    }
  }
  EXPECT_GT(seen, 1000U);  // the scan found the headers
}

}  // namespace
