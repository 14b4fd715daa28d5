// grainlaw report: pictures and tables from what is on disk.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>

#include "grainlaw/apps/commands.hpp"
#include "grainlaw/apps/report/report.hpp"
#include "grainlaw/apps/terminal.hpp"

namespace grainlaw::apps {

Action add_report(CLI::App& program) {
  CLI::App* command =
      program.add_subcommand("report", "Pictures and tables from what is on disk: DIR/report.html");
  const auto dir = std::make_shared<std::string>();
  command->add_option("DIR", *dir, "output directory of a campaign")->required();
  command->footer("Example:\n  grainlaw report out/quick");
  return [dir] {
    report::write_report(*dir);
    write_stdout(fmt::format("wrote {}\n", (std::filesystem::path(*dir) / "report.html").string()));
    return all_well;
  };
}

}  // namespace grainlaw::apps
