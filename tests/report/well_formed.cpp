#include "well_formed.hpp"

#include <algorithm>
#include <map>

namespace grainlaw::report::test {
namespace {

bool is_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_' || c == ':';
}

class Parser {
 public:
  explicit Parser(const std::string& html) : html_(html) {}

  Page parse() {
    const std::string doctype = "<!DOCTYPE html>";
    if (html_.starts_with(doctype)) at_ = doctype.size();
    while (at_ < html_.size()) {
      if (html_[at_] == '<') {
        tag();
      } else if (html_[at_] == '&') {
        page_.text += entity();
      } else {
        page_.text += html_[at_++];
      }
    }
    for (const std::string& name : open_) problem("<" + name + "> is never closed");
    auto ids = page_.ids;
    std::sort(ids.begin(), ids.end());
    for (std::size_t i = 1; i < ids.size(); ++i) {
      if (ids[i] == ids[i - 1]) problem("id " + ids[i] + " is used twice");
    }
    return page_;
  }

 private:
  void problem(const std::string& what) {
    page_.problems.push_back(what + " near \"" + html_.substr(at_ < 40 ? 0 : at_ - 40, 80) + "\"");
  }

  std::string entity() {
    static const std::map<std::string, std::string> known{
        {"&amp;", "&"}, {"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&#39;", "'"}};
    const auto end = html_.find(';', at_);
    const std::string name = end == std::string::npos ? "" : html_.substr(at_, end + 1 - at_);
    const auto found = known.find(name);
    if (found == known.end()) {
      problem("an unknown entity");
      ++at_;
      return "";
    }
    at_ = end + 1;
    return found->second;
  }

  std::string name() {
    const auto start = at_;
    while (at_ < html_.size() && is_name(html_[at_])) ++at_;
    return html_.substr(start, at_ - start);
  }

  void spaces() {
    while (at_ < html_.size() && std::isspace(static_cast<unsigned char>(html_[at_]))) ++at_;
  }

  void closing_tag() {
    const std::string closed = name();
    if (open_.empty() || open_.back() != closed) {
      problem("</" + closed + "> closes " + (open_.empty() ? "nothing" : "<" + open_.back() + ">"));
    } else {
      open_.pop_back();
    }
    spaces();
    if (html_[at_] != '>') problem("</" + closed + " without >");
    ++at_;
  }

  void attribute() {
    const std::string key = name();
    const char quote = at_ + 1 < html_.size() && html_[at_] == '=' ? html_[at_ + 1] : ' ';
    if (key.empty() || (quote != '"' && quote != '\'')) {
      problem("an attribute without a quoted value");
      ++at_;
      return;
    }
    at_ += 2;
    std::string value;
    while (at_ < html_.size() && html_[at_] != quote) {
      if (html_[at_] == '<') problem("< in an attribute");
      if (html_[at_] == '&') {
        value += entity();
      } else {
        value += html_[at_++];
      }
    }
    ++at_;
    if (key == "id") page_.ids.push_back(value);
    if (key == "href") page_.links.push_back(value);
  }

  void tag() {
    ++at_;
    if (at_ < html_.size() && html_[at_] == '/') {
      ++at_;
      return closing_tag();
    }
    const std::string opened = name();
    if (opened.empty()) return problem("a bare <");
    page_.tags.push_back(opened);
    for (spaces(); at_ < html_.size() && html_[at_] != '>' && html_[at_] != '/'; spaces()) attribute();
    const bool empty = at_ < html_.size() && html_[at_] == '/';
    at_ += empty ? 2 : 1;
    if (!empty) open_.push_back(opened);
    if (opened == "style") at_ = std::min(html_.find("</style>", at_), html_.size());
  }

  const std::string& html_;
  std::size_t at_ = 0;
  std::vector<std::string> open_;
  Page page_;
};

}  // namespace

Page parse(const std::string& html) { return Parser(html).parse(); }

}  // namespace grainlaw::report::test
