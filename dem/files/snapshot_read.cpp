#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "grainlaw/dem/files/snapshot.hpp"
#include "grainlaw/dem/files/snapshot_hdf5.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::dem {

namespace {

using Shape = std::vector<hsize_t>;
using hdf5::Failure;

const std::string grains = "/particles/grains/";
constexpr hsize_t most_grains = 10'000'000;

std::string shown(const Shape& shape) {
  std::string text;
  for (const auto size : shape) text += (text.empty() ? "" : ", ") + std::to_string(size);
  return "[" + text + "]";
}

/// Opens a file that was closed, or else one whose writer died or is at work in it: that one is marked as
/// being written, and its frames are complete up to the last step.
hdf5::File open_file(const std::filesystem::path& file) {
  const hdf5::Properties access(H5Pcreate(H5P_FILE_ACCESS), "cannot make file properties");
  hdf5::check(H5Pset_metadata_read_attempts(access, hdf5::read_attempts), "cannot set read attempts");
  const std::string what = "is not a snapshot file, or is cut short or damaged";
  try {
    return {H5Fopen(file.c_str(), H5F_ACC_RDONLY, access), what};
  } catch (const Failure& failure) {
    const hid_t id = H5Fopen(file.c_str(), H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, access);
    if (id < 0) throw failure;
    return {id, what};
  }
}

hdf5::Dataset open_dataset(hid_t file, const std::string& name) {
  return {H5Dopen2(file, name.c_str(), H5P_DEFAULT), "dataset " + name + " is missing or damaged"};
}

struct Source {
  hdf5::File file;
  hsize_t bytes;  ///< of the file on disk
  hsize_t frames;
  hsize_t count;  ///< grains
};

/// A dataset of this kind of number and this shape. In a series the first size is the number of frames, and
/// it may be larger.
class Series {
 public:
  Series(const Source& source, const std::string& name, H5T_class_t kind, const Shape& shape, bool frames)
      : name_(name),
        dataset_(open_dataset(source.file, name)),
        bytes_(source.bytes),
        shape_(shape_of(dataset_, name)) {
    const hdf5::Type type(H5Dget_type(dataset_), "cannot read " + name);
    if (H5Tget_class(type) != kind)
      throw Failure(name + ": must hold " + (kind == H5T_FLOAT ? "real" : "whole") + " numbers");
    Shape got = shape_;
    if (frames && !got.empty() && got[0] > shape[0]) got[0] = shape[0];
    if (got != shape) throw Failure(name + ": must have shape " + shown(shape) + ", got " + shown(shape_));
  }

  static Shape shape_of(const hdf5::Dataset& dataset, const std::string& name) {
    const hdf5::Space space(H5Dget_space(dataset), "cannot read " + name);
    const int rank = H5Sget_simple_extent_ndims(space);
    if (rank < 0) hdf5::fail("cannot read " + name);
    Shape shape(static_cast<std::size_t>(rank));
    hdf5::check(H5Sget_simple_extent_dims(space, shape.data(), nullptr), "cannot read " + name);
    return shape;
  }

  /// Reads `size` numbers from `from` on.
  template <typename Number>
  void read(const Shape& from, const Shape& size, hid_t type, Number* into) const {
    check_stored(from, size);
    const std::string what = "cannot read " + name_;
    const hdf5::Space where(H5Dget_space(dataset_), what);
    hdf5::check(H5Sselect_hyperslab(where, H5S_SELECT_SET, from.data(), nullptr, size.data(), nullptr), what);
    const hdf5::Space target(H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr), what);
    hdf5::check(H5Dread(dataset_, type, target, where, H5P_DEFAULT, into), what);
  }

 private:
  /// HDF5 reads zeros, without a word, beyond the end of a file that its writer did not close, and where
  /// nothing was written.
  void check_stored(const Shape& from, const Shape& size) const {
    const hdf5::Properties layout(H5Dget_create_plist(dataset_), "cannot read " + name_);
    if (H5Pget_layout(layout) != H5D_CHUNKED) {
      const haddr_t at = H5Dget_offset(dataset_);
      if (H5Pget_layout(layout) == H5D_CONTIGUOUS &&
          (at == HADDR_UNDEF || at + H5Dget_storage_size(dataset_) > bytes_))
        throw Failure(name_ + ": the file ends before these numbers");
      return;
    }
    Shape chunk(from.size());
    hdf5::check(H5Pget_chunk(layout, static_cast<int>(chunk.size()), chunk.data()), "cannot read " + name_);
    Shape at = from;
    for (std::size_t i = 0; i < at.size(); ++i) at[i] -= at[i] % chunk[i];
    const Shape first = at;
    for (std::size_t i = 0; i < at.size();) {
      check_chunk(at);
      for (i = 0; i < at.size() && (at[i] += chunk[i]) >= from[i] + size[i]; ++i) at[i] = first[i];
    }
  }

  void check_chunk(const Shape& at) const {
    unsigned skipped_filters = 0;
    haddr_t address = HADDR_UNDEF;
    hsize_t bytes = 0;
    hdf5::check(H5Dget_chunk_info_by_coord(dataset_, at.data(), &skipped_filters, &address, &bytes),
                "cannot read " + name_);
    if (address == HADDR_UNDEF || bytes == 0 || address > bytes_ || bytes > bytes_ - address)
      throw Failure(name_ + ": the file ends before these numbers");
  }

  std::string name_;
  hdf5::Dataset dataset_;
  hsize_t bytes_;
  Shape shape_;
};

Source open_source(const std::filesystem::path& file) {
  Source source{open_file(file), std::filesystem::file_size(file), 0, 0};
  const auto length_of = [&](const std::string& name) {
    const hdf5::Dataset dataset = open_dataset(source.file, name);
    const Shape shape = Series::shape_of(dataset, name);
    if (shape.size() != 1)
      throw Failure(name + ": must have one dimension, got " + std::to_string(shape.size()));
    return shape[0];
  };
  source.frames = length_of(grains + "box/edges/step");
  source.count = length_of(grains + "radius");
  if (source.frames == 0) throw Failure("has no frame");
  if (source.frames > source.bytes / sizeof(double)) throw Failure("has more frames than fit into the file");
  if (source.count == 0 || source.count > most_grains)
    throw Failure(grains + "radius: must have 1 to " + std::to_string(most_grains) + " grains, got " +
                  std::to_string(source.count));
  return source;
}

std::vector<double> read_numbers(const Source& source, const std::string& name) {
  std::vector<double> values(source.frames);
  Series(source, name, H5T_FLOAT, {source.frames}, true)
      .read({0}, {source.frames}, H5T_NATIVE_DOUBLE, values.data());
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i]))
      throw Failure(name + ": frame " + std::to_string(i) + " has a value that is not a number");
  return values;
}

std::vector<std::uint64_t> read_integers(const Source& source, const std::string& name) {
  std::vector<std::uint64_t> values(source.frames);
  Series(source, name, H5T_INTEGER, {source.frames}, true)
      .read({0}, {source.frames}, H5T_NATIVE_UINT64, values.data());
  return values;
}

std::vector<Observables> read_observables(const Source& source) {
  const auto nu = read_numbers(source, "/observables/nu/value");
  const auto eps_vol = read_numbers(source, "/observables/eps_vol/value");
  const auto eps_dev = read_numbers(source, "/observables/eps_dev/value");
  const auto segment = read_integers(source, "/observables/segment/value");
  std::vector<Observables> all(nu.size());
  for (std::size_t i = 0; i < nu.size(); ++i) all[i] = {nu[i], eps_vol[i], eps_dev[i], segment[i]};
  return all;
}

std::vector<std::array<double, 3>> read_vectors(const Source& source, const std::string& name,
                                                hsize_t frame) {
  std::vector<std::array<double, 3>> values(source.count);
  Series(source, name, H5T_FLOAT, {source.frames, source.count, 3}, true)
      .read({frame, 0, 0}, {1, source.count, 3}, H5T_NATIVE_DOUBLE, values.data()->data());
  for (std::size_t i = 0; i < values.size(); ++i)
    for (const double x : values[i])
      if (!std::isfinite(x))
        throw Failure(name + ": grain " + std::to_string(i) + " of frame " + std::to_string(frame) +
                      " has a value that is not a number");
  return values;
}

std::vector<double> read_radius(const Source& source) {
  const std::string name = grains + "radius";
  std::vector<double> radius(source.count);
  Series(source, name, H5T_FLOAT, {source.count}, false)
      .read({0}, {source.count}, H5T_NATIVE_DOUBLE, radius.data());
  for (std::size_t i = 0; i < radius.size(); ++i)
    if (!(radius[i] > 0 && std::isfinite(radius[i])))
      throw Failure(name + ": must be > 0, got " + to_text(radius[i]) + " for grain " + std::to_string(i));
  return radius;
}

/// The edges of the box, in columns; H5MD has them in rows.
Mat3 read_box(const Source& source, hsize_t frame) {
  const std::string name = grains + "box/edges/value";
  std::array<double, 9> e{};
  Series(source, name, H5T_FLOAT, {source.frames, 3, 3}, true)
      .read({frame, 0, 0}, {1, 3, 3}, H5T_NATIVE_DOUBLE, e.data());
  const Mat3 box{{e[0], e[3], e[6]}, {e[1], e[4], e[7]}, {e[2], e[5], e[8]}};
  for (std::size_t c = 0; c < 3; ++c)
    if (box.is_diagonal() && !(box(c, c) > 0 && std::isfinite(box(c, c))))
      throw Failure(name + ": edges of the box must be > 0, got " + to_text(box(c, c)));
  if (!(determinant(box) > 0 && std::isfinite(determinant(box))))
    throw Failure(name + ": edges of the box must span a right-handed parallelepiped, got a volume of " +
                  to_text(determinant(box)));
  return box;
}

Frame read_checked(const Source& source, const std::vector<Observables>& all, std::size_t index) {
  Frame frame;
  frame.index = index;
  frame.observables = all[index];
  State& state = frame.state;
  state.box = read_box(source, index);
  state.time_us = read_numbers(source, grains + "box/edges/time")[index];
  state.step = read_integers(source, grains + "box/edges/step")[index];
  state.radius = read_radius(source);
  state.position = read_vectors(source, grains + "position/value", index);
  state.velocity = read_vectors(source, grains + "velocity/value", index);
  const double nu = state.volume_fraction();
  if (!(std::abs(nu - frame.observables.nu) <= 1e-6 * nu))
    throw Failure("frame " + std::to_string(index) + ": nu is stored as " + to_text(frame.observables.nu) +
                  ", but grains and box give " + to_text(nu));
  return frame;
}

/// Runs `read` under the lock; whatever fails becomes an Error that names the file.
template <typename Read>
auto with_source(const std::filesystem::path& file, Read&& read) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) throw Error(file.string(), "", "no such file");
  if (!std::filesystem::is_regular_file(file, ignored)) throw Error(file.string(), "", "is not a file");
  const hdf5::Session session;
  try {
    return read(open_source(file));
  } catch (const Failure& failure) {
    throw Error(file.string(), "", failure.what());
  }
}

}  // namespace

std::vector<Observables> list_frames(const std::filesystem::path& file) {
  return with_source(file, [](const Source& source) { return read_observables(source); });
}

Frame read_whole_frame(const std::filesystem::path& file, const FrameChoice& choice) {
  return with_source(file, [&](const Source& source) {
    const auto all = read_observables(source);
    return read_checked(source, all, find_frame(all, choice, file));
  });
}

State read_frame(const std::filesystem::path& file, const FrameChoice& choice) {
  return read_whole_frame(file, choice).state;
}

}  // namespace grainlaw::dem
