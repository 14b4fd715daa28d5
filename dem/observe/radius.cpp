#include "grainlaw/dem/observe/radius.hpp"

#include <algorithm>

namespace grainlaw::dem::observe {

namespace {

struct Bin {
  std::uint64_t grains = 0, contacts = 0, bearing = 0, held = 0;
  double overlaps = 0, volume = 0;
  Sym6 fabric{};
};

/// The bin of each radius; all in the first where all are the same.
class Bins {
 public:
  explicit Bins(const Grains& grains)
      : smallest_(grains.smallest_radius()), span_(grains.largest_radius() - smallest_) {}
  std::size_t of(double r) const {
    if (!(span_ > 0)) return 0;
    const double at = (r - smallest_) / span_ * static_cast<double>(Radius::bins);
    return std::min(static_cast<std::size_t>(std::max(at, 0.0)), Radius::bins - 1);
  }

 private:
  double smallest_, span_;
};

std::array<Bin, Radius::bins> sort_into_bins(const View& view) {
  const Grains& grains = view.grains();
  const Bins bins(grains);
  std::array<Bin, Radius::bins> result;
  for (std::size_t i = 0; i < grains.count(); ++i) {
    Bin& bin = result[bins.of(grains.place[i].w)];
    const std::uint32_t contacts = view.network.contacts_of[i];
    ++bin.grains;
    bin.contacts += contacts;
    bin.bearing += contacts >= bearing_contacts ? 1 : 0;
    bin.held += contacts >= bearing_contacts ? contacts : 0;
    bin.volume += sphere_volume(grains.place[i].w);
  }
  for (const Touch& c : view.network.contacts)
    for (const std::uint32_t i : {c.i, c.j}) {
      const double r = grains.place[i].w;
      Bin& bin = result[bins.of(r)];
      bin.overlaps += c.overlap;
      add_dyad(bin.fabric, sphere_volume(r) / (c.distance * c.distance), c.branch);
    }
  return result;
}

}  // namespace

void Radius::tabulate(const View& view,
                      const std::function<void(const std::array<double, 5>&)>& append) const {
  const auto list = sort_into_bins(view);
  const auto over = [](double a, double b) { return b > 0 ? a / b : undefined; };
  for (std::size_t k = 0; k < bins; ++k) {
    const Bin& bin = list[k];
    // V_s/V is the volume fraction.
    const Sym6 fabric = times(over(view.measured.nu, bin.volume), bin.fabric);
    append({(static_cast<double>(k) + 0.5) / static_cast<double>(bins), static_cast<double>(bin.grains),
            over(bin.overlaps, static_cast<double>(bin.contacts)) / view.material.r_mean,
            over(static_cast<double>(bin.held), static_cast<double>(bin.bearing)),
            bin.grains > 0 ? view.sign.signed_deviator(fabric, view.segment) : undefined});
  }
}

}  // namespace grainlaw::dem::observe
