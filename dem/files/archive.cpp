#include "grainlaw/dem/files/archive.hpp"

#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <utility>

#include "grainlaw/element/error.hpp"

namespace grainlaw::dem {

namespace {

constexpr std::size_t word_size = sizeof(std::uint64_t);
constexpr std::size_t longest_line = 4096;

}  // namespace

void Checksum::add_word(std::uint64_t word) { sum_ = std::rotl((sum_ ^ word) * 0x9e3779b97f4a7c15u, 29); }

void Checksum::add(const char* bytes, std::size_t size) {
  const auto add_byte = [this](char byte) {
    open_ |= std::uint64_t{static_cast<unsigned char>(byte)} << (8 * filled_);
    if (++filled_ < word_size) return;
    add_word(open_);
    open_ = filled_ = 0;
  };
  while (size > 0 && filled_ > 0) {
    add_byte(*bytes++);
    --size;
  }
  for (; size >= word_size; bytes += word_size, size -= word_size) {
    std::uint64_t word;
    std::memcpy(&word, bytes, word_size);
    add_word(word);
  }
  for (; size > 0; --size) add_byte(*bytes++);
}

std::uint64_t Checksum::value() const {
  Checksum end = *this;
  end.add_word(open_);
  end.add_word(filled_);
  return end.sum_;
}

ArchiveWriter::ArchiveWriter(std::filesystem::path file)
    : path_(std::move(file)), file_(std::fopen(path_.c_str(), "wbe")) {
  if (!file_) fail();
}

void ArchiveWriter::fail() const { throw Error::cannot_write(path_.string(), std::strerror(errno)); }

void ArchiveWriter::bytes(const void* data, std::size_t size) {
  if (size == 0) return;
  if (std::fwrite(data, 1, size, file_.get()) != size) fail();
  checksum_.add(static_cast<const char*>(data), size);
}

void ArchiveWriter::line(const std::string& text) {
  bytes(text.data(), text.size());
  bytes("\n", 1);
}

void ArchiveWriter::finish() {
  const std::uint64_t sum = checksum_.value();
  bytes(&sum, sizeof sum);
  if (std::fflush(file_.get()) != 0) fail();
  if (::fsync(::fileno(file_.get())) != 0 && errno != EINVAL && errno != EROFS) fail();
  if (std::fclose(file_.release()) != 0) fail();
}

ArchiveReader::ArchiveReader(std::filesystem::path file)
    : path_(std::move(file)), file_(std::fopen(path_.c_str(), "rbe")) {
  if (!file_) throw Error(path_.string(), "", std::string("cannot be read: ") + std::strerror(errno));
  check();
}

void ArchiveReader::refuse(const std::string& why) const { throw Error(path_.string(), "", why); }

void ArchiveReader::check() {
  std::error_code code;
  const std::uint64_t size = std::filesystem::file_size(path_, code);
  if (code || size < word_size) refuse("is cut short");
  left_ = size - word_size;
  Checksum checksum;
  std::vector<char> block(1 << 16);
  for (std::uint64_t left = left_; left > 0;) {
    const std::size_t n = static_cast<std::size_t>(std::min<std::uint64_t>(left, block.size()));
    if (std::fread(block.data(), 1, n, file_.get()) != n) refuse("cannot be read");
    checksum.add(block.data(), n);
    left -= n;
  }
  std::uint64_t sum = 0;
  if (std::fread(&sum, 1, sizeof sum, file_.get()) != sizeof sum) refuse("cannot be read");
  if (sum != checksum.value()) refuse("is cut short or damaged (its checksum does not fit)");
  std::rewind(file_.get());
}

void ArchiveReader::bytes(void* data, std::size_t size) {
  if (size > left_) refuse("ends too early");
  if (size == 0) return;
  if (std::fread(data, 1, size, file_.get()) != size) refuse("cannot be read");
  left_ -= size;
}

std::size_t ArchiveReader::count(std::size_t size) {
  std::uint64_t n = 0;
  bytes(&n, sizeof n);
  if (n > left_ / size) refuse("holds a list longer than itself");
  return static_cast<std::size_t>(n);
}

std::string ArchiveReader::line() {
  std::string text;
  for (char c = 0; text.size() < longest_line;) {
    bytes(&c, 1);
    if (c == '\n') return text;
    text += c;
  }
  refuse("has no first line that can be read");
}

void ArchiveReader::finish() {
  if (left_ > 0) refuse("holds more than expected");
}

}  // namespace grainlaw::dem
