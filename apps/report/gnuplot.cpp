#include "grainlaw/apps/report/gnuplot.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "grainlaw/element/error.hpp"

extern char** environ;

namespace grainlaw::report {
namespace {

/// A file without a name that vanishes with its handle. Files instead of pipes: whoever writes never has to
/// wait for the reader, so no order of reading and writing can lock up.
using Scratch = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

Scratch scratch() {
  Scratch file(std::tmpfile(), std::fclose);
  if (!file) throw Error(std::string("cannot make a temporary file for gnuplot: ") + std::strerror(errno));
  return file;
}

std::string contents(std::FILE* file) {
  std::string all;
  std::array<char, 65536> block;
  std::rewind(file);
  while (const std::size_t n = std::fread(block.data(), 1, block.size(), file)) all.append(block.data(), n);
  return all;
}

/// Runs the program to its end with the three files as its standard streams; its wait status.
int run(const std::string& program, std::FILE* in, std::FILE* out, std::FILE* err) {
  posix_spawn_file_actions_t streams;
  posix_spawn_file_actions_init(&streams);
  posix_spawn_file_actions_adddup2(&streams, fileno(in), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&streams, fileno(out), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&streams, fileno(err), STDERR_FILENO);
  // -d: no start-up file of the user's changes how a report looks.
  std::string name = program, no_startup_file = "-d", from_stdin = "-";
  std::array<char*, 4> arguments{name.data(), no_startup_file.data(), from_stdin.data(), nullptr};
  pid_t child = 0;
  const int failed = posix_spawnp(&child, program.c_str(), &streams, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&streams);
  if (failed == ENOENT || failed == EACCES)
    throw Error(
        "the figures of a report need the program gnuplot, which is not installed: "
        "apt-get install gnuplot-nox");
  if (failed != 0) throw Error("cannot start gnuplot: " + std::string(std::strerror(failed)));
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) throw Error("lost track of gnuplot: " + std::string(std::strerror(errno)));
  }
  return status;
}

/// gnuplot's complaint on one line.
std::string message_of(const std::string& complaint) {
  std::string line;
  for (const char c : complaint.substr(0, 2000)) {
    const bool space = c == '\n' || c == '\t' || c == ' ';
    if (!space) line += c;
    if (space && !line.empty() && line.back() != ' ') line += ' ';
  }
  while (!line.empty() && line.back() == ' ') line.pop_back();
  return line;
}

}  // namespace

std::string run_gnuplot(const std::string& script, const std::string& program) {
  const Scratch in = scratch(), out = scratch(), err = scratch();
  const bool written =
      std::fwrite(script.data(), 1, script.size(), in.get()) == script.size() && std::fflush(in.get()) == 0;
  if (!written) throw Error("cannot write the script for gnuplot to a temporary file: disk full?");
  std::rewind(in.get());
  const int status = run(program, in.get(), out.get(), err.get());
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    const std::string complaint = message_of(contents(err.get()));
    throw Error("gnuplot failed: " + (complaint.empty() ? "it gave no reason" : complaint));
  }
  return contents(out.get());
}

std::string gnuplot_quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    // gnuplot 5.4 misreads a string that begins with a doubled quote, so an apostrophe becomes a typographic
    // one.
    if (c == '\'') {
      quoted += "\u2019";
    } else {
      quoted += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    }
  }
  return quoted + "'";
}

}  // namespace grainlaw::report
