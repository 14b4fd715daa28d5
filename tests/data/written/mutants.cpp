#include "mutants.hpp"

#include <set>

#include "grainlaw/element/error.hpp"

namespace grainlaw::tests {

namespace {

const std::vector<Json>& replacements() {
  static const std::vector<Json> list{nullptr, true, "text", "", Json::array(), Json::object(), -1, 0, 0.5,
                                      1,       1.5,  2,      1e9};
  return list;
}

std::string said(const Json& document, const std::string& file, const Read& read) {
  try {
    read(Reader(document, file));
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

/// All changes of one document, each made once in all documents.
class Mutator {
 public:
  Mutator(std::string file, Read read) : file_(std::move(file)), read_(std::move(read)) {}

  void mutate(const Json& good) {
    bases_.push_back(good);
    visit(good, Json::json_pointer());
  }
  Json result() const { return {{"bases", bases_}, {"mutants", mutants_}}; }

 private:
  void visit(const Json& node, const Json::json_pointer& at) {
    if (node.is_object() && first(at, node, "", "unknown")) set(at / "unknown", 1);
    if (!node.is_structured()) return;
    for (std::size_t i = 0; i < node.size(); ++i) {
      const auto item = std::next(node.begin(), static_cast<std::ptrdiff_t>(i));
      const auto inner = node.is_object() ? at / item.key() : at / i;
      if (first(at, node, inner.back(), "remove")) remove(inner);
      for (const Json& value : replacements())
        if (value != *item && first(at, node, inner.back(), value.dump())) set(inner, value);
      visit(*item, inner);
    }
  }

  /// Whether this change, in an object with this content, has not been made in another document.
  bool first(const Json::json_pointer& at, const Json& node, const std::string& key,
             const std::string& change) {
    return done_.insert(at.to_string() + node.dump() + key + change).second;
  }

  void set(const Json::json_pointer& at, const Json& value) {
    Json document = bases_.back();
    document[at] = value;
    note({{"set", {{at.to_string(), value}}}}, document);
  }

  void remove(const Json::json_pointer& at) {
    Json document = bases_.back(), &parent = document.at(at.parent_pointer());
    if (parent.is_object())
      parent.erase(at.back());
    else
      parent.erase(static_cast<std::size_t>(std::stoul(at.back())));
    note({{"remove", {at.to_string()}}}, document);
  }

  void note(Json change, const Json& document) {
    change["base"] = bases_.size() - 1;
    change["said"] = said(document, file_, read_);
    mutants_.push_back(std::move(change));
  }

  std::string file_;
  Read read_;
  std::set<std::string> done_;
  Json bases_ = Json::array(), mutants_ = Json::array();
};

}  // namespace

Json mutants(const std::vector<Json>& good, const std::string& file, const Read& read) {
  Mutator mutator(file, read);
  for (const Json& document : good) mutator.mutate(document);
  return mutator.result();
}

}  // namespace grainlaw::tests
