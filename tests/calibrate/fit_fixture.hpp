// A campaign's output directory whose records follow the thesis's laws exactly, for the tests of fits and
// predictions.
#pragma once

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "grainlaw/calibrate/campaign.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/file.hpp"
#include "grainlaw/element/path.hpp"
#include "grainlaw/element/record.hpp"
#include "grainlaw/element/tensor.hpp"
#include "grainlaw/model/laws/packing_laws.hpp"
#include "grainlaw/model/laws/saturation.hpp"
#include "grainlaw/model/parameters.hpp"

namespace grainlaw::calibrate {

inline std::filesystem::path thesis_file() {
  return std::filesystem::path(GRAINLAW_DATA_DIR) / "thesis" / "parameters.json";
}

/// A directory of its own, gone with the object.
class Scratch {
 public:
  Scratch() {
    std::string text = (std::filesystem::temp_directory_path() / "grainlaw-fit-XXXXXX").string();
    if (mkdtemp(text.data()) == nullptr) throw std::runtime_error("no scratch directory");
    dir_ = text;
  }
  ~Scratch() { std::filesystem::remove_all(dir_); }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  const std::filesystem::path& dir() const { return dir_; }

 private:
  std::filesystem::path dir_;
};

/// One state of a record; what is left out is an empty field.
struct Row {
  double segment, eps_vol, eps_dev, nu, P = 0, s_dev = std::numeric_limits<double>::quiet_NaN(), F_dev = 0;
  double C = 0, C_star = std::numeric_limits<double>::quiet_NaN(), f_NR = 0;
};

/// Records that obey Tables 2.1 and 2.2 of the thesis to rounding.
class ThesisRecords {
 public:
  ThesisRecords() : set_(model::ParameterSet::load(thesis_file())) {}
  const model::ParameterSet& set() const { return set_; }

  /// Packing of a mode's row of Table 2.1 at nu.
  Row packed(const std::string& mode, double nu) const {
    const model::PressureCurve laws = set_.isotropic.at(mode).pressure();
    Row row{0, 0, 0, nu};
    row.P = model::pressure(laws, nu);
    if (row.P == 0) return row;
    row.C = model::coordination(laws.contacts, nu);
    row.C_star = model::corrected_coordination(laws.contacts, nu);
    row.f_NR = 1 - model::rattlers(laws.contacts, nu);
    row.s_dev = 0;
    return row;
  }

  /// iso or uni from 0.64 to 0.82 and back; loading and unloading obey the same law here.
  std::vector<Row> cycle(const std::string& mode, int rows = 80) const {
    std::vector<Row> out;
    const double total = std::log(0.82 / 0.64);
    for (int leg = 0; leg < 2; ++leg) {
      for (int i = leg == 0 ? 0 : 1; i <= rows; ++i) {
        const double done = total * i / rows, eps_vol = leg == 0 ? done : total - done;
        Row row = packed(mode, 0.64 * std::exp(eps_vol));
        row.segment = leg;
        row.eps_vol = eps_vol;
        row.eps_dev = mode == "uni" ? eps_vol : 0;
        out.push_back(row);
      }
    }
    return out;
  }

  /// d2 or d3 at nu to eps_dev = 0.4: steady packing, s_dev and F_dev by 2.17, 2.18 and Table 2.2.
  std::vector<Row> shear(const std::string& mode, double nu, int rows = 100) const {
    const model::ShearLaws& laws = *set_.shear;
    const auto at = [&](const std::optional<model::SaturationLaw>& law) {
      return model::saturation(law->values(), nu);
    };
    std::vector<Row> out;
    for (int i = 0; i <= rows; ++i) {
      Row row = packed(mode, nu);
      row.eps_dev = 0.4 * i / rows;
      row.s_dev = model::approach(at(laws.s_max), 0.01, at(laws.beta_s), row.eps_dev);
      row.F_dev = model::approach(at(laws.F_max), 0.01, at(laws.beta_F), row.eps_dev);
      out.push_back(row);
    }
    return out;
  }

 private:
  model::ParameterSet set_;
};

inline std::string path_json(const std::string& mode) {
  if (mode == "d2" || mode == "d3") {
    return R"({"segments": [{"mode": ")" + mode + R"(", "controls": {"eps_dev": 0.4}}]})";
  }
  return R"({"segments": [{"mode": ")" + mode + R"(", "controls": {"nu": 0.82}}, {"mode": ")" + mode +
         R"(", "controls": {"nu": 0.64}}]})";
}

/// Writes the record `dir`/NAME with a scene of this path and material.
inline void write_record(const std::filesystem::path& dir, const std::string& path,
                         const std::vector<Row>& rows, double w = 3) {
  std::filesystem::create_directories(dir);
  write_file(dir / "scene.json", R"({"material": {"w": )" + std::to_string(w) +
                                     R"(}, "preparation": {"count": 1000}, "path": )" + path +
                                     R"(, "measure": {}})");
  Record record({"segment", "eps_vol", "eps_dev", "nu", "P", "sigma_dev", "s_dev", "F_v", "F_dev", "C",
                 "C_star", "f_NR", "phi_J", "Ek_over_Ep"});
  for (const Row& r : rows) {
    record.append({r.segment, r.eps_vol, r.eps_dev, r.nu, r.P, r.s_dev * r.P, r.s_dev, 1.22475 * r.nu * r.C,
                   r.F_dev, r.C, r.C_star, r.f_NR, std::numeric_limits<double>::quiet_NaN(),
                   r.P > 0 ? 1e-6 : 1e3});
  }
  record.write_csv(dir / "record.csv");
}

/// Gives the record `dir` the diagonal components of stress and fabric: those of s_dev and F_dev along the
/// deviator `axis`, and beside it a deviator across, which is none of the mode's but adds to sqrt(3 J2). The
/// columns s_dev and F_dev become that sqrt(3 J2), with the sign of what is along.
inline void add_components(const std::filesystem::path& dir, const StrainTensor& axis,
                           const StrainTensor& across, double size) {
  const Record old = Record::read_csv(dir / "record.csv");
  std::vector<std::string> names = old.columns();
  for (const char* name : {"sxx", "syy", "szz", "Fxx", "Fyy", "Fzz"}) names.emplace_back(name);
  Record record(names);
  for (std::size_t i = 0; i < old.rows(); ++i) {
    std::vector<double> row;
    for (const std::string& name : old.columns()) row.push_back(old[name][i]);
    const double P = old["P"][i], F = old["F_v"][i] / 3;
    const auto component = [&](double along, std::size_t k) { return along * axis[k] + size * across[k]; };
    const double s = old["s_dev"][i], f = old["F_dev"][i];
    for (std::size_t k = 0; k < 3; ++k) row.push_back(P * (1 + component(s, k)));
    for (std::size_t k = 0; k < 3; ++k) row.push_back(F + component(f, k));
    record.append(row);
    const auto rectified = [&](double along) {
      const Sym6 q{component(along, 0), component(along, 1), component(along, 2), 0, 0, 0};
      return std::copysign(deviator_magnitude(q), along);
    };
    record["s_dev"][i] = rectified(s);
    record["F_dev"][i] = rectified(f);
  }
  record.write_csv(dir / "record.csv");
}

inline const std::vector<double> d2_densities{0.675, 0.69, 0.71, 0.74, 0.77, 0.80};

/// A whole campaign: iso and d2 to be fitted; uni and d3 to be predicted. One seed.
inline void write_campaign(const std::filesystem::path& dir, const ThesisRecords& thesis) {
  std::string nu;
  for (const double x : d2_densities) nu += (nu.empty() ? "" : ", ") + to_text(x);
  const std::string campaign = R"({"name": "made", "preparation": {"count": 1000}, "seeds": [1], "tests": [
      {"name": "iso", "role": "fit", "path": )" +
                               path_json("iso") + R"(},
      {"name": "d2", "role": "fit", "from": {"test": "iso", "segment": 1, "nu": [)" +
                               nu + R"(]}, "path": )" + path_json("d2") + R"(},
      {"name": "uni", "role": "predict", "path": )" +
                               path_json("uni") + R"(},
      {"name": "d3", "role": "predict", "from": {"test": "iso", "segment": 1, "nu": [0.7, 0.75]}, "path": )" +
                               path_json("d3") + "}]}";
  std::filesystem::create_directories(dir / "records");
  write_file(dir / "campaign.json",
             Campaign::read(Reader(parse_json(campaign, "c.json"), "c.json")).to_json().dump(1));
  write_record(dir / "records/iso-s1", path_json("iso"), thesis.cycle("iso"));
  for (const double x : d2_densities) {
    write_record(dir / "records" / ("d2-" + to_text(x) + "-s1"), path_json("d2"), thesis.shear("d2", x));
  }
  write_record(dir / "records/uni-s1", path_json("uni"), thesis.cycle("uni"));
  for (const double x : {0.7, 0.75}) {
    write_record(dir / "records" / ("d3-" + to_text(x) + "-s1"), path_json("d3"), thesis.shear("d3", x));
  }
}

/// Changes a file's text.
inline void edit(const std::filesystem::path& file, const std::function<std::string(std::string)>& change) {
  write_file(file, change(read_file(file)));
}

}  // namespace grainlaw::calibrate
