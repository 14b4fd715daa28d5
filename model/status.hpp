// How a walk along a path ended, in a word and in a sentence.
#pragma once

#include <cstdio>
#include <string>

namespace grainlaw::model {

struct Status {
  enum class Code {
    ok,           ///< the end was reached
    unjammed,     ///< the end was reached, and the point carries no stress there: P = 0
    failed,       ///< the integration stopped; the state is that of the last row
    not_coaxial,  ///< the strain has another axis than the point, which has not moved
    limit         ///< a prescribed stress or strain cannot be reached; the state is where it ended on the way
  };
  Code code = Code::ok;
  std::string message;

  bool failed() const { return code == Code::failed || code == Code::not_coaxial; }
};

inline std::string name_of(Status::Code code) {
  switch (code) {
    case Status::Code::ok:
      return "ok";
    case Status::Code::unjammed:
      return "unjammed";
    case Status::Code::failed:
      return "failed";
    case Status::Code::not_coaxial:
      return "not_coaxial";
    case Status::Code::limit:
      return "limit";
  }
  return "";
}

/// A number for a sentence: six digits.
inline std::string shown(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

}  // namespace grainlaw::model
