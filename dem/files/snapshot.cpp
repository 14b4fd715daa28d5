#include "grainlaw/dem/files/snapshot.hpp"

#include <cmath>

#include "grainlaw/element/error.hpp"

namespace grainlaw::dem {

namespace {

constexpr double farthest_nu = 1e-3;  ///< a frame farther from the wanted nu is another state
constexpr double equal_nu = 1e-4;     ///< two frames this alike in nu cannot be told apart by nu

std::string describe(const std::vector<Observables>& frames, std::size_t i) {
  return "frame " + std::to_string(i) + " (segment " + std::to_string(frames[i].segment) + ", nu " +
         to_text(frames[i].nu) + ")";
}

std::string where(const FrameChoice& choice) {
  return choice.segment ? " in segment " + std::to_string(*choice.segment) : "";
}

/// The frames that may be meant: all, or those of one segment.
std::vector<std::size_t> candidates(const std::vector<Observables>& frames, const FrameChoice& choice,
                                    const std::filesystem::path& file) {
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < frames.size(); ++i)
    if (!choice.segment || frames[i].segment == *choice.segment) indices.push_back(i);
  if (indices.empty()) throw Error(file.string(), "", "has no frame" + where(choice));
  return indices;
}

}  // namespace

std::size_t find_frame(const std::vector<Observables>& frames, const FrameChoice& choice,
                       const std::filesystem::path& file) {
  if (choice.frame) {
    if (*choice.frame >= frames.size())
      throw Error(file.string(), "",
                  "has no frame " + std::to_string(*choice.frame) + ", only frames 0 to " +
                      std::to_string(static_cast<std::int64_t>(frames.size()) - 1));
    return *choice.frame;
  }
  const auto indices = candidates(frames, choice, file);
  if (!choice.nu) return indices.back();
  const auto distance = [&](std::size_t i) { return std::abs(frames[i].nu - *choice.nu); };
  std::size_t nearest = indices.front();
  for (const auto i : indices)
    if (distance(i) < distance(nearest)) nearest = i;
  if (distance(nearest) > farthest_nu)
    throw Error(file.string(), "",
                "has no frame within 0.001 of nu = " + to_text(*choice.nu) + where(choice) +
                    "; the nearest is " + describe(frames, nearest));
  for (const auto i : indices)
    if (i != nearest && distance(i) <= farthest_nu && distance(i) - distance(nearest) < equal_nu)
      throw Error(file.string(), "",
                  "nu = " + to_text(*choice.nu) + " does not say which frame: " + describe(frames, nearest) +
                      " or " + describe(frames, i) + "; give segment or frame");
  return nearest;
}

}  // namespace grainlaw::dem
