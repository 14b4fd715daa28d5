// Reads what lammps_data() writes.
#pragma once

#include <gtest/gtest.h>

#include <istream>
#include <sstream>
#include <string>

#include "grainlaw/dem/packing/state.hpp"
#include "grainlaw/element/material.hpp"

namespace grainlaw::dem::test {

/// The packing of a data file, whose comments are left out, its box perhaps tilted.
inline State read_lammps(std::istream& file) {
  std::string text, line;
  std::getline(file, line);  // the title
  while (std::getline(file, line)) text += line.substr(0, line.find('#')) + "\n";
  std::istringstream words(text);
  const auto next = [&] {
    for (std::string word; words >> word;)
      if (word.find_first_not_of("+-.e0123456789") == std::string::npos) return std::stod(word);
    ADD_FAILURE() << "the file is short";
    return 0.0;
  };
  State state;
  const auto count = static_cast<std::size_t>(next());
  EXPECT_EQ(next(), 1);  // type of atoms
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(next(), 0);
    state.box(c, c) = next();
  }
  if (text.find("xy xz yz") != std::string::npos)
    for (const auto& [row, column] : {std::pair{0u, 1u}, std::pair{0u, 2u}, std::pair{1u, 2u}})
      state.box(row, column) = next();
  for (std::size_t i = 0; i < count; ++i) {
    EXPECT_EQ(next(), static_cast<double>(i + 1));
    EXPECT_EQ(next(), 1);
    state.radius.push_back(0.5 * next());
    EXPECT_EQ(next(), Material{}.rho);
    state.position.push_back({next(), next(), next()});
  }
  for (std::size_t i = 0; i < count; ++i) {
    EXPECT_EQ(next(), static_cast<double>(i + 1));
    state.velocity.push_back({next(), next(), next()});
    for (int c = 0; c < 3; ++c) EXPECT_EQ(next(), 0);  // spin
  }
  return state;
}

}  // namespace grainlaw::dem::test
