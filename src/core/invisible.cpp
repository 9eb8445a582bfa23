#include "trackbed/core/invisible.h"

#include <algorithm>
#include <array>

namespace trackbed {
namespace {

using boost::locale::utf::code_point;

struct CodePointRange {
  code_point first;
  code_point last;
};

constexpr std::array kInvisibleRanges{
    CodePointRange{0x00, 0x08},      CodePointRange{0x0B, 0x1F},     CodePointRange{0x7F, 0x9F},
    CodePointRange{0xAD, 0xAD},      CodePointRange{0x061C, 0x061C}, CodePointRange{0x180E, 0x180E},
    CodePointRange{0x200B, 0x200B},  CodePointRange{0x200E, 0x200F}, CodePointRange{0x2028, 0x202E},
    CodePointRange{0x2060, 0x206F},  CodePointRange{0xFEFF, 0xFEFF}, CodePointRange{0xFFF9, 0xFFFB},
    CodePointRange{0xE0000, 0xE007F}};

}  // namespace

bool IsInvisible(code_point c) {
  return std::any_of(
      kInvisibleRanges.begin(), kInvisibleRanges.end(),
      [c](const CodePointRange& range) { return range.first <= c && c <= range.last; });
}

}  // namespace trackbed
