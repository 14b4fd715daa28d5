#include "grainlaw/element/file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>
#include <vector>

#include "grainlaw/element/error.hpp"

namespace grainlaw {

namespace {

/// Writes all of text to the open descriptor; returns errno, 0 if well.
int write_all(int descriptor, const std::string& text) {
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t n = ::write(descriptor, text.data() + done, text.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return errno;
    done += static_cast<std::size_t>(n);
  }
  return ::fsync(descriptor) == 0 || errno == EINVAL || errno == EROFS ? 0 : errno;
}

}  // namespace

namespace {

/// Where a chain of symbolic links ends: the file to replace, not the link.
std::filesystem::path end_of_links(std::filesystem::path file) {
  std::error_code code;
  for (int links = 0; links < 40 && std::filesystem::is_symlink(file, code); ++links) {
    const std::filesystem::path target = std::filesystem::read_symlink(file, code);
    if (code) break;
    file = file.parent_path() / target;
  }
  return file;
}

/// Opens, writes and closes; returns errno, 0 if well.
int write_to(const std::filesystem::path& file, int flags, const std::string& text) {
  const int descriptor = ::open(file.c_str(), flags | O_WRONLY | O_CLOEXEC, 0666);
  if (descriptor < 0) return errno;
  const int failure = write_all(descriptor, text);
  return ::close(descriptor) != 0 && failure == 0 ? errno : failure;
}

int replace(const std::filesystem::path& file, const std::string& text) {
  std::filesystem::path aside = file;
  aside += ".part" + std::to_string(::getpid());
  int failure = write_to(aside, O_CREAT | O_TRUNC, text);
  if (failure == 0 && ::rename(aside.c_str(), file.c_str()) != 0) failure = errno;
  if (failure != 0) ::unlink(aside.c_str());
  return failure;
}

}  // namespace

void write_file(const std::filesystem::path& file, const std::string& text) {
  const std::filesystem::path end = end_of_links(file);
  std::error_code code;
  const bool device = std::filesystem::exists(end, code) && !std::filesystem::is_regular_file(end, code) &&
                      !std::filesystem::is_directory(end, code);
  const int failure = device ? write_to(end, 0, text) : replace(end, text);
  if (failure != 0) throw Error::cannot_write(file.string(), std::strerror(failure));
}

void remove_half_written(const std::filesystem::path& dir) {
  std::vector<std::filesystem::path> half_written;
  for (const auto& entry : std::filesystem::directory_iterator(dir)) {
    const std::string kind = entry.path().extension().string();
    const bool numbered = kind.starts_with(".part") && kind.size() > 5 &&
                          kind.find_first_not_of("0123456789", 5) == std::string::npos;
    if (numbered && entry.is_regular_file()) half_written.push_back(entry.path());
  }
  for (const auto& file : half_written) std::filesystem::remove(file);
}

std::string read_file(const std::filesystem::path& file) {
  std::error_code code;
  if (!std::filesystem::exists(file, code)) throw Error(file.string(), "", "no such file");
  if (std::filesystem::is_directory(file, code)) throw Error(file.string(), "", "is a directory, not a file");
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  if (stream && stream.peek() != std::ifstream::traits_type::eof()) text << stream.rdbuf();
  if (!stream.eof() && stream.fail())
    throw Error(file.string(), "", std::string("cannot be read: ") + std::strerror(errno));
  return text.str();
}

std::string digest(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a
  for (const unsigned char c : text) hash = (hash ^ c) * 0x100000001b3u;
  char hex[17];
  std::snprintf(hex, sizeof hex, "%016llx", static_cast<unsigned long long>(hash));
  return hex;
}

}  // namespace grainlaw
