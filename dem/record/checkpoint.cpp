#include "grainlaw/dem/record/checkpoint.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <optional>
#include <utility>

#include "grainlaw/dem/numbers/simd.hpp"
#include "grainlaw/dem/scene/provenance.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/file.hpp"
#include "grainlaw/element/json.hpp"
#include "grainlaw/element/json_difference.hpp"
#include "grainlaw/element/version.hpp"

namespace grainlaw::dem {

namespace fs = std::filesystem;

namespace {

constexpr auto format = "grainlaw-checkpoint-1";
constexpr auto aside_file = "checkpoint.bin.part";

/// The first line of a checkpoint, as this program writes it for `scene`.
Json header(const Scene& scene, const fs::path& dir) {
  return {{"format", format},
          {"version", version()},
          {"commit", commit()},
          {"compiler", compiler_name()},
          {"build", build_options()},
          {"simd", simd_target()},
          {"scene", digest(scene.to_json(dir).dump())}};
}

/// So that a renamed file is found again after the machine lost its power.
void flush_directory(const fs::path& dir) {
  const int descriptor = ::open(dir.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

void rename_or_throw(const fs::path& from, const fs::path& to) {
  if (std::rename(from.c_str(), to.c_str()) != 0)
    throw Error::cannot_write(to.string(), std::strerror(errno));
}

std::string start_anew(const fs::path& dir) { return "remove " + dir.string() + " to start the test anew"; }

/// What a test must have in common with its checkpoint; `got` and `want` are header lines.
void compare(const fs::path& file, const Json& got, const Json& want, const Scene& scene) {
  const auto differs = [&](const char* key) { return !got.contains(key) || got.at(key) != want.at(key); };
  const auto text = [](const Json& line, const char* key) {
    return line.contains(key) && line.at(key).is_string() ? line.at(key).get<std::string>() : "unknown";
  };
  const fs::path dir = file.parent_path();
  if (differs("format"))
    throw Error(file.string(), "format",
                "must be " + text(want, "format") + ", got " + text(got, "format") +
                    "; go on with a grainlaw " + text(got, "version") + ", or " + start_anew(dir));
  if (differs("scene")) {
    std::string difference;
    if (fs::exists(dir / "scene.json"))
      difference = first_difference(load_json(dir / "scene.json"), scene.to_json(dir));
    throw Error(file.string(), "scene",
                "is of another scene than " + scene.file +
                    (difference.empty() ? "" : " (" + difference + ")") + "; go on with that scene, or " +
                    start_anew(dir));
  }
  for (const char* key : {"version", "commit", "compiler", "build"})
    if (differs(key))
      throw Error(file.string(), key,
                  "was written by grainlaw with " + std::string(key) + " " + text(got, key) +
                      ", this one has " + text(want, key) +
                      ": it may not go on with the same numbers; go on with the former, or " +
                      start_anew(dir));
  if (differs("simd"))
    throw Error(file.string(), "simd",
                "the test ran on " + text(got, "simd") + ", this run is on " + text(want, "simd") +
                    ": its numbers would differ in the last digits; go on with --simd " + text(got, "simd") +
                    ", or " + start_anew(dir));
}

Json read_header(ArchiveReader& archive) { return parse_json(archive.line(), archive.path().string()); }

/// A file that is as it was written; none where it is not, and then `why` says so.
std::optional<ArchiveReader> open_whole(const fs::path& file, std::string& why) {
  if (!fs::exists(file)) return {};
  try {
    return ArchiveReader(file);
  } catch (const Error& error) {
    if (why.empty()) why = error.what();
    return {};
  }
}

}  // namespace

bool has_checkpoint(const fs::path& dir) {
  return fs::exists(dir / checkpoint_file) || fs::exists(dir / earlier_checkpoint_file);
}

void write_checkpoint(const fs::path& dir, const Scene& scene,
                      const std::function<void(ArchiveWriter&)>& keep) {
  const fs::path aside = dir / aside_file, newest = dir / checkpoint_file;
  try {
    ArchiveWriter archive(aside);
    archive.line(header(scene, dir).dump());
    keep(archive);
    archive.finish();
  } catch (...) {
    std::error_code ignored;
    fs::remove(aside, ignored);
    throw;
  }
  if (fs::exists(newest)) rename_or_throw(newest, dir / earlier_checkpoint_file);
  rename_or_throw(aside, newest);
  flush_directory(dir);
}

ArchiveReader read_checkpoint(const fs::path& dir, const Scene& scene) {
  std::string why;
  auto archive = open_whole(dir / checkpoint_file, why);
  if (!archive) archive = open_whole(dir / earlier_checkpoint_file, why);
  if (!archive)
    throw Error((why.empty() ? (dir / checkpoint_file).string() + ": no such file" : why) + "; " +
                start_anew(dir));
  compare(archive->path(), read_header(*archive), header(scene, dir), scene);
  return std::move(*archive);
}

void check_checkpoint(const fs::path& dir, const Scene& scene) { read_checkpoint(dir, scene); }

void remove_checkpoints(const fs::path& dir) {
  for (const char* file : {checkpoint_file, earlier_checkpoint_file, aside_file}) fs::remove(dir / file);
}

}  // namespace grainlaw::dem
