// A lock that keeps two processes out of one folder. It vanishes with its process, however that ends: a file
// left behind by a killed one locks nothing.
#pragma once

#include <filesystem>

namespace grainlaw::calibrate {

class LockFile {
 public:
  /// Locks `file`, which is created; throws Error, naming `folder`, where another process holds it or it
  /// cannot be created.
  LockFile(std::filesystem::path file, const std::filesystem::path& folder);
  ~LockFile();
  LockFile(const LockFile&) = delete;
  LockFile& operator=(const LockFile&) = delete;

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

}  // namespace grainlaw::calibrate
