// Turns an SVG file as gnuplot writes it into markup that can stand many times in one page.
#pragma once

#include <string>
#include <vector>

#include "grainlaw/apps/report/html.hpp"

namespace grainlaw::report {

/// The drawing without prolog, ids and fonts: text and axes take the page's colour and font, dots become one
/// path per run, so that no marker definition (the same ids in every file of gnuplot's) is left. `labels`
/// name the plots in the order they were drawn and become tooltips; `description` is what a screen reader
/// says. Throws Error if the text is not what gnuplot's svg terminal writes.
Markup inline_svg(const std::string& file, const std::vector<std::string>& labels,
                  const std::string& description);

}  // namespace grainlaw::report
