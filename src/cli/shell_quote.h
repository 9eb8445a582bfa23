#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Quotes words for the programs that read the scripts of `completion` and `sweep submit`.
///
/// The quoting functions return nullopt for a word that cannot be quoted safely, because the word
/// is not UTF-8 or contains a control character such as a line feed.
namespace trackbed::cli {

/// Quotes a word for sh, bash and zsh, in single quotes.
std::optional<std::string> QuotedForSh(std::string_view word);

/// Quotes a word for fish in single quotes. Within single quotes, fish interprets \\ and \'.
std::optional<std::string> QuotedForFish(std::string_view word);

/// Quotes a word for a line `#SBATCH …` of a Slurm script, in double quotes. Slurm's parser
/// interprets a backslash as an escape character, inside and outside quotes.
std::optional<std::string> QuotedForSbatch(std::string_view word);

/// Quotes each word and joins the quoted words with blanks. AllQuoted omits words that cannot be
/// quoted safely.
std::string AllQuoted(const std::vector<std::string>& words,
                      std::optional<std::string> (*quoted)(std::string_view word));

/// Returns the text with every occurrence of `what` replaced by `by`.
std::string Replaced(const std::string& text, std::string_view what, std::string_view by);

}  // namespace trackbed::cli
