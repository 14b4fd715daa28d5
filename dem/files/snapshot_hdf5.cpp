#include "grainlaw/dem/files/snapshot_hdf5.hpp"

namespace grainlaw::dem::hdf5 {

namespace {

/// HDF5 keeps its state per process, and so must its lock.
std::mutex& library_mutex() {
  static std::mutex mutex;
  return mutex;
}

/// Takes the first description, which is that of the innermost function.
herr_t keep_first(unsigned, const H5E_error2_t* entry, void* data) {
  auto& innermost = *static_cast<std::string*>(data);
  if (innermost.empty() && entry->desc != nullptr) innermost = entry->desc;
  return 0;
}

}  // namespace

Session::Session() : lock_(library_mutex()) {
  // HDF5 1.10 loses a piece of memory where it meets a damaged header, and complains on stderr about it when
  // it cleans up at the end of the program. We leave nothing open that would need cleaning.
  [[maybe_unused]] static const herr_t no_cleaning = H5dont_atexit();
  H5Eget_auto2(H5E_DEFAULT, &print_, &print_data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Session::~Session() { H5Eset_auto2(H5E_DEFAULT, print_, print_data_); }

void fail(const std::string& what) {
  std::string innermost;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_first, &innermost);
  throw Failure(innermost.empty() ? what : what + " (HDF5: " + innermost + ")");
}

}  // namespace grainlaw::dem::hdf5
