// The look of the page: one style sheet for screen, light and dark, and for print.
#pragma once

namespace grainlaw::report {

extern const char* const style_sheet;

}  // namespace grainlaw::report
