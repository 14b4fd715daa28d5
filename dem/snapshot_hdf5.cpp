#include "grainlaw/dem/snapshot_hdf5.hpp"

namespace grainlaw::dem::hdf5 {

namespace {

/// HDF5 keeps its state per process, and so must its lock.
std::mutex& library_mutex() {
  static std::mutex mutex;
  return mutex;
}

struct Reason {
  std::string innermost;
  bool disk_full = false;
};

herr_t collect(unsigned, const H5E_error2_t* entry, void* data) {
  auto& reason = *static_cast<Reason*>(data);
  const std::string text = entry->desc != nullptr ? entry->desc : "";
  if (reason.innermost.empty()) reason.innermost = text;
  if (text.find("No space left") != std::string::npos || text.find("quota exceeded") != std::string::npos ||
      text.find("File too large") != std::string::npos)
    reason.disk_full = true;
  return 0;
}

}  // namespace

Session::Session() : lock_(library_mutex()) {
  H5Eget_auto2(H5E_DEFAULT, &print_, &print_data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Session::~Session() { H5Eset_auto2(H5E_DEFAULT, print_, print_data_); }

void fail(const std::string& what) {
  Reason reason;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, collect, &reason);
  if (reason.disk_full) throw Failure(what + ": no space left on the disk");
  throw Failure(reason.innermost.empty() ? what : what + " (HDF5: " + reason.innermost + ")");
}

}  // namespace grainlaw::dem::hdf5
