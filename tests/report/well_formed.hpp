// A small checker of markup: enough to find a tag that is not closed, an id used twice, a quote that is
// missing.
#pragma once

#include <string>
#include <vector>

namespace grainlaw::report::test {

struct Page {
  std::vector<std::string> problems;  ///< empty if the markup is well formed
  std::vector<std::string> tags, ids, links;
  std::string text;  ///< what a reader sees, entities decoded, without the style sheet
};

/// Parses a page written as XML-compatible HTML 5: every element is closed, every attribute quoted.
Page parse(const std::string& html);

}  // namespace grainlaw::report::test
