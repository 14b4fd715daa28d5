#include "program.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <thread>

#include "grainlaw/element/file.hpp"

namespace grainlaw::apps {

namespace fs = std::filesystem;

namespace {

std::atomic<int> started{0};  ///< to tell the output files apart

/// In the child: where its output goes, what it may write; then the program. Only calls that are safe after
/// fork.
[[noreturn]] void become_program(const char* folder, const char* out, const char* err, long file_limit,
                                 char* const* words) {
  const int out_descriptor = ::open(out, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  const int err_descriptor = ::open(err, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (out_descriptor < 0 || err_descriptor < 0 || ::dup2(out_descriptor, STDOUT_FILENO) < 0 ||
      ::dup2(err_descriptor, STDERR_FILENO) < 0 || ::chdir(folder) != 0)
    ::_exit(126);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    ::signal(signal, SIG_DFL);  // a test run may ignore them, users do not
  if (file_limit >= 0) {
    const struct rlimit limit { static_cast<rlim_t>(file_limit), static_cast<rlim_t>(file_limit) };
    if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) ::_exit(126);
  }
  ::execv(GRAINLAW_PROGRAM, words);
  ::_exit(127);
}

}  // namespace

Running::Running(const fs::path& folder, const Arguments& arguments, const Setting& setting) {
  const std::string number = std::to_string(++started);
  out_ = setting.stdout_file.empty() ? folder / (".out-" + number) : fs::path(setting.stdout_file);
  err_ = folder / (".err-" + number);
  std::string name = "grainlaw";
  std::vector<std::string> copies = arguments;
  std::vector<char*> words{name.data()};
  for (auto& word : copies) words.push_back(word.data());
  words.push_back(nullptr);
  process_ = ::fork();
  if (process_ == 0)
    become_program(folder.c_str(), out_.c_str(), err_.c_str(), setting.file_limit, words.data());
}

Running::~Running() {
  if (reaped_ || process_ <= 0) return;
  ::kill(process_, SIGKILL);
  ::waitpid(process_, nullptr, 0);
}

void Running::send(int signal) const { ::kill(process_, signal); }

bool Running::ended() {
  if (!reaped_) reaped_ = ::waitpid(process_, &wait_status_, WNOHANG) == process_;
  return reaped_;
}

Outcome Running::wait() {
  if (!reaped_) reaped_ = ::waitpid(process_, &wait_status_, 0) == process_;
  Outcome outcome;
  outcome.status = WIFEXITED(wait_status_) ? WEXITSTATUS(wait_status_) : 128 + WTERMSIG(wait_status_);
  if (fs::is_regular_file(out_)) outcome.out = read_file(out_);
  outcome.err = read_file(err_);
  return outcome;
}

void Program::SetUp() {
  ::unsetenv(
      "GRAINLAW_HOME");  // a program that the entry script did not start, even where that runs the tests
  folder = fs::temp_directory_path() / ("grainlaw-apps-" + std::to_string(::getpid()));
  fs::remove_all(folder);
  fs::create_directories(folder);
  fs::create_directory_symlink(fs::path(GRAINLAW_SOURCE_DIR) / "data", folder / "data");
}

void Program::TearDown() { fs::remove_all(folder); }

Outcome Program::run(const Arguments& arguments, const Setting& setting) const {
  return Running(folder, arguments, setting).wait();
}

std::string Program::write(const std::string& name, const std::string& text) const {
  fs::create_directories((folder / name).parent_path());
  write_file(folder / name, text);
  return name;
}

std::string Program::read(const std::string& name) const { return read_file(folder / name); }

std::vector<std::string> Program::listing(const std::string& name) const {
  std::vector<std::string> names;
  if (!fs::exists(folder / name)) return names;
  for (const auto& entry : fs::recursive_directory_iterator(folder / name))
    names.push_back(fs::relative(entry.path(), folder / name).string());
  std::sort(names.begin(), names.end());
  return names;
}

bool eventually(const std::function<bool()>& holds) {
  for (int i = 0; i < 3000; ++i) {
    if (holds()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return false;
}

std::string tiny_campaign() { return read_file(fs::path(GRAINLAW_SOURCE_DIR) / "tests/apps/tiny.json"); }

testing::AssertionResult refuses(const Outcome& outcome, const std::vector<std::string>& parts) {
  const auto failure = testing::AssertionFailure() << "status " << outcome.status << ", out \"" << outcome.out
                                                   << "\", err \"" << outcome.err << "\": ";
  auto result = failure;
  if (outcome.status != 2) return result << "the status must be 2";
  if (!outcome.out.empty()) return result << "nothing must be on standard output";
  if (std::count(outcome.err.begin(), outcome.err.end(), '\n') != 1 || !outcome.err.ends_with("\n"))
    return result << "standard error must have one line";
  for (const auto& part : parts)
    if (outcome.err.find(part) == std::string::npos) return result << "it must say \"" << part << '"';
  return testing::AssertionSuccess();
}

}  // namespace grainlaw::apps
