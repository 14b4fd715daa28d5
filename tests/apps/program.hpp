// Runs the real program as its users do, in a folder of its own, and tells what it said and how it ended.
#pragma once

#include <gtest/gtest.h>
#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace grainlaw::apps {

using Arguments = std::vector<std::string>;

/// How a run ended.
struct Outcome {
  int status = -1;  ///< exit status; 128 + signal where a signal ended it
  std::string out, err;
};

/// How a run is to be started.
struct Setting {
  std::string stdout_file;  ///< instead of one that is read back
  long file_limit = -1;     ///< bytes that a file may have; -1: no limit
};

/// The program while it runs.
class Running {
 public:
  Running(const std::filesystem::path& folder, const Arguments& arguments, const Setting& setting = {});
  /// Kills it, should it still run.
  ~Running();
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  void send(int signal) const;
  bool ended();
  Outcome wait();

 private:
  pid_t process_ = -1;
  int wait_status_ = 0;
  bool reaped_ = false;
  std::filesystem::path out_, err_;
};

/// A folder for one test, and the program run in it.
class Program : public testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;

  Outcome run(const Arguments& arguments, const Setting& setting = {}) const;
  /// A file in the folder.
  std::string write(const std::string& name, const std::string& text) const;
  std::string read(const std::string& name) const;
  /// Everything below `name`, sorted.
  std::vector<std::string> listing(const std::string& name) const;

  std::filesystem::path folder;
};

/// Waits until `holds`, at most a minute; false if it never did.
bool eventually(const std::function<bool()>& holds);

/// The campaign of these tests: 64 grains, 10 runs, some seconds.
std::string tiny_campaign();

/// Bad input: status 2, nothing on standard output, and one line on standard error that holds each of
/// `parts`.
testing::AssertionResult refuses(const Outcome& outcome, const std::vector<std::string>& parts);

}  // namespace grainlaw::apps
