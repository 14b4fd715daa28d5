#include "grainlaw/apps/report/html.hpp"

#include <stdexcept>

namespace grainlaw::report {
namespace {

/// Length of the well-formed UTF-8 character at the start of `s`, 0 if there is none.
std::size_t utf8_length(std::string_view s) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(s[i]); };
  const unsigned char lead = byte(0);
  const std::size_t length = lead < 0x80   ? 1
                             : lead < 0xc2 ? 0
                             : lead < 0xe0 ? 2
                             : lead < 0xf0 ? 3
                             : lead < 0xf5 ? 4
                                           : 0;
  if (length == 0 || length > s.size()) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return 0;
  }
  // Overlong forms, surrogates and what lies beyond Unicode.
  if (length == 3 && ((lead == 0xe0 && byte(1) < 0xa0) || (lead == 0xed && byte(1) > 0x9f))) return 0;
  if (length == 4 && ((lead == 0xf0 && byte(1) < 0x90) || (lead == 0xf4 && byte(1) > 0x8f))) return 0;
  return length;
}

}  // namespace

Markup Markup::trusted(std::string html) {
  Markup markup;
  markup.html_ = std::move(html);
  return markup;
}

Markup& Markup::operator+=(const Markup& more) {
  html_ += more.html_;
  return *this;
}

Markup text(std::string_view plain) {
  std::string html;
  while (!plain.empty()) {
    const std::size_t length = utf8_length(plain);
    const char c = plain[0];
    if (length == 0) {
      html += "\uFFFD";
    } else if (c == '&') {
      html += "&amp;";
    } else if (c == '<') {
      html += "&lt;";
    } else if (c == '>') {
      html += "&gt;";
    } else if (c == '"') {
      html += "&quot;";
    } else if (c == '\'') {
      html += "&#39;";
    } else if (length > 1 || c == '\n' || c == '\t' || (c >= ' ' && c != 0x7f)) {
      html += plain.substr(0, length);
    }
    plain.remove_prefix(length == 0 ? 1 : length);
  }
  return Markup::trusted(std::move(html));
}

Markup element(const std::string& name, const Markup& content, const Attributes& attributes) {
  std::string html = "<" + name;
  for (const auto& [key, value] : attributes) html += " " + key + "=\"" + text(value).str() + "\"";
  html += ">" + content.str() + "</" + name + ">";
  return Markup::trusted(std::move(html));
}

Markup operator""_html(const char* html, std::size_t size) { return Markup::trusted({html, size}); }

Markup join(const std::vector<Markup>& pieces, const Markup& separator) {
  Markup all;
  for (std::size_t i = 0; i < pieces.size(); ++i) all += i == 0 ? pieces[i] : separator + pieces[i];
  return all;
}

Table& Table::column(const Markup& head, Kind kind) {
  columns_.emplace_back(head, kind);
  return *this;
}

void Table::group(const Markup& title) {
  body_ += element(
      "tr", element("th", title, {{"colspan", std::to_string(columns_.size())}, {"scope", "rowgroup"}}),
      {{"class", "group"}});
  body_ += "\n"_html;
}

void Table::row(const std::vector<Markup>& cells) {
  if (cells.size() != columns_.size()) throw std::logic_error("a table row needs one cell per column");
  Markup html;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    html += element("td", cells[i],
                    columns_[i].second == Kind::figures ? Attributes{{"class", "n"}} : Attributes{});
  }
  body_ += element("tr", html) + "\n"_html;
}

Markup Table::html(const std::string& css_class) const {
  Markup head;
  for (const auto& [title, kind] : columns_) {
    Attributes attributes{{"scope", "col"}};
    if (kind == Kind::figures) attributes.emplace_back("class", "n");
    head += element("th", title, attributes);
  }
  const Markup table = element("thead", element("tr", head)) + "\n"_html + element("tbody", body_);
  // Wide tables scroll inside their own box, the page does not.
  return element("div",
                 element("table", table, css_class.empty() ? Attributes{} : Attributes{{"class", css_class}}),
                 {{"class", "scroll"}}) +
         "\n"_html;
}

}  // namespace grainlaw::report
