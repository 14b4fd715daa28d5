// Binary archives: what is written is read back, and a file that was changed in any way is refused.
#include "grainlaw/dem/files/archive.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <limits>

#include "grainlaw/element/error.hpp"
#include "grainlaw/element/file.hpp"

namespace grainlaw::dem {
namespace {

namespace fs = std::filesystem;

struct Inner {
  Quads quads;
  std::string name;
  template <class Self, class Archive>
  static void keep(Self& self, Archive& archive) {
    archive(self.quads, self.name);
  }
};

class Archives : public testing::Test {
 protected:
  void SetUp() override {
    file = fs::temp_directory_path() / ("grainlaw-archive-" + std::to_string(::getpid()));
    ArchiveWriter archive(file);
    archive.line("a line");
    archive(-0.0, std::numeric_limits<double>::quiet_NaN(), std::uint64_t{7}, true);
    archive(std::vector<Inner>{{{{1, 2, 3, 4}, {5, 6, 7, 8}}, "one"}, {{}, ""}});
    archive(std::vector<Vec3>{{1, 2, 3}}, std::vector<char>{'x', 'y', 'z'});
    archive.finish();
    whole = read_file(file);
  }
  void TearDown() override { fs::remove(file); }

  void expect_refused(const std::string& text, const std::string& why) {
    std::ofstream(file, std::ios::binary) << text;
    try {
      ArchiveReader archive(file);
      ADD_FAILURE() << "not refused: " << why;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(file.string() + ": is cut short")) << why;
    }
  }

  fs::path file;
  std::string whole;
};

TEST_F(Archives, GiveBackWhatWasWritten) {
  ArchiveReader archive(file);
  EXPECT_EQ(archive.line(), "a line");
  double zero = 1, undefined = 1;
  std::uint64_t seven = 0;
  bool yes = false;
  std::vector<Inner> list;
  std::vector<Vec3> vectors;
  std::vector<char> letters;
  archive(zero, undefined, seven, yes, list, vectors);
  EXPECT_THROW(archive.finish(), Error);  // not all of it is read
  archive(letters);
  archive.finish();
  EXPECT_TRUE(std::signbit(zero));
  EXPECT_TRUE(std::isnan(undefined));
  EXPECT_EQ(seven, 7u);
  EXPECT_TRUE(yes);
  ASSERT_EQ(list.size(), 2u);
  ASSERT_EQ(list[0].quads.size(), 2u);
  EXPECT_EQ(list[0].quads[1].z, 7);
  EXPECT_EQ(list[0].name, "one");
  EXPECT_TRUE(list[1].quads.empty());
  EXPECT_EQ(vectors, (std::vector<Vec3>{{1, 2, 3}}));
  EXPECT_EQ(letters, (std::vector<char>{'x', 'y', 'z'}));
  EXPECT_THROW(archive(seven), Error);  // there is no more
}

TEST_F(Archives, CutShortAnywhereTheyAreRefused) {
  for (std::size_t length = 0; length < whole.size(); ++length)
    expect_refused(whole.substr(0, length), "cut to " + std::to_string(length));
}

TEST_F(Archives, WithAnyBitFlippedTheyAreRefused) {
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string text = whole;
    text[at] = static_cast<char>(text[at] ^ (1 << (at % 8)));
    expect_refused(text, "flipped at " + std::to_string(at));
  }
}

TEST_F(Archives, WithAnythingBehindTheyAreRefused) {
  for (const std::string& more : {std::string(1, '\0'), std::string(8, '\0'), std::string("more")})
    expect_refused(whole + more, "with more");
}

TEST_F(Archives, AMissingFileOrFolderIsNamed) {
  EXPECT_THROW(ArchiveReader("/nowhere/at/all"), Error);
  EXPECT_THROW(ArchiveWriter("/nowhere/at/all"), Error);
  EXPECT_THROW(
      {
        ArchiveWriter full("/dev/full");
        full(std::vector<double>(100000));
        full.finish();
      },
      Error);
}

}  // namespace
}  // namespace grainlaw::dem
