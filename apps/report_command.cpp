// grainlaw report: pictures and tables from what is on disk.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>

#include "grainlaw/apps/commands.hpp"
#include "grainlaw/apps/report/report.hpp"
#include "grainlaw/apps/terminal.hpp"

namespace grainlaw::apps {

namespace {

namespace fs = std::filesystem;

int write_report(const fs::path& dir) {
  const auto gaps = report::write_report(dir);
  write_stdout(fmt::format("wrote {}\n", (dir / "report.html").string()));
  Terminal terminal;
  int status = all_well;
  for (const report::Gap& gap : gaps) {
    if (gap.kind != report::Gap::Kind::unreadable) continue;
    terminal.warn(fmt::format("{}: {}", (dir / gap.file).string(), gap.reason));
    status = bad_input;
  }
  return status;
}

}  // namespace

Action add_report(CLI::App& program) {
  CLI::App* command =
      program.add_subcommand("report", "Pictures and tables from what is on disk: DIR/report.html");
  const auto dir = std::make_shared<std::string>();
  command->add_option("DIR", *dir, "output directory of a campaign")->required();
  command->footer("Example:\n  grainlaw report out/quick");
  return [dir] { return write_report(*dir); };
}

}  // namespace grainlaw::apps
