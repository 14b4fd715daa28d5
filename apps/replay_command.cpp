// grainlaw replay: a failed increment of a host once more.
#include <fmt/format.h>

#include <memory>
#include <string>

#include "grainlaw/apps/commands.hpp"
#include "grainlaw/apps/terminal.hpp"
#include "grainlaw/element/components.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/model/c/replay.hpp"
#include "grainlaw/model/c/state_table.hpp"

namespace grainlaw::apps {

namespace {

std::string outcome(const std::string& status, const std::string& message) {
  return status + (message.empty() ? "" : ": " + message);
}

int run(const std::string& file) {
  const model::Replay kept = model::Replay::load(file);
  const model::Replayed now = model::replay(kept);
  Terminal terminal;
  terminal.say(fmt::format("{}: {} with the set \"{}\", written by grainlaw {} ({})", file,
                           name_of(kept.settings.choice), kept.parameters.name, kept.version, kept.commit));
  terminal.say("then  " + outcome(kept.status, kept.message));
  terminal.say("now   " + outcome(name_of(now.status.code), now.status.message));
  terminal.say(fmt::format("{:<12} {:<24} {}", "state", "before", "after"));
  const auto before = row_of(kept.state), after = row_of(now.state);
  for (std::size_t i = 1; i < model::state_length; ++i)
    terminal.say(
        fmt::format("{:<12} {:<24} {}", model::state_names[i], to_text(before[i]), to_text(after[i])));
  for (std::size_t i = 0; i < 6; ++i)
    terminal.say(fmt::format("{:<12} {:<24} {}", fmt::format("strain {}", tensor_components[i]),
                             to_text(kept.increment[i]),
                             fmt::format("stress {} {}", tensor_components[i], to_text(now.stress[i]))));
  return now.status.failed() ? failed : all_well;
}

}  // namespace

Action add_replay(CLI::App& program) {
  CLI::App* command = program.add_subcommand(
      "replay",
      "Does an increment that failed in a host once more, from the file that the C interface wrote");
  const auto file = std::make_shared<std::string>();
  command->add_option("REPLAY.json", *file, "what a context wrote: grainlaw_context_replay_file()")
      ->required();
  command->footer("Example:\n  grainlaw replay failed.json");
  return [file] { return run(*file); };
}

}  // namespace grainlaw::apps
