#include "grainlaw/calibrate/lock_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string>

#include "grainlaw/element/error.hpp"

namespace grainlaw::calibrate {

namespace {

/// The process number that the holder wrote, for the message; empty if it has not yet.
std::string holder(int descriptor) {
  std::array<char, 32> text{};
  const ssize_t n = ::pread(descriptor, text.data(), text.size() - 1, 0);
  const std::string number(text.data(), n > 0 ? static_cast<std::size_t>(n) : 0);
  return number.empty() ? "" : " (process " + number + ")";
}

/// Whether the locked file is still the one under its name: its last holder removes it when it ends.
bool still_there(int descriptor, const std::filesystem::path& file) {
  struct stat locked {
  }, named{};
  return ::fstat(descriptor, &locked) == 0 && ::stat(file.c_str(), &named) == 0 &&
         locked.st_ino == named.st_ino && locked.st_dev == named.st_dev;
}

}  // namespace

LockFile::LockFile(std::filesystem::path file, const std::filesystem::path& folder) : file_(std::move(file)) {
  for (;;) {
    const int descriptor = ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor < 0)
      throw Error(folder.string(), "", std::string("cannot be written: ") + std::strerror(errno));
    if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
      const int reason = errno;
      const std::string who = holder(descriptor);
      ::close(descriptor);
      if (reason == EINTR) continue;
      if (reason == EWOULDBLOCK) throw Error(folder.string(), "", "is in use by another grainlaw" + who);
      throw Error(folder.string(), "", std::string("cannot be locked: ") + std::strerror(reason));
    }
    if (still_there(descriptor, file_)) {
      descriptor_ = descriptor;
      break;
    }
    ::close(descriptor);
  }
  const std::string number = std::to_string(::getpid());
  // Only for the message to others; a lock without it holds as well.
  if (::ftruncate(descriptor_, 0) != 0 || ::pwrite(descriptor_, number.data(), number.size(), 0) < 0) return;
}

LockFile::~LockFile() {
  ::unlink(file_.c_str());
  ::close(descriptor_);
}

}  // namespace grainlaw::calibrate
