#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <vector>

#include "grainlaw/dem/files/snapshot.hpp"
#include "grainlaw/dem/files/snapshot_hdf5.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/version.hpp"

namespace grainlaw::dem {

namespace {

using Shape = std::vector<hsize_t>;

/// A chunk is one frame of at most so many grains, with a checksum: an append never rewrites what is there
/// already, and damage to the numbers is found when they are read.
constexpr hsize_t largest_chunk = 16384;

void attach_text(hid_t object, const char* name, const std::vector<std::string>& texts) {
  std::size_t width = 1;
  for (const auto& text : texts) width = std::max(width, text.size());
  std::string padded;
  for (const auto& text : texts) padded += text + std::string(width - text.size(), '\0');
  const hdf5::Type type(H5Tcopy(H5T_C_S1), "making a text type");
  hdf5::check(H5Tset_size(type, width), "sizing a text type");
  hdf5::check(H5Tset_strpad(type, H5T_STR_NULLPAD), "padding a text type");
  const hsize_t count = texts.size();
  const hdf5::Space space(count == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &count, nullptr),
                          "making a shape");
  const hdf5::Attribute attribute(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT),
                                  std::string("attribute ") + name);
  hdf5::check(H5Awrite(attribute, type, padded.data()), std::string("attribute ") + name);
}

void attach_integers(hid_t object, const char* name, const std::vector<int>& values) {
  const hsize_t count = values.size();
  const hdf5::Space space(count == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &count, nullptr),
                          "making a shape");
  const hdf5::Attribute attribute(H5Acreate2(object, name, H5T_STD_I32LE, space, H5P_DEFAULT, H5P_DEFAULT),
                                  std::string("attribute ") + name);
  hdf5::check(H5Awrite(attribute, H5T_NATIVE_INT, values.data()), std::string("attribute ") + name);
}

/// Of an object that does not say when it was made: what is the same in two files has the same bytes.
hdf5::Properties timeless(hid_t kind) {
  hdf5::Properties properties(H5Pcreate(kind), "making properties");
  hdf5::check(H5Pset_obj_track_times(properties, false), "leaving out times");
  return properties;
}

hdf5::Group create_group(hid_t parent, const char* name) {
  return {H5Gcreate2(parent, name, H5P_DEFAULT, timeless(H5P_GROUP_CREATE), H5P_DEFAULT),
          std::string("group ") + name};
}

/// A dataset of this shape; where `frames` is true, of none yet and any number of frames of this shape.
hdf5::Dataset create_dataset(hid_t parent, const char* name, hid_t type, Shape shape, bool frames) {
  Shape most = shape, chunk = shape;
  for (auto& size : chunk) size = std::min(size, largest_chunk);
  if (frames) {
    shape.insert(shape.begin(), 0);
    most.insert(most.begin(), H5S_UNLIMITED);
    chunk.insert(chunk.begin(), 1);
  }
  const int rank = static_cast<int>(shape.size());
  const hdf5::Space space(H5Screate_simple(rank, shape.data(), most.data()), "making a shape");
  const hdf5::Properties layout = timeless(H5P_DATASET_CREATE);
  hdf5::check(H5Pset_chunk(layout, rank, chunk.data()), "setting chunks");
  hdf5::check(H5Pset_fletcher32(layout), "setting checksums");
  return {H5Dcreate2(parent, name, type, space, H5P_DEFAULT, layout, H5P_DEFAULT),
          std::string("dataset ") + name};
}

/// Format of HDF5 1.10: it has checksums in every header and can be appended to in an order that keeps it
/// readable throughout.
hdf5::Properties file_access() {
  hdf5::Properties access(H5Pcreate(H5P_FILE_ACCESS), "making file properties");
  hdf5::check(H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_V110), "choosing the format");
  hdf5::check(H5Pset_metadata_read_attempts(access, hdf5::read_attempts), "setting read attempts");
  return access;
}

/// Room that headers and indices of one more frame may take beside its numbers.
constexpr std::size_t header_room = 128 * 1024;

/// Makes sure that `bytes` more fit into the file, and keeps the room. HDF5 1.10 does not survive a full
/// disk: it leaves a file that cannot be read and crashes when it closes, so it must never meet one. What is
/// left of the room goes back when HDF5 closes the file.
void reserve(const std::filesystem::path& file, std::size_t bytes) {
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  struct stat status {};
  int failure = descriptor < 0 || ::fstat(descriptor, &status) != 0 ? errno : 0;
  if (failure == 0) {
    do failure = ::posix_fallocate(descriptor, status.st_size, static_cast<off_t>(bytes));
    while (failure == EINTR);
    if (failure == EOPNOTSUPP || failure == EINVAL) failure = 0;  // a file system that cannot say
    if (failure != 0 && ::ftruncate(descriptor, status.st_size) != 0) failure = errno;
  }
  if (descriptor >= 0) ::close(descriptor);
  if (failure != 0) throw Error::cannot_write(file.string(), std::strerror(failure));
}

void write_header(hid_t file) {
  const auto h5md = create_group(file, "h5md");
  attach_integers(h5md, "version", {1, 1});
  attach_text(create_group(h5md, "author"), "name", {"not stated"});
  const auto creator = create_group(h5md, "creator");
  attach_text(creator, "name", {"grainlaw"});
  attach_text(creator, "version", {version() + " (" + commit() + ")"});
  const auto modules = create_group(h5md, "modules");
  attach_integers(create_group(modules, "units"), "version", {1, 0});
}

/// A time-dependent element. All elements share one `step` and one `time`, those of the box.
hdf5::Dataset create_element(const hdf5::Group& element, const hdf5::Group& edges, hid_t type, Shape shape) {
  for (const char* name : {"step", "time"})
    hdf5::check(H5Lcreate_hard(edges, name, element, name, H5P_DEFAULT, H5P_DEFAULT), "linking time");
  return create_dataset(element, "value", type, std::move(shape), true);
}

hdf5::Group write_box(const hdf5::Group& grains) {
  const auto box = create_group(grains, "box");
  attach_integers(box, "dimension", {3});
  attach_text(box, "boundary", {"periodic", "periodic", "periodic"});
  auto edges = create_group(box, "edges");
  create_dataset(edges, "step", H5T_STD_U64LE, {}, true);
  attach_text(create_dataset(edges, "time", H5T_IEEE_F64LE, {}, true), "unit", {"us"});
  attach_text(create_dataset(edges, "value", H5T_IEEE_F64LE, {3, 3}, true), "unit", {"mm"});
  return edges;
}

void write_particles(hid_t file, const hdf5::Group& grains, const hdf5::Group& edges,
                     const std::vector<double>& radius) {
  const hsize_t count = radius.size();
  attach_text(create_element(create_group(grains, "position"), edges, H5T_IEEE_F64LE, {count, 3}), "unit",
              {"mm"});
  const auto velocity = create_group(grains, "velocity");
  attach_text(velocity, "meaning", {"fluctuation velocity: without the affine motion of the box"});
  attach_text(create_element(velocity, edges, H5T_IEEE_F64LE, {count, 3}), "unit", {"mm us-1"});
  const auto radii = create_dataset(grains, "radius", H5T_IEEE_F64LE, {count}, false);
  attach_text(radii, "unit", {"mm"});
  hdf5::check(H5Dwrite(radii, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, radius.data()), "radius");
  const auto observables = create_group(file, "observables");
  for (const char* name : {"nu", "eps_vol", "eps_dev"})
    create_element(create_group(observables, name), edges, H5T_IEEE_F64LE, {});
  create_element(create_group(observables, "segment"), edges, H5T_STD_U64LE, {});
}

/// Writes frame `index` of a dataset, which grows to hold it.
void write_frame(hid_t file, const std::string& name, hsize_t index, hid_t type, const void* data) {
  const std::string what = "" + name;
  hdf5::Dataset dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), what);
  const hdf5::Space old(H5Dget_space(dataset), what);
  Shape shape(static_cast<std::size_t>(H5Sget_simple_extent_ndims(old)));
  hdf5::check(H5Sget_simple_extent_dims(old, shape.data(), nullptr), what);
  Shape from(shape.size(), 0), size = shape;
  from[0] = index;
  size[0] = 1;
  shape[0] = index + 1;
  hdf5::check(H5Dset_extent(dataset, shape.data()), what);
  const hdf5::Space target(H5Dget_space(dataset), what);
  hdf5::check(H5Sselect_hyperslab(target, H5S_SELECT_SET, from.data(), nullptr, size.data(), nullptr), what);
  const hdf5::Space source(H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr), what);
  hdf5::check(H5Dwrite(dataset, type, source, target, H5P_DEFAULT, data), what);
  hdf5::check(H5Dflush(dataset), what);
  dataset.close(what);
}

void check_finite(const std::string& file, const std::vector<std::array<double, 3>>& vectors,
                  const std::string& name) {
  for (std::size_t i = 0; i < vectors.size(); ++i)
    for (const double x : vectors[i])
      if (!std::isfinite(x))
        throw Error(file, name, "grain " + std::to_string(i) + " has a value that is not a number");
}

}  // namespace

SnapshotWriter::SnapshotWriter(std::filesystem::path file, std::vector<double> radius)
    : file_(std::move(file)), radius_(std::move(radius)) {
  if (radius_.empty()) throw Error(file_.string(), "", "cannot hold a packing without grains");
  std::error_code ignored;
  if (std::filesystem::exists(file_, ignored))
    throw Error(file_.string(), "", "is there already and is not overwritten");
  try {
    reserve(file_, radius_.size() * sizeof(double) + header_room);
  } catch (const Error&) {
    std::filesystem::remove(file_, ignored);
    throw;
  }
  const hdf5::Session session;
  try {
    hdf5::File out(H5Fcreate(file_.c_str(), H5F_ACC_TRUNC, timeless(H5P_FILE_CREATE), file_access()),
                   "creating it");
    write_header(out);
    {
      const auto grains = create_group(create_group(out, "particles"), "grains");
      const auto edges = write_box(grains);
      write_particles(out, grains, edges, radius_);
    }
    hdf5::check(H5Fflush(out, H5F_SCOPE_GLOBAL), "flushing it");
    out.close("closing it");
  } catch (const hdf5::Failure& failure) {
    std::filesystem::remove(file_, ignored);
    throw Error::cannot_write(file_.string(), failure.what());
  }
}

void SnapshotWriter::append(const State& state, const Observables& observables) {
  const std::string name = file_.string();
  if (state.radius != radius_ || state.position.size() != radius_.size() ||
      state.velocity.size() != radius_.size())
    throw Error(name, "", "a frame must hold the same grains as the file");
  check_finite(name, {state.box.row(0), state.box.row(1), state.box.row(2)}, "box");
  check_finite(name, state.position, "position");
  check_finite(name, state.velocity, "velocity");
  check_finite(name, {{observables.nu, observables.eps_vol, observables.eps_dev}}, "observables");
  const Mat3 edges = transposed(state.box);  // H5MD: edge vectors in the rows
  const hdf5::Session session;
  reserve(file_, radius_.size() * 6 * sizeof(double) + header_room);
  try {
    hdf5::File out(H5Fopen(file_.c_str(), H5F_ACC_RDWR | H5F_ACC_SWMR_WRITE, file_access()), "opening it");
    const auto write = [&](const std::string& dataset, hid_t type, const void* data) {
      write_frame(out, dataset, frames_, type, data);
    };
    const std::string grains = "/particles/grains/";
    write(grains + "position/value", H5T_NATIVE_DOUBLE, state.position.data());
    write(grains + "velocity/value", H5T_NATIVE_DOUBLE, state.velocity.data());
    write(grains + "box/edges/value", H5T_NATIVE_DOUBLE, edges.data());
    write("/observables/nu/value", H5T_NATIVE_DOUBLE, &observables.nu);
    write("/observables/eps_vol/value", H5T_NATIVE_DOUBLE, &observables.eps_vol);
    write("/observables/eps_dev/value", H5T_NATIVE_DOUBLE, &observables.eps_dev);
    write("/observables/segment/value", H5T_NATIVE_UINT64, &observables.segment);
    write(grains + "box/edges/time", H5T_NATIVE_DOUBLE, &state.time_us);
    // Last, and each dataset is flushed as it is written: a frame counts once its step is there.
    write(grains + "box/edges/step", H5T_NATIVE_UINT64, &state.step);
    out.close("closing it");
  } catch (const hdf5::Failure& failure) {
    throw Error::cannot_write(name, failure.what());
  }
  ++frames_;
}

}  // namespace grainlaw::dem
