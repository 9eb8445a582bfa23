#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace trackbed {

/// Parses a JSON text. Throws InputError if the text is not valid JSON.
nlohmann::json ParseJsonText(const std::string& text, const std::string& file);
/// Parses the first document of a YAML text, with numbers as in JSON. ParseYamlText ignores further
/// documents in the text. Throws InputError if the text is not valid YAML.
nlohmann::json ParseYamlText(const std::string& text, const std::string& file);

/// Returns the number that a JSON object contains at `key`. Throws InputError unless the number is
/// finite and its magnitude is at most `largest`.
double NumberOf(const nlohmann::json& value, const std::string& key, double largest,
                const std::string& file);

}  // namespace trackbed
