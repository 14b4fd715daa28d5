#include "grainlaw/calibrate/campaign_origins.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "grainlaw/element/error.hpp"

namespace grainlaw::calibrate {

namespace {

/// States of one segment must be further apart, or a snapshot could be taken for its neighbour.
constexpr double nearest_states = 2e-4;
/// A volume fraction this near to a segment's end is its end.
constexpr double same_nu = 1e-9;

std::string quoted(const std::string& name) { return '"' + name + '"'; }

/// The volume fractions that a test's path runs through: known up to its first segment under stress control.
class Passage {
 public:
  explicit Passage(const CampaignTest& test) {
    for (const Leg& leg : test.path.nominal_legs(test.nu_start, test.nu_known))
      ends_.push_back({test.nu_start * std::exp(leg.eps_vol[0]), test.nu_start * std::exp(leg.eps_vol[1])});
    const auto& segments = test.path.segments;
    const auto servo = std::find_if(segments.begin(), segments.end(),
                                    [](const Segment& segment) { return segment.control.by_stress(); });
    known_ = test.nu_known ? static_cast<std::size_t>(servo - segments.begin()) : 0;
  }

  std::size_t segments() const { return ends_.size(); }
  bool known(std::size_t segment) const { return segment < known_; }
  double begin(std::size_t segment) const { return ends_[segment][0]; }
  double end(std::size_t segment) const { return ends_[segment][1]; }
  bool passes(std::size_t segment, double nu) const {
    const auto [low, high] =
        std::minmax({begin(segment), end(segment)});  // by value: the ends are temporaries
    return known(segment) && nu >= low - same_nu && nu <= high + same_nu;
  }
  /// The last segment that is known to pass nu; the first one if none is.
  std::size_t last_through(double nu) const {
    std::size_t segment = segments() - 1;
    while (segment > 0 && !passes(segment, nu)) --segment;
    return segment;
  }
  /// "0.64 to 0.82", of one segment or of all that are known.
  std::string range(std::optional<std::int64_t> segment) const {
    double low = 1, high = 0;
    for (std::size_t i = 0; i < segments(); ++i) {
      if (!known(i) || (segment && static_cast<std::size_t>(*segment) != i)) continue;
      low = std::min({low, begin(i), end(i)});
      high = std::max({high, begin(i), end(i)});
    }
    const auto rounded = [](double x) { return to_text(std::round(x * 1e6) / 1e6); };
    return rounded(low) + " to " + rounded(high);
  }

 private:
  std::vector<std::array<double, 2>> ends_;
  std::size_t known_ = 0;
};

/// Looks up origins, producers before those that start from them.
class Origins {
 public:
  Origins(Campaign& campaign, const std::vector<WrittenTest>& written)
      : campaign_(campaign), written_(written) {
    for (std::size_t i = 0; i < written.size(); ++i)
      if (const auto& test = written[i].test; !index_.emplace(test.name, i).second)
        fail(test, "name", "is taken by another test, got " + quoted(test.name));
  }

  void resolve(std::size_t i) {
    if (done_.contains(i)) return;
    CampaignTest& test = campaign_.tests[i];
    if (!open_.insert(i).second) fail(test, "from.test", "goes round in a circle: " + circle(i));
    test.nu_start = campaign_.preparation.nu;
    if (const auto& from = written_[i].from) {
      const std::size_t producer = find(test, *from);
      resolve(producer);
      locate(test, *from, campaign_.tests[producer]);
    }
    check_targets(test);
    done_.insert(i);
  }

 private:
  [[noreturn]] void fail(const CampaignTest& test, const std::string& key, const std::string& message) const {
    throw Error(campaign_.file, test.key + "." + key, message);
  }

  std::size_t find(const CampaignTest& test, const WrittenOrigin& from) const {
    const auto found = index_.find(from.test);
    if (found == index_.end()) {
      std::string several;
      for (const auto& other : written_)
        if (other.from && other.from->list && other.test.name.starts_with(from.test + "-"))
          several += (several.empty() ? "" : ", ") + other.test.name;
      if (!several.empty())
        fail(test, "from.test", quoted(from.test) + " stands for several tests; name one of " + several);
      fail(test, "from.test", "must be the name of a test, got " + quoted(from.test));
    }
    const auto& seeds = written_[found->second].test.seeds;
    for (const auto seed : test.seeds)
      if (std::find(seeds.begin(), seeds.end(), seed) == seeds.end())
        fail(test, "seeds",
             "must be some of the seeds of " + quoted(from.test) + ", where it starts, got " +
                 std::to_string(seed));
    return found->second;
  }

  std::string circle(std::size_t i) const {
    std::string text = written_[i].test.name;
    for (std::size_t at = index_.at(written_[i].from->test); at != i; at = index_.at(written_[at].from->test))
      text += " from " + written_[at].test.name;
    return text + " from " + written_[i].test.name;
  }

  /// Sets the state that `from` means on the path of `producer`.
  void locate(CampaignTest& test, const WrittenOrigin& from, const CampaignTest& producer) const {
    const Passage passage(producer);
    if (from.segment && static_cast<std::size_t>(*from.segment) >= passage.segments())
      fail(test, "from.segment",
           "must be less than " + std::to_string(passage.segments()) + ", the number of segments of " +
               quoted(producer.name) + ", got " + std::to_string(*from.segment));
    std::size_t segment = passage.segments() - 1;
    if (from.segment) segment = static_cast<std::size_t>(*from.segment);
    test.from = Origin{producer.name, segment, std::nullopt};
    test.nu_start = passage.end(segment);
    test.nu_known = passage.known(segment);
    if (from.nu.empty()) return;
    const double nu = from.nu.front();
    // Without `segment`, the last one that passes this state: the unloading branch of an isotropic test.
    if (!from.segment) segment = passage.last_through(nu);
    if (!passage.known(segment))
      fail(test, "from.nu",
           "must be left out, got " + to_text(nu) + ": how dense the grains are in segment " +
               std::to_string(segment) + " of " + quoted(producer.name) +
               " is known only when a servo has strained them; without nu the test starts from its end");
    if (!passage.passes(segment, nu))
      fail(test, "from.nu",
           "must be a volume fraction that " + quoted(producer.name) + " passes" +
               (from.segment ? " in segment " + std::to_string(segment) : "") + ", " +
               passage.range(from.segment) + ", got " + to_text(nu));
    test.nu_start = nu;
    test.nu_known = true;
    const bool at_end = std::abs(nu - passage.end(segment)) <= same_nu;
    const bool at_begin = !at_end && std::abs(nu - passage.begin(segment)) <= same_nu;
    if (at_begin && segment == 0)
      fail(test, "from.nu",
           "is where " + quoted(producer.name) +
               " itself starts; start from the same state as it does, got " + to_text(nu));
    if (at_begin) --segment;  // the end of the segment before
    test.from->segment = segment;
    if (!at_end && !at_begin) test.from->nu = nu;
  }

  /// Targets that are out of reach, snapshots that are not on the path; a path that starts where a servo has
  /// led is checked when it begins.
  void check_targets(const CampaignTest& test) const {
    const std::size_t count = test.path.nominal_legs(test.nu_start, test.nu_known).size();
    const auto check = [&](const std::string& list, const std::vector<dem::StateRequest>& requests) {
      for (std::size_t i = 0; i < requests.size(); ++i)
        if (requests[i].segment >= count)
          fail(test, "measure." + list + "[" + std::to_string(i) + "].segment",
               "must be less than " + std::to_string(count) + ", the number of segments, got " +
                   std::to_string(requests[i].segment));
    };
    check("snapshots", test.measure.snapshots);
    check("moduli", test.measure.moduli);
    if (!test.nu_known) return;
    try {
      dem::Scene{campaign_.material, campaign_.preparation, test.path, test.measure, ""}.legs(test.nu_start);
    } catch (const Error& error) {
      fail(test, error.key(), error.what() + error.key().size() + 2);  // the scene names its own keys only
    }
  }

  Campaign& campaign_;
  const std::vector<WrittenTest>& written_;
  std::map<std::string, std::size_t, std::less<>> index_;
  std::set<std::size_t> open_, done_;
};

/// States so near to each other that a snapshot could be taken for its neighbour.
void check_states_apart(const Campaign& campaign) {
  std::map<std::pair<std::string, std::size_t>, std::map<double, const CampaignTest*>> states;
  for (const auto& test : campaign.tests) {
    if (!test.from || !test.from->nu) continue;
    auto& neighbours = states[{test.from->test, test.from->segment}];
    const double nu = *test.from->nu;
    const auto near = neighbours.upper_bound(nu - nearest_states);
    if (near != neighbours.end() && near->first < nu + nearest_states && near->first != nu)
      throw Error(campaign.file, test.key + ".from.nu",
                  "must be the same as or " + to_text(nearest_states) + " away from " + to_text(near->first) +
                      ", where " + quoted(near->second->name) + " starts, got " + to_text(nu));
    neighbours.emplace(nu, &test);
  }
}

}  // namespace

void resolve_origins(Campaign& campaign, const std::vector<WrittenTest>& written) {
  for (const auto& one : written) campaign.tests.push_back(one.test);
  Origins origins(campaign, written);
  for (std::size_t i = 0; i < written.size(); ++i) origins.resolve(i);
  check_states_apart(campaign);
}

}  // namespace grainlaw::calibrate
