// Snapshot files: what is written comes back digit for digit, the layout is H5MD, and a damaged file never
// passes for a whole one.
#include "grainlaw/dem/files/snapshot.hpp"

#include <gtest/gtest.h>
#include <hdf5.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <fstream>
#include <iterator>
#include <numbers>
#include <random>
#include <thread>

#include "grainlaw/element/error.hpp"

/// HDF5 1.10 loses a piece of memory wherever it meets a damaged header: not ours to mend, nor for
/// LeakSanitizer to report.
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5\n"; }

namespace grainlaw::dem {
namespace {

namespace fs = std::filesystem;

/// A folder of its own for each test.
class SnapshotTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    dir_ = fs::temp_directory_path() /
           ("grainlaw-snapshot-" + std::string(info->name()) + "-" + std::to_string(getpid()));
    fs::remove_all(dir_);
    fs::create_directories(dir_);
  }
  void TearDown() override { fs::remove_all(dir_); }
  fs::path file(const std::string& name = "snapshots.h5") const { return dir_ / name; }

 private:
  fs::path dir_;
};

/// Grains at random: what the numbers mean plays no part here.
State random_state(std::size_t count, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::mt19937_64 sizes(7);  // radii are the same in every frame
  State state;
  state.box = Mat3::diagonal({4 + unit(random), 5 + unit(random), 6 + unit(random)});
  state.time_us = 1000 * unit(random);
  state.step = random() >> 8;
  for (std::size_t i = 0; i < count; ++i) {
    state.position.push_back({7 * unit(random) - 1, unit(random), unit(random)});
    state.velocity.push_back({1e-3 * (unit(random) - 0.5), -unit(random), 0});
    state.radius.push_back(0.5 + unit(sizes));
  }
  return state;
}

Observables observables_of(const State& state, std::uint64_t segment = 0) {
  return {state.volume_fraction(), -0.25, 1.0 / 3.0, segment};
}

/// Writes `frames` frames of `count` grains; frame i is random_state(count, i), in segment i / 2.
void write_frames(const fs::path& file, std::size_t count, unsigned frames) {
  SnapshotWriter writer(file, random_state(count, 0).radius);
  for (unsigned i = 0; i < frames; ++i) {
    const State state = random_state(count, i);
    writer.append(state, observables_of(state, i / 2));
  }
}

std::string bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void write_bytes(const fs::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes;
}

/// The message of the Error that reading gives, without the leading name of the file; "" if there is none.
std::string error_of(const fs::path& file, const FrameChoice& choice = {}) {
  try {
    read_frame(file, choice);
  } catch (const Error& error) {
    const std::string text = error.what(), start = file.string() + ": ";
    EXPECT_EQ(text.substr(0, start.size()), start) << text;
    EXPECT_EQ(error.file(), file.string());
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    return text.substr(std::min(start.size(), text.size()));
  }
  return "";
}

/// Opens a dataset of a file to spoil it.
template <typename Change>
void with_dataset(const fs::path& file, const std::string& name, Change&& change) {
  const hid_t id = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  ASSERT_GE(id, 0);
  const hid_t dataset = H5Dopen2(id, name.c_str(), H5P_DEFAULT);
  ASSERT_GE(dataset, 0);
  change(dataset);
  H5Dclose(dataset);
  H5Fclose(id);
}

void overwrite(const fs::path& file, const std::string& name, std::vector<double> values) {
  with_dataset(file, name, [&](hid_t dataset) {
    ASSERT_GE(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
  });
}

/// Puts a dataset of zeros and of another shape or type in the place of `name`.
void replace(const fs::path& file, const std::string& name, const std::vector<hsize_t>& shape, hid_t type) {
  const hid_t id = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  ASSERT_GE(id, 0);
  ASSERT_GE(H5Ldelete(id, name.c_str(), H5P_DEFAULT), 0);
  const hid_t space = H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr);
  const hid_t dataset = H5Dcreate2(id, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  ASSERT_GE(dataset, 0);
  const std::vector<double> zeros(100000, 0.0);
  ASSERT_GE(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, zeros.data()), 0);
  H5Dclose(dataset);
  H5Sclose(space);
  H5Fclose(id);
}

TEST_F(SnapshotTest, FramesComeBackDigitForDigit) {
  write_frames(file(), 50, 5);
  for (unsigned i = 0; i < 5; ++i) {
    const Frame frame = read_whole_frame(file(), {.nu = {}, .frame = i, .segment = {}});
    const State expected = random_state(50, i);
    EXPECT_EQ(frame.index, i);
    EXPECT_EQ(frame.state, expected);
    EXPECT_EQ(frame.observables, observables_of(expected, i / 2));
  }
  const auto all = list_frames(file());
  ASSERT_EQ(all.size(), 5u);
  EXPECT_EQ(all[3], observables_of(random_state(50, 3), 1));
}

TEST_F(SnapshotTest, MoreGrainsThanOneChunkHolds) {
  write_frames(file(), 40000, 2);
  EXPECT_EQ(read_frame(file(), {}), random_state(40000, 1));
}

TEST_F(SnapshotTest, VolumeFractionOfAState) {
  State state;
  state.box = Mat3::diagonal({2, 3, 4});
  state.radius = {0.5, 1};
  EXPECT_DOUBLE_EQ(state.volume_fraction(), 4.0 / 3.0 * std::numbers::pi * 1.125 / 24);
}

TEST_F(SnapshotTest, EveryFrameCanBeReadAsSoonAsItIsAppended) {
  SnapshotWriter writer(file(), random_state(9, 0).radius);
  EXPECT_EQ(error_of(file()), "has no frame");
  for (unsigned i = 0; i < 4; ++i) {
    const State state = random_state(9, i);
    writer.append(state, observables_of(state));
    EXPECT_EQ(writer.frames(), i + 1);
    EXPECT_EQ(list_frames(file()).size(), i + 1);
    EXPECT_EQ(read_frame(file(), {}), state);
  }
}

std::string text_attribute(hid_t file, const char* object, const char* name) {
  const hid_t attribute = H5Aopen_by_name(file, object, name, H5P_DEFAULT, H5P_DEFAULT);
  if (attribute < 0) return "(none)";
  const hid_t type = H5Aget_type(attribute);
  std::string text(static_cast<std::size_t>(H5Aget_storage_size(attribute)), '\0');
  H5Aread(attribute, type, text.data());
  H5Tclose(type);
  H5Aclose(attribute);
  return text;
}

std::vector<hsize_t> shape_of(hid_t file, const char* name) {
  const hid_t dataset = H5Dopen2(file, name, H5P_DEFAULT);
  if (dataset < 0) return {};
  const hid_t space = H5Dget_space(dataset);
  std::vector<hsize_t> shape(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
  H5Sget_simple_extent_dims(space, shape.data(), nullptr);
  H5Sclose(space);
  H5Dclose(dataset);
  return shape;
}

haddr_t address_of(hid_t file, const char* name) {
  H5O_info_t info{};
  H5Oget_info_by_name2(file, name, &info, H5O_INFO_BASIC, H5P_DEFAULT);
  return info.addr;
}

/// So that equal runs leave equal files.
TEST_F(SnapshotTest, TheSameFramesAreTheSameBytesWheneverTheyAreWritten) {
  write_frames(file("first.h5"), 20, 2);
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // HDF5's times are whole seconds
  write_frames(file("second.h5"), 20, 2);
  EXPECT_EQ(bytes_of(file("first.h5")), bytes_of(file("second.h5")));
}

TEST_F(SnapshotTest, LayoutIsH5MD) {
  write_frames(file(), 9, 3);
  const hid_t id = H5Fopen(file().c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  ASSERT_GE(id, 0);
  int version[2] = {0, 0};
  const hid_t attribute = H5Aopen_by_name(id, "/h5md", "version", H5P_DEFAULT, H5P_DEFAULT);
  H5Aread(attribute, H5T_NATIVE_INT, version);
  H5Aclose(attribute);
  EXPECT_EQ(version[0], 1);
  EXPECT_EQ(version[1], 1);
  EXPECT_EQ(text_attribute(id, "/h5md/creator", "name"), "grainlaw");
  EXPECT_NE(text_attribute(id, "/h5md/creator", "version"), "(none)");
  EXPECT_NE(text_attribute(id, "/h5md/author", "name"), "(none)");
  EXPECT_EQ(text_attribute(id, "/particles/grains/box", "boundary"), "periodicperiodicperiodic");
  using Shape = std::vector<hsize_t>;
  EXPECT_EQ(shape_of(id, "/particles/grains/box/edges/value"), (Shape{3, 3, 3}));
  EXPECT_EQ(shape_of(id, "/particles/grains/position/value"), (Shape{3, 9, 3}));
  EXPECT_EQ(shape_of(id, "/particles/grains/velocity/value"), (Shape{3, 9, 3}));
  EXPECT_EQ(shape_of(id, "/particles/grains/radius"), (Shape{9}));
  for (const std::string name : {"nu", "eps_vol", "eps_dev", "segment"})
    EXPECT_EQ(shape_of(id, ("/observables/" + name + "/value").c_str()), (Shape{3})) << name;
  EXPECT_EQ(text_attribute(id, "/particles/grains/position/value", "unit"), "mm");
  EXPECT_EQ(text_attribute(id, "/particles/grains/velocity/value", "unit"), "mm us-1");
  EXPECT_EQ(text_attribute(id, "/particles/grains/velocity", "meaning").substr(0, 20),
            "fluctuation velocity");
  EXPECT_EQ(text_attribute(id, "/particles/grains/box/edges/value", "unit"), "mm");
  EXPECT_EQ(text_attribute(id, "/particles/grains/box/edges/time", "unit"), "us");
  EXPECT_EQ(text_attribute(id, "/particles/grains/radius", "unit"), "mm");
  // H5MD: all elements of a group share step and time with its box.
  for (const std::string element :
       {"/particles/grains/position", "/particles/grains/velocity", "/observables/nu"})
    for (const std::string name : {"step", "time"})
      EXPECT_EQ(address_of(id, (element + "/" + name).c_str()),
                address_of(id, ("/particles/grains/box/edges/" + name).c_str()));
  H5Fclose(id);
}

// ---- choosing a frame

const std::vector<Observables> loading_and_unloading{
    {0.64, 0, 0, 0}, {0.70, 0, 0, 0}, {0.82, 0, 0, 0}, {0.70002, 0, 0, 1}, {0.66, 0, 0, 1}};

std::string find_error(const FrameChoice& choice) {
  try {
    find_frame(loading_and_unloading, choice, "a.h5");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(FrameChoiceTest, LastNearestOrByIndex) {
  const auto& all = loading_and_unloading;
  EXPECT_EQ(find_frame(all, {}, "a.h5"), 4u);
  EXPECT_EQ(find_frame(all, {.nu = {}, .frame = {}, .segment = 0}, "a.h5"), 2u);
  EXPECT_EQ(find_frame(all, {.nu = {}, .frame = 1, .segment = {}}, "a.h5"), 1u);
  EXPECT_EQ(find_frame(all, {.nu = 0.6605, .frame = {}, .segment = {}}, "a.h5"), 4u);
  EXPECT_EQ(find_frame(all, {.nu = 0.7, .frame = {}, .segment = 0}, "a.h5"), 1u);
  EXPECT_EQ(find_frame(all, {.nu = 0.7, .frame = {}, .segment = 1}, "a.h5"), 3u);
}

TEST(FrameChoiceTest, RefusesWhatIsNotThere) {
  EXPECT_EQ(find_error({.nu = 0.75, .frame = {}, .segment = {}}),
            "a.h5: has no frame within 0.001 of nu = 0.75; the nearest is frame 3 (segment 1, nu 0.70002)");
  EXPECT_EQ(
      find_error({.nu = 0.82, .frame = {}, .segment = 1}),
      "a.h5: has no frame within 0.001 of nu = 0.82 in segment 1; the nearest is frame 3 (segment 1, nu "
      "0.70002)");
  EXPECT_EQ(find_error({.nu = {}, .frame = 5, .segment = {}}), "a.h5: has no frame 5, only frames 0 to 4");
  EXPECT_EQ(find_error({.nu = {}, .frame = {}, .segment = 2}), "a.h5: has no frame in segment 2");
}

TEST(FrameChoiceTest, RefusesTwoFramesThatFitEquallyWell) {
  EXPECT_EQ(find_error({.nu = 0.7, .frame = {}, .segment = {}}),
            "a.h5: nu = 0.7 does not say which frame: frame 1 (segment 0, nu 0.7) or frame 3 (segment 1, nu "
            "0.70002); give segment or frame");
}

// ---- bad files

TEST_F(SnapshotTest, MissingOrForeignFile) {
  EXPECT_EQ(error_of(file("none.h5")), "no such file");
  write_bytes(file("text.h5"), "position 1 2 3\n");
  EXPECT_EQ(error_of(file("text.h5")),
            "is not a snapshot file, or is cut short or damaged (HDF5: file signature not found)");
  write_bytes(file("empty.h5"), "");
  EXPECT_NE(error_of(file("empty.h5")), "");
  const hid_t id = H5Fcreate(file("foreign.h5").c_str(), H5F_ACC_EXCL, H5P_DEFAULT, H5P_DEFAULT);
  H5Fclose(id);
  EXPECT_NE(
      error_of(file("foreign.h5")).find("dataset /particles/grains/box/edges/step is missing or damaged"),
      std::string::npos);
}

TEST_F(SnapshotTest, CutShortAnywhereIsAnError) {
  write_frames(file(), 8, 2);
  const std::string whole = bytes_of(file());
  for (std::size_t length = 0; length < whole.size(); length += 97) {
    write_bytes(file("cut.h5"), whole.substr(0, length));
    EXPECT_NE(error_of(file("cut.h5"), {.nu = {}, .frame = 0, .segment = {}}), "") << length;
  }
  write_bytes(file("cut.h5"), whole.substr(0, whole.size() - 1));
  EXPECT_NE(error_of(file("cut.h5")).find("cut short or damaged (HDF5: truncated file"), std::string::npos);
}

TEST_F(SnapshotTest, FlippedByteIsFoundOrHarmless) {
  write_frames(file(), 8, 2);
  const std::string whole = bytes_of(file());
  const State expected = random_state(8, 1);
  std::fstream bytes(file(), std::ios::binary | std::ios::in | std::ios::out);
  const auto put = [&](std::size_t at, char byte) {
    bytes.seekp(static_cast<std::streamoff>(at)).put(byte).flush();
  };
  std::size_t found = 0, tried = 0;
  for (std::size_t at = 0; at < whole.size(); at += at < 512 ? 1 : 13, ++tried) {
    put(at, static_cast<char>(~whole[at]));
    try {
      EXPECT_EQ(read_frame(file(), {}), expected) << "byte " << at;
    } catch (const Error& error) {
      EXPECT_EQ(error.file(), file().string());
      ++found;
    }
    put(at, whole[at]);
  }
  // The rest is space that nothing uses, and the other frame.
  EXPECT_GT(found, tried / 10);
}

TEST_F(SnapshotTest, FlippedByteInTheHeader) {
  write_frames(file(), 8, 1);
  std::string bytes = bytes_of(file());
  bytes[20] = static_cast<char>(~bytes[20]);  // the first header holds addresses and their checksum
  write_bytes(file("flipped.h5"), bytes);
  EXPECT_NE(error_of(file("flipped.h5")).find("is not a snapshot file, or is cut short or damaged (HDF5: "),
            std::string::npos);
}

TEST_F(SnapshotTest, ErrorsOfHdf5AreNotPrinted) {
  write_bytes(file(), "nonsense");
  testing::internal::CaptureStderr();
  EXPECT_NE(error_of(file()), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(SnapshotTest, WrongShapesAndTypes) {
  const std::string grains = "/particles/grains/";
  const auto spoilt = [&](const std::string& name, const std::vector<hsize_t>& shape, hid_t type) {
    fs::remove(file());
    write_frames(file(), 8, 2);
    replace(file(), name, shape, type);
    return error_of(file());
  };
  EXPECT_EQ(spoilt(grains + "position/value", {2, 7, 3}, H5T_NATIVE_DOUBLE),
            "/particles/grains/position/value: must have shape [2, 8, 3], got [2, 7, 3]");
  EXPECT_EQ(spoilt(grains + "velocity/value", {1, 8, 3}, H5T_NATIVE_DOUBLE),
            "/particles/grains/velocity/value: must have shape [2, 8, 3], got [1, 8, 3]");
  EXPECT_EQ(spoilt(grains + "box/edges/value", {2, 3}, H5T_NATIVE_DOUBLE),
            "/particles/grains/box/edges/value: must have shape [2, 3, 3], got [2, 3]");
  EXPECT_EQ(spoilt("/observables/nu/value", {1}, H5T_NATIVE_DOUBLE),
            "/observables/nu/value: must have shape [2], got [1]");
  EXPECT_EQ(spoilt("/observables/segment/value", {2}, H5T_NATIVE_DOUBLE),
            "/observables/segment/value: must hold whole numbers");
  EXPECT_EQ(spoilt(grains + "position/value", {2, 8, 3}, H5T_NATIVE_INT),
            "/particles/grains/position/value: must hold real numbers");
  EXPECT_EQ(spoilt(grains + "radius", {8, 1}, H5T_NATIVE_DOUBLE),
            "/particles/grains/radius: must have one dimension, got 2");
}

TEST_F(SnapshotTest, NumbersThatCannotBe) {
  const std::string grains = "/particles/grains/";
  const auto spoilt = [&](const std::string& name, std::vector<double> values) {
    fs::remove(file());
    write_frames(file(), 8, 1);
    overwrite(file(), name, std::move(values));
    return error_of(file());
  };
  std::vector<double> position(24, 0.5), radius(8, 1.0), box{4, 0, 0, 0, 4, 0, 0, 0, 4};
  position[10] = std::nan("");
  EXPECT_EQ(spoilt(grains + "position/value", position),
            "/particles/grains/position/value: grain 3 of frame 0 has a value that is not a number");
  EXPECT_EQ(spoilt(grains + "velocity/value", position),
            "/particles/grains/velocity/value: grain 3 of frame 0 has a value that is not a number");
  radius[5] = 0;
  EXPECT_EQ(spoilt(grains + "radius", radius), "/particles/grains/radius: must be > 0, got 0 for grain 5");
  radius[5] = -1;
  EXPECT_EQ(spoilt(grains + "radius", radius), "/particles/grains/radius: must be > 0, got -1 for grain 5");
  box[4] = -4;
  EXPECT_EQ(spoilt(grains + "box/edges/value", box),
            "/particles/grains/box/edges/value: edges of the box must be > 0, got -4");
  box = {0, 4, 0, 4, 0, 0, 0, 0, 4};
  EXPECT_EQ(spoilt(grains + "box/edges/value", box),
            "/particles/grains/box/edges/value: edges of the box must span a right-handed parallelepiped, "
            "got a volume of -64");
  EXPECT_EQ(spoilt("/observables/nu/value", {std::nan("")}),
            "/observables/nu/value: frame 0 has a value that is not a number");
  EXPECT_NE(
      spoilt("/observables/nu/value", {0.5}).find("frame 0: nu is stored as 0.5, but grains and box give "),
      std::string::npos);
}

TEST_F(SnapshotTest, KeepsATiltedBox) {
  State state = random_state(20, 3);
  state.box = state.box * Mat3({1, 0.4, -0.3}, {0.1, 1, 1.7}, {0, 0.2, 1});
  SnapshotWriter(file(), state.radius).append(state, observables_of(state));
  EXPECT_EQ(read_frame(file(), {}), state);
}

// ---- the writer

TEST_F(SnapshotTest, WriterRefusesToOverwrite) {
  write_bytes(file(), "precious");
  EXPECT_THROW(SnapshotWriter(file(), {1.0}), Error);
  EXPECT_EQ(bytes_of(file()), "precious");
}

TEST_F(SnapshotTest, WriterRefusesOtherGrainsAndNonNumbers) {
  const State state = random_state(8, 0);
  SnapshotWriter writer(file(), state.radius);
  EXPECT_THROW(writer.append(random_state(9, 0), observables_of(state)), Error);
  State nan = state;
  nan.velocity[3][1] = std::nan("");
  EXPECT_THROW(writer.append(nan, observables_of(state)), Error);
  writer.append(state, observables_of(state));
  EXPECT_EQ(read_frame(file(), {}), state);
}

TEST_F(SnapshotTest, FolderThatIsNotThere) {
  EXPECT_THROW(SnapshotWriter(file("none") / "snapshots.h5", {1.0}), Error);
}

/// Runs `work` in a child process and returns its exit status. With `begun`, kills the child `wait` after
/// that file has appeared, and returns -1.
template <typename Work>
int in_child(Work&& work, const fs::path& begun = {}, std::chrono::microseconds wait = {}) {
  const pid_t child = fork();
  if (child == 0) {
    int status = 1;
    try {
      status = work();
    } catch (...) {
    }
    std::exit(status);  // with the exit handlers of HDF5
  }
  if (!begun.empty()) {
    for (int i = 0; i < 20000 && !fs::exists(begun); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::this_thread::sleep_for(wait);
    kill(child, SIGKILL);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST_F(SnapshotTest, RunKilledWhileWritingLosesOneFrameAtMost) {
  constexpr std::size_t count = 2000;
  std::mt19937 random(1);
  std::size_t most = 0;
  for (int trial = 0; trial < 20; ++trial) {
    fs::remove(file());
    SnapshotWriter writer(file(), random_state(count, 0).radius);
    const State first = random_state(count, 0);
    writer.append(first, observables_of(first));
    const auto endless = [&] {
      for (unsigned i = 1;; ++i) {
        const State state = random_state(count, i);
        writer.append(state, observables_of(state));
        std::ofstream(file("done")) << i << std::flush;
      }
      return 0;
    };
    EXPECT_EQ(in_child(endless, file("done"), std::chrono::microseconds(random() % 20000)), -1);
    std::size_t done = 0;
    std::ifstream(file("done")) >> done;
    const auto frames = list_frames(file());
    EXPECT_GE(frames.size(), done + 1);
    for (std::size_t i = 0; i < frames.size(); ++i)
      EXPECT_EQ(read_frame(file(), {.nu = {}, .frame = i, .segment = {}}),
                random_state(count, static_cast<unsigned>(i)));
    most = std::max(most, frames.size());
    fs::remove(file("done"));
  }
  EXPECT_GT(most, 1u);  // or nothing was killed while writing
}

TEST_F(SnapshotTest, DiskFullIsSaidAndKeepsWhatWasWritten) {
  constexpr std::size_t count = 1000;
  const auto fill = [&] {
    const rlimit limit{300'000, 300'000};
    setrlimit(RLIMIT_FSIZE, &limit);
    std::signal(SIGXFSZ, SIG_IGN);
    SnapshotWriter writer(file(), random_state(count, 0).radius);
    try {
      for (unsigned i = 0; i < 100; ++i) {
        const State state = random_state(count, i);
        writer.append(state, observables_of(state));
      }
    } catch (const Error& error) {
      const std::string text = error.what(), name = file().string();
      const bool said = error.unwritable() && text == name + ": cannot be written: File too large";
      return said ? static_cast<int>(writer.frames()) : 99;
    }
    return 99;
  };
  const int frames = in_child(fill);
  ASSERT_GE(frames, 1);
  ASSERT_LE(frames, 6);  // 48 kB each
  ASSERT_EQ(list_frames(file()).size(), static_cast<std::size_t>(frames));
  for (unsigned i = 0; i < static_cast<unsigned>(frames); ++i)
    EXPECT_EQ(read_frame(file(), {.nu = {}, .frame = i, .segment = {}}), random_state(count, i));
}

TEST_F(SnapshotTest, DiskFullAtOnceLeavesNoFile) {
  const auto create = [&] {
    const rlimit limit{20'000, 20'000};
    setrlimit(RLIMIT_FSIZE, &limit);
    std::signal(SIGXFSZ, SIG_IGN);
    try {
      SnapshotWriter(file(), random_state(10000, 0).radius);
    } catch (const Error& error) {
      return error.unwritable() ? 0 : 2;
    }
    return 3;
  };
  EXPECT_EQ(in_child(create), 0);
  EXPECT_FALSE(fs::exists(file()));
}

TEST_F(SnapshotTest, ThreadsMayWriteAndReadAtOnce) {
  std::vector<std::thread> threads;
  for (unsigned t = 0; t < 4; ++t)
    threads.emplace_back([&, t] {
      const auto own = file("thread" + std::to_string(t) + ".h5");
      write_frames(own, 20 + t, 10);
      for (unsigned i = 0; i < 10; ++i)
        EXPECT_EQ(read_frame(own, {.nu = {}, .frame = i, .segment = {}}), random_state(20 + t, i));
      EXPECT_EQ(error_of(file("none.h5")), "no such file");
    });
  for (auto& thread : threads) thread.join();
}

}  // namespace
}  // namespace grainlaw::dem
