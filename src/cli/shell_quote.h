#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Quotes words for the programs that read the scripts of `completion` and `sweep submit`.
///
/// A word that no quotes make safe gives no value: one with a control character, such as a line
/// feed, which ends a line of the script, and one that is not UTF-8.
namespace trackbed::cli {

/// As one word for sh, bash and zsh: in single quotes.
std::optional<std::string> QuotedForSh(std::string_view word);

/// As one word for fish: in single quotes, in which fish reads \\ and \'.
std::optional<std::string> QuotedForFish(std::string_view word);

/// As one word of a line `#SBATCH …`: in double quotes. Slurm's parser takes a backslash, with or
/// without quotes around it, as a sign that the next character stands for itself.
std::optional<std::string> QuotedForSbatch(std::string_view word);

/// The words that can be quoted, with a blank between them.
std::string AllQuoted(const std::vector<std::string>& words,
                      std::optional<std::string> (*quoted)(std::string_view word));

}  // namespace trackbed::cli
