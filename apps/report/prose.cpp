#include "grainlaw/apps/report/prose.hpp"

#include <charconv>
#include <string>

#include "grainlaw/apps/report/numbers.hpp"
#include "grainlaw/apps/report/symbols.hpp"

namespace grainlaw::report {
namespace {

/// Bytes of the character of a name at the start of `rest`: a letter of ASCII or Greek, a digit, "_"; 0 if
/// there is none.
std::size_t letter_at(std::string_view rest) {
  if (rest.empty()) return 0;
  const char c = rest[0];
  const bool ascii = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  if (ascii) return 1;
  const auto lead = static_cast<unsigned char>(c);
  return (lead == 0xce || lead == 0xcf) && rest.size() > 1 ? 2 : 0;
}

std::string_view name_at(std::string_view rest) {
  std::size_t length = 0;
  while (const std::size_t letter = letter_at(rest.substr(length))) length += letter;
  return rest.substr(0, length);
}

/// "E_k", "φ_r", "α" as a letter with an index; nothing for any other word.
Markup letter_with_index(std::string_view name) {
  const std::size_t letter = letter_at(name);
  const bool greek = letter == 2;
  const std::string_view rest = name.substr(letter);
  const bool plain_ok = greek || name == "Q" || name == "B" || name == "G" || name == "p";
  const Markup var = element("var", text(name.substr(0, letter)));
  if (rest.empty()) return plain_ok ? var : Markup();
  const bool one_index = rest.size() > 1 && rest[0] == '_' && rest.find('_', 1) == std::string_view::npos;
  const bool is_letter = greek || name[0] > '9';
  return one_index && is_letter ? var + element("sub", text(rest.substr(1))) : Markup();
}

Markup known_name(std::string_view name, std::string_view group) {
  if (name == "eps") return "<var>ε</var>"_html;
  for (const std::string_view part : {group, std::string_view("isotropic"), std::string_view("memory")}) {
    if (const Symbol* symbol = find_symbol(name, part)) return Markup::trusted(std::string(symbol->html));
  }
  const Markup letter = letter_with_index(name);
  return letter.empty() ? text(name) : letter;
}

std::string_view starred_name(std::string_view name) {
  if (name == "C") return "C_star";
  if (name == "p") return "p_star";
  if (name == "k") return "k_star";
  return name;
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Characters that stand for better ones: what to read, what to write.
struct Sign {
  std::string_view plain, written;
};
constexpr Sign signs[] = {{" - ", " − "}, {"[-", "[−"}, {"(-", "(−"}, {">=", "≥"}, {"<=", "≤"}};

const Sign* sign_at(std::string_view rest) {
  static constexpr Sign negative{" -", " −"};
  if (rest.starts_with(negative.plain) && rest.size() > 2 && is_digit(rest[2])) return &negative;
  for (const Sign& sign : signs) {
    if (rest.starts_with(sign.plain)) return &sign;
  }
  return nullptr;
}

/// Length of a number with an exponent ("5e-04") at the start of `rest`, and its value; 0 for anything else.
std::size_t scientific_at(std::string_view rest, double& value) {
  if (!is_digit(rest[0])) return 0;
  const auto end = std::from_chars(rest.data(), rest.data() + rest.size(), value).ptr;
  const auto length = static_cast<std::size_t>(end - rest.data());
  const bool goes_on = length < rest.size() && letter_at(rest.substr(length)) > 0;
  return rest.substr(0, length).find('e') != std::string_view::npos && !goes_on ? length : 0;
}

/// The name at the start of `plain`, which it removes together with a star that belongs to it.
Markup take_name(std::string_view& plain, std::string_view group) {
  const std::string_view name = name_at(plain);
  plain.remove_prefix(name.size());
  const bool starred = plain.starts_with('*');
  // "C*", "p*" and "k*" are names of their own; "P" is already written with its star.
  const std::string_view full = starred ? starred_name(name) : name;
  if (starred && (full != name || name == "P")) plain.remove_prefix(1);
  return known_name(full, group);
}

}  // namespace

Markup prose(std::string_view plain, std::string_view group) {
  Markup html;
  while (!plain.empty()) {
    double value = 0;
    if (const std::size_t figures = scientific_at(plain, value)) {
      html += text(number(value, 6));
      plain.remove_prefix(figures);
    } else if (!name_at(plain).empty()) {
      html += take_name(plain, group);
    } else if (plain[0] == '^' && !name_at(plain.substr(1)).empty()) {
      plain.remove_prefix(1);
      html += element("sup", take_name(plain, group));
    } else if (const Sign* sign = sign_at(plain)) {
      html += text(sign->written);
      plain.remove_prefix(sign->plain.size());
    } else {
      // Whatever else, up to where something known may begin.
      std::size_t length = 1;
      while (length < plain.size() && letter_at(plain.substr(length)) == 0 && plain[length] != '^' &&
             !sign_at(plain.substr(length))) {
        ++length;
      }
      html += text(plain.substr(0, length));
      plain.remove_prefix(length);
    }
  }
  return html;
}

}  // namespace grainlaw::report
