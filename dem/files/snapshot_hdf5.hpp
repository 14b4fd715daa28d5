// What snapshot files need of the HDF5 C API: one lock around it, handles that close themselves, errors as
// exceptions. Private to dem; nothing here is part of the interface.
#pragma once

#include <hdf5.h>

#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>

namespace grainlaw::dem::hdf5 {

/// Holds the one lock around HDF5 and keeps the library from printing, for as long as it lives. The serial
/// HDF5 of Debian has global state and no lock of its own, so every call into it happens under a Session,
/// closing handles included: declare it before them.
class Session {
 public:
  Session();
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

 private:
  std::unique_lock<std::mutex> lock_;
  H5E_auto2_t print_ = nullptr;
  void* print_data_ = nullptr;
};

/// How often a header is read while another process may be writing it. The library's own choice, 100, waits
/// longer each time and so hangs for ever on a damaged file.
inline constexpr unsigned read_attempts = 3;

/// A failed call; what() is a clause in words without the file's name, which the caller adds.
class Failure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws Failure("<what> (HDF5: <innermost reason>)").
[[noreturn]] void fail(const std::string& what);

/// An identifier and its closing function.
template <herr_t (*close_function)(hid_t)>
class Handle {
 public:
  Handle(hid_t id, const std::string& what) : id_(id) {
    if (id_ < 0) fail(what);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~Handle() {
    if (id_ >= 0) close_function(id_);
  }
  operator hid_t() const { return id_; }
  /// Closes now, where a failure must not go unseen.
  void close(const std::string& what) {
    if (close_function(std::exchange(id_, -1)) < 0) fail(what);
  }

 private:
  hid_t id_;
};

using File = Handle<H5Fclose>;
using Group = Handle<H5Gclose>;
using Dataset = Handle<H5Dclose>;
using Space = Handle<H5Sclose>;
using Type = Handle<H5Tclose>;
using Attribute = Handle<H5Aclose>;
using Properties = Handle<H5Pclose>;

/// Throws Failure if `status` says that a call failed.
inline void check(herr_t status, const std::string& what) {
  if (status < 0) fail(what);
}

}  // namespace grainlaw::dem::hdf5
