#include "grainlaw/apps/bench_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include "grainlaw/apps/bench_model_terms.hpp"
#include "grainlaw/model/light/light_batch.hpp"
#include "grainlaw/model/light/light_law.hpp"
#include "grainlaw/model/walk/point.hpp"

namespace grainlaw::apps {

namespace {

using namespace model;

/// P*, sigma*_dev, F_dev at the samples of a path.
using Trace = std::vector<std::array<double, 3>>;

std::array<double, 3> seen(const State& s) { return {s.P, s.sigma_dev, s.F_dev}; }

/// A path: its start, its legs (eps_vol, eps_dev), how many increments each leg has where it is cut into
/// some, and how many samples where it is not.
struct Course {
  std::string name;
  double nu;
  std::vector<std::array<double, 2>> legs;
  int increments, samples;
};

std::vector<Course> courses() {
  std::vector<std::array<double, 2>> cycles{{0, 0.05}};
  for (int i = 0; i < 100; ++i) cycles.insert(cycles.end(), {{0, -0.1}, {0, 0.1}});
  const double v = std::log(0.70 / 0.66);
  return {{"monotonic", 0.711, {{0, 0.4}}, 4000, 100},
          {"cycles", 0.711, std::move(cycles), 1000, 20},
          {"jamming", 0.66, {{v, v}, {-v, -v}, {v, v}}, 588, 100}};
}

/// The D2 cycle of Fig. 4.14 in 20000 increments of 1e-4.
Course figure_4_14() { return {"D2 cycle", 0.711, {{0, 0.4}, {0, -0.8}, {0, 0.8}}, 0, 100}; }

State start_of(const Law& law, double nu) {
  State state;
  state.nu = nu;
  state.phi_J = jamming_density(laws_of(law).pressure);
  state.P = pressure(laws_of(law).pressure, nu);
  state.jammed = state.P > smallest_pressure && nu > unjamming_density(law);
  if (!state.jammed) state.P = 0;
  return state;
}

/// Whoever can take a state along: CVODE, or the light path.
struct Walker {
  std::string name;
  std::function<void(const State&)> start;
  /// A whole leg with samples; appends to the trace.
  std::function<void(double v, double e, const std::vector<double>& fractions, Trace&)> leg;
  std::function<const State&(double v, double e)> increment;
};

Walker by_cvode(const Law& law, Tolerance tolerance, Method method) {
  const auto point = std::make_shared<std::optional<MaterialPoint>>();
  return {method == Method::bdf ? "CVODE BDF" : "CVODE Adams",
          [=](const State& state) { point->emplace(law, state, tolerance, method); },
          [=](double v, double e, const std::vector<double>& fractions, Trace& trace) {
            check((*point)->walk(v, e, fractions,
                                 [&](std::size_t, const State& s) { trace.push_back(seen(s)); }));
          },
          [=](double v, double e) -> const State& {
            check((*point)->walk(v, e));
            return (*point)->state();
          }};
}

Walker by_light(const Law& law, Tolerance tolerance, LightMethod method) {
  static constexpr const char* names[] = {"light", "Bogacki-Shampine", "Dormand-Prince", "RODAS"};
  struct Point {
    LightLaw law;
    State state{};
    LightCache cache{};
  };
  const auto point = std::make_shared<Point>(Point{LightLaw(law, tolerance, method)});
  return {names[static_cast<int>(method)], [=](const State& state) { point->state = state; },
          [=](double v, double e, const std::vector<double>& fractions, Trace& trace) {
            check(point->law.walk(point->state, v, e, fractions,
                                  [&](std::size_t, const State& s) { trace.push_back(seen(s)); }));
          },
          [=](double v, double e) -> const State& {
            check(point->law.update(point->state, v, e, &point->cache));
            return point->state;
          }};
}

std::vector<Walker> walkers(const Law& law, double rtol) {
  const Tolerance tolerance{rtol, 1e-3 * rtol};
  std::vector<Walker> all{by_cvode(law, tolerance, Method::bdf), by_cvode(law, tolerance, Method::adams)};
  for (const LightMethod method : {LightMethod::automatic, LightMethod::explicit_third,
                                   LightMethod::explicit_fifth, LightMethod::rosenbrock})
    all.push_back(by_light(law, tolerance, method));
  return all;
}

Trace along(const Course& course, const Law& law, const Walker& walker) {
  std::vector<double> fractions;
  for (int i = 1; i <= course.samples; ++i) fractions.push_back(static_cast<double>(i) / course.samples);
  Trace trace;
  trace.reserve(course.legs.size() * fractions.size());
  walker.start(start_of(law, course.nu));
  for (const auto& [v, e] : course.legs) walker.leg(v, e, fractions, trace);
  return trace;
}

/// The same in increments; the trace has the samples of `along`, if increments divide by them.
Trace in_increments(const Course& course, const Law& law, const Walker& walker) {
  Trace trace;
  walker.start(start_of(law, course.nu));
  for (const auto& [v, e] : course.legs) {
    const int count =
        course.increments > 0 ? course.increments : static_cast<int>(std::lround(std::abs(e) / 1e-4));
    for (int i = 1; i <= count; ++i) {
      const State& state = walker.increment(v / count, e / count);
      if (i * course.samples % count == 0) trace.push_back(seen(state));
    }
  }
  return trace;
}

double error_of(const Trace& trace, const Trace& reference) {
  double worst = 0;
  for (std::size_t j = 0; j < 3; ++j) {
    double error = 0, size = 0;
    for (std::size_t i = 0; i < reference.size(); ++i) {
      error += std::pow(trace.at(i)[j] - reference[i][j], 2);
      size += std::pow(reference[i][j], 2);
    }
    worst = std::max(worst, std::sqrt(error / size));
  }
  return worst;
}

/// Of a batch, after the one that begins its direction.
constexpr int batch_increments = 100;

std::size_t increments_of(const Course& course) {
  std::size_t count = 0;
  for (const auto& leg : course.legs)
    count += course.increments > 0 ? static_cast<std::size_t>(course.increments)
                                   : static_cast<std::size_t>(std::lround(std::abs(leg[1]) / 1e-4));
  return count;
}

class Timing {
 public:
  Timing(const ParameterSet& parameters, const ModelBench& bench,
         const std::function<void(const ModelTiming&, double)>& told)
      : parameters_(parameters), bench_(bench), told_(told), law_(make_law(parameters, Form::coupled)) {
    planned_ = bench.tolerances.size() * (4 * 6) + bench.batches.size() * (bench.threads > 1 ? 6 : 3) + 16;
  }

  std::vector<ModelTiming> run() {
    for (const Course& course : courses()) time_course(course, "path");
    time_course(figure_4_14(), "increment");
    for (const std::size_t points : bench_.batches) time_batches(points);
    time_terms(parameters_, bench_.seconds, [this](const ModelTiming& timing) { line(timing); });
    time_hosts(parameters_, bench_, [this](const ModelTiming& timing) { line(timing); });
    return lines_;
  }

 private:
  void line(ModelTiming timing) {
    lines_.push_back(std::move(timing));
    told_(lines_.back(), std::min(1.0, static_cast<double>(lines_.size()) / static_cast<double>(planned_)));
  }

  /// The reference of one kind of method is the other kind's.
  void time_course(const Course& course, const std::string& kind) {
    const Tolerance tight{1e-12, 1e-15};
    const Trace cvode = along(course, law_, by_cvode(law_, tight, Method::bdf)),
                light = along(course, law_, by_light(law_, tight, LightMethod::explicit_fifth));
    const auto& follow = kind == "path" ? along : in_increments;
    const double per = kind == "path" ? 1 : static_cast<double>(increments_of(course));
    for (const double rtol : bench_.tolerances)
      for (const Walker& walker : walkers(law_, rtol)) {
        Trace trace;
        const double ns = fastest(bench_.seconds, [&] { trace = follow(course, law_, walker); });
        const bool own = walker.name.starts_with("CVODE");
        line({kind, course.name, walker.name, rtol, 1, 1, ns / per, error_of(trace, own ? light : cvode)});
      }
  }

  void time_batches(std::size_t points) {
    const LightLaw light(law_, {1e-6, 1e-9});
    const std::vector<double> shear(points, 1e-4);
    for (const double volume : {0.0, 1e-5})
      for (int threads = 1; threads <= bench_.threads;
           threads = threads == bench_.threads ? threads + 1 : bench_.threads) {
        const std::vector<double> volumes(points, volume);
        LightBatch batch(light, points, start_of(law_, 0.711));
        const double each =
            fastest_of(
                bench_.seconds,
                [&] {
                  for (std::size_t i = 0; i < points; ++i) batch.set_state(i, start_of(law_, 0.711));
                  check(batch.update(volumes, shear, threads).status);  // begins the direction
                },
                [&] {
                  for (int i = 0; i < batch_increments; ++i)
                    check(batch.update(volumes, shear, threads).status);
                }) /
            batch_increments / static_cast<double>(points);
        line({"batch", volume == 0 ? "at rest" : "moving", "light", 1e-6, points, threads, each, 0});
      }
  }

  const ParameterSet& parameters_;
  const ModelBench& bench_;
  const std::function<void(const ModelTiming&, double)>& told_;
  Law law_;
  std::vector<ModelTiming> lines_;
  std::size_t planned_ = 1;
};

}  // namespace

std::vector<ModelTiming> time_model(const ParameterSet& parameters, const ModelBench& bench,
                                    const std::function<void(const ModelTiming&, double done)>& told) {
  return Timing(parameters, bench, told).run();
}

std::string to_csv(const std::vector<ModelTiming>& timings) {
  std::string csv = "kind,path,method,rtol,points,threads,ns,error\n";
  for (const ModelTiming& t : timings)
    csv += fmt::format("{},\"{}\",{},{},{},{},{:.5g},{:.4g}\n", t.kind, t.path, t.method, t.rtol, t.points,
                       t.threads, t.ns, t.error);
  return csv;
}

}  // namespace grainlaw::apps
