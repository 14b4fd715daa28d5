#include "grainlaw/element/words.hpp"

#include <algorithm>
#include <cctype>

namespace grainlaw {

namespace {

bool same_letter(char a, char b) {
  return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
}

/// Number of single-letter edits between two keys (Levenshtein); a letter's case does not count, so that "W"
/// is nearer to "w" than to "k".
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replace = diagonal + (same_letter(a[i - 1], b[j - 1]) ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replace});
    }
  }
  return row[b.size()];
}

std::string probably(const std::string& word, const std::vector<std::string>& allowed) {
  const std::string near = nearest_word(word, allowed);
  return near.empty() ? "" : "; did you mean " + near + "?";
}

std::string read_word(const Reader& reader, const std::string& key, const Json& item,
                      const std::vector<std::string>& allowed, const HintOnWord& hint) {
  const std::string word = item.is_string() ? item.get<std::string>() : "";
  if (std::find(allowed.begin(), allowed.end(), word) != allowed.end()) return word;
  std::string list;
  for (const auto& one : allowed) list += (list.empty() ? "" : ", ") + one;
  const std::string told = hint ? hint(word) : "";
  reader.fail(key, "must be one of " + list + ", got " +
                       item.dump(-1, ' ', false, Json::error_handler_t::replace) +
                       (told.empty() ? probably(word, allowed) : told));
}

}  // namespace

std::string nearest_word(std::string_view name, const std::vector<std::string>& words) {
  std::string nearest;
  for (const std::string& word : words)
    if (nearest.empty() || distance(word, name) < distance(nearest, name)) nearest = word;
  const bool close = !nearest.empty() && distance(nearest, name) <= std::max<std::size_t>(1, name.size() / 3);
  return close ? nearest : "";
}

std::vector<std::string> read_words(Reader& reader, std::string_view key,
                                    const std::vector<std::string>& allowed,
                                    const std::vector<std::string>& fallback, const HintOnWord& hint) {
  reader.optional({key});
  if (!reader.has(key)) return fallback;
  const Json& list = reader.raw(key);
  if (!list.is_array()) reader.fail(key, "must be a list of words");
  std::vector<std::string> words;
  for (const Json& item : list) {
    const std::string place = std::string(key) + "[" + std::to_string(words.size()) + "]";
    words.push_back(read_word(reader, place, item, allowed, hint));
    if (std::count(words.begin(), words.end(), words.back()) > 1)
      reader.fail(place, "is given twice, got " + words.back());
  }
  return words;
}

}  // namespace grainlaw
