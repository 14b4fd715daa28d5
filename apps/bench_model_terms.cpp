#include "grainlaw/apps/bench_model_terms.hpp"

#include <fmt/format.h>
#include <grainlaw.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "grainlaw/element/error.hpp"
#include "grainlaw/model/light/light_law.hpp"
#include "grainlaw/model/start.hpp"
#include "grainlaw/model/walk/sensitivities.hpp"

namespace grainlaw::apps {

namespace {

using namespace model;

constexpr double nu_start = 0.711;
constexpr Tolerance tolerance{1e-6, 1e-9};

/// The set with numbers for every term.
ParameterSet completed(ParameterSet set) {
  const auto fill = [](std::optional<Parameter>& parameter, double value) {
    if (parameter) return;
    parameter.emplace().value = value;
    parameter->source = "assumed";
  };
  if (set.moduli) {
    ModuliLaws& m = *set.moduli;
    fill(m.a_F, 3.6);
    fill(m.a_s, 0.15);
    fill(m.F_v, 6.5);
  }
  if (set.memory) {
    fill(set.memory->eps_r, 0.145);
    fill(set.memory->hold, 0.4);
    fill(set.memory->pack_rate, 2);
    fill(set.memory->phi_pack, 0.668);
  }
  if (!set.volumetric) {
    set.volumetric.emplace();
    set.volumetric->compression.value = 9;
    set.volumetric->decompression.value = 1;
  }
  if (!set.moduli_table) {
    const std::vector<double> nu{0.68, 0.72, 0.76}, number{0.4, 0.5, 0.6};
    set.moduli_table.emplace().table = {nu, {number, number, number, number, number}};
  }
  return set;
}

StartState begin(const ParameterSet& parameters, const Choice& choice) {
  Path path;
  path.start.nu = nu_start;
  return start_of(parameters, path, choice);
}

class Terms {
 public:
  Terms(const ParameterSet& parameters, double seconds, const TimingSink& told)
      : parameters_(completed(parameters)), seconds_(seconds), told_(told) {}

  void run() {
    for (const char* name : {"coupled", "coupled+constant_F_v", "coupled+moduli_table", "coupled+energy",
                             "coupled+volumetric", "memory"}) {
      if (std::string(name) == "memory" && !parameters_.memory) continue;
      const StartState start = begin(parameters_, choice_of(name));
      const LightLaw light(start.law, tolerance);
      LightCache cache;
      for (const double v : {0.0, 1e-5})
        increments(fmt::format("{}, volume {}", name, v == 0 ? "at rest" : "moving"), start.state,
                   [&](State& s) { check(light.update(s, v, 1e-4, &cache)); });
    }
    const StartState start = begin(parameters_, {});
    const LightLaw light(start.law, tolerance);
    Tangent tangent;
    for (const double v : {0.0, 1e-5})
      increments(fmt::format("coupled, tangent, volume {}", v == 0 ? "at rest" : "moving"), start.state,
                 [&](State& s) { check(light.update(s, v, 1e-4, tangent)); });
    sensitivities();
  }

 private:
  template <class Update>
  void increments(const std::string& name, const State& start, Update update) {
    constexpr int count = 500;
    const double ns = fastest(seconds_, [&] {
      State state = start;
      for (int i = 0; i < count; ++i) update(state);
    });
    told_({"term", name, "light", tolerance.rtol, 1, 1, ns / count, 0});
  }

  void sensitivities() {
    const Path path = Path::read(Reader(
        parse_json(R"({"start": {"nu": 0.711}, "segments": [{"mode": "d2", "controls": {"eps_dev": 0.4}}]})",
                   "bench"),
        "bench"));
    PredictOptions options;
    options.rtol = tolerance.rtol;
    options.atol = tolerance.atol;
    const double plain = fastest(seconds_, [&] { predict(parameters_, path, options); });
    told_({"term", "path, no sensitivities", "CVODE BDF", options.rtol, 1, 1, plain, 0});
    const auto names = names_of_sensitivities(parameters_, path, {Form::coupled, {}});
    const double with = fastest(seconds_, [&] { predict_sensitivities(parameters_, path, names, options); });
    told_({"term", fmt::format("path, {} sensitivities", names.size()), "CVODE BDF", options.rtol, 1, 1, with,
           0});
  }

  ParameterSet parameters_;
  double seconds_;
  const TimingSink& told_;
};

void check_host(int status, const grainlaw_context* context) {
  if (status < 0) throw Error("", "C interface", grainlaw_message(context));
}

/// Points behind the C interface.
class Host {
 public:
  Host(const ParameterSet& parameters, std::size_t count) : count_(count) {
    grainlaw_settings settings = GRAINLAW_SETTINGS;
    grainlaw_axis("d2", settings.axis);
    settings.rtol = tolerance.rtol;
    settings.atol = tolerance.atol;
    char message[256];
    grainlaw_law* law = nullptr;
    if (grainlaw_law_from_text(parameters.to_json().dump().c_str(), &settings, &law, message,
                               sizeof message) < 0)
      throw Error(parameters.file, "C interface", message);
    law_.reset(law);
    grainlaw_context* context = nullptr;
    grainlaw_context_create(law, &context);
    context_.reset(context);
    length_ = grainlaw_state_length(law);
    const char* name = "nu";
    for (std::size_t i = 0; i < count; ++i) {
      std::vector<double> state(length_);
      const double nu = nu_start + 0.01 * static_cast<double>(i) / static_cast<double>(count);
      check_host(grainlaw_start(context, 1, &name, &nu, state.data(), length_), context);
      start_.insert(start_.end(), state.begin(), state.end());
      strains_.insert(strains_.end(), {-5e-5, 5e-5, 0, 0, 0, 0});
    }
    stresses_.resize(6 * count);
    reset();
  }

  void reset() { states_ = start_; }
  void one_by_one() {
    for (std::size_t i = 0; i < count_; ++i)
      check_host(grainlaw_update(context_.get(), &states_[i * length_], length_, &strains_[6 * i],
                                 &stresses_[6 * i], nullptr),
                 context_.get());
  }
  void together(int threads) {
    check_host(grainlaw_update_many(context_.get(), count_, states_.data(), length_, strains_.data(),
                                    stresses_.data(), nullptr, threads, nullptr, nullptr),
               context_.get());
  }

 private:
  struct Destroy {
    void operator()(grainlaw_law* law) const { grainlaw_law_destroy(law); }
    void operator()(grainlaw_context* context) const { grainlaw_context_destroy(context); }
  };
  std::size_t count_, length_ = 0;
  std::unique_ptr<grainlaw_law, Destroy> law_;
  std::unique_ptr<grainlaw_context, Destroy> context_;
  std::vector<double> start_, states_, strains_, stresses_;
};

}  // namespace

void check(const model::Status& status) {
  if (status.failed()) throw Error("", "bench", "the law cannot follow its path: " + status.message);
}

void time_terms(const ParameterSet& parameters, double seconds, const TimingSink& told) {
  Terms(parameters, seconds, told).run();
}

void time_hosts(const ParameterSet& parameters, const ModelBench& bench, const TimingSink& told) {
  constexpr std::size_t count = 512;
  constexpr int increments = 10;
  Host host(parameters, count);
  const auto time = [&](const std::string& name, int threads, auto update) {
    const double ns = fastest_of(
        bench.seconds,
        [&] {
          host.reset();
          update();  // begins the direction
        },
        [&] {
          for (int i = 0; i < increments; ++i) update();
        });
    told({"host", name, "light", tolerance.rtol, count, threads, ns / increments / count, 0});
  };
  time("grainlaw_update", 1, [&] { host.one_by_one(); });
  time("grainlaw_update_many", 1, [&] { host.together(1); });
  if (bench.threads > 1) time("grainlaw_update_many", bench.threads, [&] { host.together(bench.threads); });
}

}  // namespace grainlaw::apps
