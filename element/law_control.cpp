#include "grainlaw/element/law_control.hpp"

#include <algorithm>
#include <array>

#include "grainlaw/element/path_limits.hpp"
#include "grainlaw/element/record.hpp"

namespace grainlaw {

namespace {

constexpr std::array quantities{Quantity::nu, Quantity::eps_vol,   Quantity::eps_dev,
                                Quantity::P,  Quantity::sigma_dev, Quantity::s_dev};

Range range_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::nu:
      return inside(0, 1);
    case Quantity::eps_vol:
    case Quantity::eps_dev:
      return between(-largest_strain, largest_strain);
    case Quantity::P:
      return of_k_star(between(0, largest_stress));
    case Quantity::sigma_dev:
      return of_k_star(between(-largest_stress, largest_stress));
    case Quantity::s_dev:
      break;
  }
  return between(-largest_ratio, largest_ratio);
}

}  // namespace

std::string name_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::nu:
      return "nu";
    case Quantity::eps_vol:
      return "eps_vol";
    case Quantity::eps_dev:
      return "eps_dev";
    case Quantity::P:
      return "P";
    case Quantity::sigma_dev:
      return "sigma_dev";
    case Quantity::s_dev:
      return "s_dev";
  }
  return "";
}

std::vector<LawControl> read_law_controls(Reader reader) {
  std::vector<LawControl> controls;
  for (const Quantity quantity : quantities) {
    const std::string key = name_of(quantity);
    reader.optional({key});
    if (!reader.has(key)) continue;
    if (reader.raw(key).is_string()) {
      reader.word(key, {"start"});
      controls.push_back({quantity, std::nullopt});
    } else {
      controls.push_back({quantity, reader.number(key, range_of(quantity))});
    }
  }
  reader.finish();
  if (controls.size() != 2)
    reader.fail("", "must give one target or two of nu, eps_vol, eps_dev, P, sigma_dev, s_dev, got " +
                        std::to_string(controls.size()));
  if (controls[0].quantity == Quantity::nu && controls[1].quantity == Quantity::eps_vol)
    reader.fail("", "redundant: each of nu and eps_vol fixes the other; give one");
  if (!controls[0].target && !controls[1].target)
    reader.fail("", "has nothing to do: both controls stay as at the start");
  return controls;
}

Json to_json(const std::vector<LawControl>& controls) {
  Json json = Json::object();
  for (const LawControl& control : controls)
    json[name_of(control.quantity)] = control.target ? Json(*control.target) : Json("start");
  return json;
}

Stop read_stop(Reader reader) {
  std::vector<std::string> columns = prediction_columns();
  columns.erase(std::find(columns.begin(), columns.end(), "segment"));
  Stop stop;
  stop.column = reader.word("column", columns);
  reader.optional({"above", "below"});
  if (reader.has("above") == reader.has("below"))
    reader.fail("", reader.has("above") ? "redundant: above and below both say where; give one"
                                        : "must give above or below");
  stop.above = reader.has("above");
  stop.value = reader.number(stop.above ? "above" : "below", between(-largest_ratio, largest_ratio));
  reader.finish();
  return stop;
}

Json to_json(const Stop& stop) {
  return {{"column", stop.column}, {stop.above ? "above" : "below", stop.value}};
}

}  // namespace grainlaw
