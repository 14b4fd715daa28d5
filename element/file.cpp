#include "grainlaw/element/file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

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

void write_file(const std::filesystem::path& file, const std::string& text) {
  std::filesystem::path aside = file;
  aside += ".part" + std::to_string(::getpid());
  const int descriptor = ::open(aside.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) throw Error::cannot_write(file.string(), std::strerror(errno));
  int failure = write_all(descriptor, text);
  if (::close(descriptor) != 0 && failure == 0) failure = errno;
  if (failure == 0 && ::rename(aside.c_str(), file.c_str()) != 0) failure = errno;
  if (failure != 0) {
    ::unlink(aside.c_str());
    throw Error::cannot_write(file.string(), std::strerror(failure));
  }
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

}  // namespace grainlaw
