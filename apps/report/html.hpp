// Markup as a type of its own, so that text from a file cannot reach the page unescaped.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace grainlaw::report {

/// A piece of well-formed markup. Made from text by text(), from literals by ""_html, from pieces by
/// element() and +.
class Markup {
 public:
  Markup() = default;
  /// For markup that this program wrote itself.
  static Markup trusted(std::string html);

  const std::string& str() const { return html_; }
  bool empty() const { return html_.empty(); }
  Markup& operator+=(const Markup& more);
  friend Markup operator+(Markup left, const Markup& right) { return left += right; }

 private:
  std::string html_;
};

/// Escapes & < > " ' and drops what HTML may not contain (control characters, bytes that are not UTF-8).
Markup text(std::string_view plain);

using Attributes = std::vector<std::pair<std::string, std::string>>;

/// <name attributes>content</name>; attribute values are escaped.
Markup element(const std::string& name, const Markup& content, const Attributes& attributes = {});

Markup operator""_html(const char* html, std::size_t size);

/// Joins pieces with a separator between them.
Markup join(const std::vector<Markup>& pieces, const Markup& separator);

/// A table with a head; a cell is text by default, a number column is right-aligned.
class Table {
 public:
  enum class Kind { words, figures };
  Table& column(const Markup& head, Kind kind = Kind::words);
  /// A heading row that spans all columns.
  void group(const Markup& title);
  /// Throws std::logic_error unless there are as many cells as columns.
  void row(const std::vector<Markup>& cells);
  bool empty() const { return body_.empty(); }
  Markup html(const std::string& css_class = "") const;

 private:
  std::vector<std::pair<Markup, Kind>> columns_;
  Markup body_;
};

}  // namespace grainlaw::report
