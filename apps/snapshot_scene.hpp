// The material of the grains in a file of snapshots.
#pragma once

#include <filesystem>
#include <string>

#include "grainlaw/dem/files/snapshot.hpp"
#include "grainlaw/dem/scene/scene.hpp"

namespace grainlaw::apps {

/// The scene that says of which material the grains are: `given`, or where that is empty the scene.json
/// beside the snapshots. Throws Error where there is none.
std::filesystem::path scene_file_of(const std::string& snapshots, const std::string& given);

/// That scene, with the frame as the packing it starts from. Throws Error where the frame's grains are not of
/// its material.
dem::Scene scene_of_frame(const std::filesystem::path& scene_file, const std::string& snapshots,
                          const dem::FrameChoice& choice, const dem::State& state);

}  // namespace grainlaw::apps
