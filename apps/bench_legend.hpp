// A picture of a bench as an SVG file of its own: the drawing with a legend above the panels.
#pragma once

#include <string>

#include "grainlaw/apps/report/figure.hpp"

namespace grainlaw::apps {

/// `note` stands behind the last entry.
std::string drawn_with_legend(report::Figure figure, const std::string& note);

}  // namespace grainlaw::apps
