#include "grainlaw/apps/campaign_talk.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/null_sink.h>

#include <cstdlib>
#include <optional>
#include <string_view>

namespace grainlaw::apps {

namespace {

using Clock = std::chrono::steady_clock;

constexpr auto line_every = std::chrono::seconds(30);

std::shared_ptr<spdlog::logger> open_log(const std::filesystem::path& file) {
  std::shared_ptr<spdlog::logger> log;
  try {
    log = std::make_shared<spdlog::logger>(
        "campaign", std::make_shared<spdlog::sinks::basic_file_sink_mt>(file.string()));
  } catch (const spdlog::spdlog_ex&) {
    log = std::make_shared<spdlog::logger>("campaign", std::make_shared<spdlog::sinks::null_sink_mt>());
  }
  log->set_pattern("%Y-%m-%d %H:%M:%S %l %v");
  log->flush_on(spdlog::level::info);
  log->set_error_handler([](const std::string&) {});
  return log;
}

/// "43 %, 12 of 40 tests, 21.3 M particle-steps/s, 3 min 20 s left"
std::string standing(const calibrate::CampaignProgress& now) {
  std::string text =
      fmt::format("{:.0f} %, {} of {} tests", std::floor(100 * now.fraction), now.finished, now.jobs);
  if (now.rate > 0) text += ", " + speed_text(now.rate);
  if (now.seconds_left && *now.seconds_left > 0) text += ", " + time_text(*now.seconds_left) + " left";
  return text;
}

/// The largest E_k/E_p that a run warns of where it is not quasi-static; nothing for any other warning.
std::optional<double> restless_ratio(const std::string& warning) {
  constexpr std::string_view beginning = "E_k/E_p is above 1e-3 in ", before_ratio = "(largest ";
  const auto at = warning.find(before_ratio);
  if (!warning.starts_with(beginning) || at == std::string::npos) return std::nullopt;
  return std::strtod(warning.c_str() + at + before_ratio.size(), nullptr);
}

}  // namespace

CampaignTalk::CampaignTalk(Terminal& terminal, const std::filesystem::path& dir)
    : terminal_(terminal), log_(open_log(dir / "campaign.log")) {}

void CampaignTalk::say(const std::string& line) {
  terminal_.say(line);
  log_->info(line);
  last_line_ = Clock::now();
}

void CampaignTalk::complain(const std::string& line) {
  terminal_.warn(line);
  log_->error(line);
}

void CampaignTalk::remark(const std::string& record, const std::string& warning) {
  const std::string line = fmt::format("{}: {}", record, warning);
  log_->warn(line);
  const auto ratio = restless_ratio(warning);
  if (!ratio) return terminal_.warn("warning: " + line);
  ++restless_;
  if (*ratio <= worst_ratio_) return;
  worst_ratio_ = *ratio;
  worst_record_ = record;
}

void CampaignTalk::sum_up() {
  if (done_ + lost_ < jobs_ || restless_ == 0) return;
  say(
      fmt::format("{} of {} runs have rows with E_k/E_p above 1e-3 (largest {:.3g}, {}): see \"What was "
                  "run\" in the report",
                  restless_, runs_, worst_ratio_, worst_record_));
}

void CampaignTalk::show(const calibrate::CampaignProgress& progress) {
  if (terminal_.live())
    terminal_.draw(fmt::format("{} {}; {}", bar_text(progress.fraction, 20), standing(progress),
                               fmt::join(progress.running, ", ")));
  else if (Clock::now() - last_line_ >= line_every)
    say(standing(progress));
}

void CampaignTalk::finished(const calibrate::FinishedJob& job, const calibrate::CampaignProgress& progress) {
  const double speed = static_cast<double>(job.summary.particle_steps) / job.summary.wall_s;
  say(fmt::format("finished {} in {}, {}; {}", job.record, time_text(job.summary.wall_s), speed_text(speed),
                  standing(progress)));
  for (const auto& warning : job.summary.warnings) remark(job.record, warning);
  ++runs_;
  jobs_ = progress.jobs;
  done_ = progress.finished;
  sum_up();
}

void CampaignTalk::failed(const calibrate::FailedJob& job) {
  complain(fmt::format("failed: {}: {}", job.record, job.error));
  if (!job.skipped.empty())
    complain(
        fmt::format("skipped, because they start from {}: {}", job.record, fmt::join(job.skipped, ", ")));
  lost_ += 1 + job.skipped.size();
  sum_up();
}

calibrate::CampaignHooks CampaignTalk::hooks(const std::atomic<bool>& stop) {
  calibrate::CampaignHooks hooks;
  hooks.progress = [this](const auto& progress) { show(progress); };
  hooks.finished = [this](const auto& job, const auto& progress) { finished(job, progress); };
  hooks.failed = [this](const auto& job) { failed(job); };
  hooks.stop = &stop;
  return hooks;
}

}  // namespace grainlaw::apps
