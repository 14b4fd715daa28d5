// The sections of the report, each a function of what was read from disk.
#pragma once

#include "grainlaw/apps/report/fit_view.hpp"
#include "grainlaw/apps/report/html.hpp"
#include "grainlaw/apps/report/inputs.hpp"

namespace grainlaw::report {

/// The campaign in a paragraph, and a table of its tests.
Markup what_was_run(const Inputs& inputs);
/// What came out: physics checks, parameters beside the thesis's, where every number comes from.
Markup headline(const Inputs& inputs, const std::vector<FitView>& fits);
/// Each fit with its data and curve, then residual, condition and exit.
Markup fits_section(const Inputs& inputs, const std::vector<FitView>& fits);
/// Predictions of tests that no fit behind them has seen, over the DEM's points.
Markup predictions_section(const Inputs& inputs);
/// Where the time went.
Markup time_section(const Inputs& inputs);
/// Versions, commits, compilers, and what the runs warned of.
Markup provenance_section(const Inputs& inputs);
/// A warning where records come from another build than this program, or from several instruction sets.
Markup other_builds(const Inputs& inputs);
/// "0.1.0, commit abc1234".
std::string build_name(const std::string& version, const std::string& commit);
/// Every symbol and word in one line.
Markup glossary_section();

/// One figure per quantity of the isotropic laws: all modes together, residuals beside them.
Markup isotropic_figures(const Inputs& inputs, const std::vector<FitView>& fits);
/// s_dev and F_dev over strain, a panel per test.
Markup shear_run_figures(const Inputs& inputs, const std::vector<FitView>& fits);
/// Q(nu) of the four saturation quantities.
Markup saturation_figure(const std::vector<FitView>& fits);
/// The moduli of states along D2, a panel per law; nothing where there are none.
Markup moduli_figures(const Inputs& inputs, const std::vector<FitView>& fits);
/// The jamming density over cycles and amplitudes of over-compression, and the strains that jam: the figures
/// of chapter 5; nothing where there are none.
Markup memory_figures(const std::vector<FitView>& fits);
/// The phase diagram of packings at rest along shear, their stresses, and what shear to and fro does to the
/// jamming density; nothing where no test has any.
Markup memory_states_figure(const Inputs& inputs, const std::vector<FitView>& fits);
/// Fig. 5.4: cycles of compression and of shear by the minimal form; nothing where no prediction has them.
Markup minimal_figure(const Inputs& inputs);
/// Fits of any other kind, one figure each.
Markup other_figures(const std::vector<FitView>& fits);

/// The parameters beside the thesis's.
Markup parameter_tables(const Inputs& inputs, const std::vector<FitView>& fits);

/// A warning where predictions.json was made with another parameter set than parameters.json holds.
Markup outdated_predictions(const Inputs& inputs);

/// A paragraph that says why there is nothing to show.
Markup absent(const std::string& what);

}  // namespace grainlaw::report
