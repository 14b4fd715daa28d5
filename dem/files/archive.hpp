// Binary files that say whether they are whole: what a checkpoint is written to and read from, field by
// field. A type that can be kept says so in one function for both directions, so that the two cannot
// disagree:
//
//   template <class Self, class Archive>
//   static void keep(Self& self, Archive& archive) { archive(self.step, self.start_length); }
#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "grainlaw/dem/numbers/vec.hpp"

namespace grainlaw::dem {

/// Types that are kept byte by byte: numbers, and arrays of them without gaps.
template <class T>
struct IsFlat : std::bool_constant<std::is_arithmetic_v<T> || std::is_enum_v<T>> {};
template <class T, std::size_t n>
struct IsFlat<std::array<T, n>> : IsFlat<T> {};
template <>
struct IsFlat<Quad> : std::true_type {};

/// Sees every word once; a change of any one of them changes the result.
class Checksum {
 public:
  void add(const char* bytes, std::size_t size);
  std::uint64_t value() const;

 private:
  void add_word(std::uint64_t word);
  std::uint64_t sum_ = 0xcbf29ce484222325u;
  std::uint64_t open_ = 0;  ///< bytes that do not fill a word yet
  unsigned filled_ = 0;
};

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

class ArchiveWriter {
 public:
  /// Creates the file, or writes over it; throws Error where that fails, as everything below does.
  explicit ArchiveWriter(std::filesystem::path file);

  template <class... T>
  void operator()(const T&... values) {
    (put(values), ...);
  }
  /// A line of text, without its end.
  void line(const std::string& text);
  /// Adds the checksum, and returns when everything is on disk.
  void finish();

 private:
  template <class T>
  void put(const T& value) {
    if constexpr (IsFlat<T>::value)
      bytes(&value, sizeof value);
    else
      T::keep(value, *this);
  }
  template <class T, class A>
  void put(const std::vector<T, A>& list) {
    put(std::uint64_t{list.size()});
    if constexpr (IsFlat<T>::value)
      bytes(list.data(), list.size() * sizeof(T));
    else
      for (const T& value : list) put(value);
  }
  void put(const std::string& text) { put(std::vector<char>(text.begin(), text.end())); }
  void bytes(const void* data, std::size_t size);
  [[noreturn]] void fail() const;

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, CloseFile> file_;
  Checksum checksum_;
};

class ArchiveReader {
 public:
  /// Reads all of the file once; throws Error if it is not as it was written.
  explicit ArchiveReader(std::filesystem::path file);

  template <class... T>
  void operator()(T&... values) {
    (get(values), ...);
  }
  template <class T>
  T take() {
    T value;
    get(value);
    return value;
  }
  std::string line();
  /// Throws Error unless everything has been read.
  void finish();
  const std::filesystem::path& path() const { return path_; }

 private:
  template <class T>
  void get(T& value) {
    if constexpr (IsFlat<T>::value)
      bytes(&value, sizeof value);
    else
      T::keep(value, *this);
  }
  template <class T, class A>
  void get(std::vector<T, A>& list) {
    list.resize(count(IsFlat<T>::value ? sizeof(T) : 1));
    if constexpr (IsFlat<T>::value)
      bytes(list.data(), list.size() * sizeof(T));
    else
      for (T& value : list) get(value);
  }
  void get(std::string& text) {
    std::vector<char> letters;
    get(letters);
    text.assign(letters.begin(), letters.end());
  }
  void check();
  /// The length of a list of things that take at least `size` bytes each.
  std::size_t count(std::size_t size);
  void bytes(void* data, std::size_t size);
  [[noreturn]] void refuse(const std::string& why) const;

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, CloseFile> file_;
  std::uint64_t left_ = 0;  ///< bytes before the checksum that are still to be read
};

}  // namespace grainlaw::dem
