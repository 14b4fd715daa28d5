#include "grainlaw/apps/report/prose.hpp"
#include "grainlaw/apps/report/sections.hpp"
#include "grainlaw/apps/report/symbols.hpp"

namespace grainlaw::report {
namespace {

struct Word {
  const char* word;
  const char* meaning;
};

const std::vector<Word>& words() {
  static const std::vector<Word> list{
      {"DEM",
       "Discrete element method: every grain is moved by Newton's law under the forces of its contacts."},
      {"element test",
       "A small periodic box of grains, deformed as a whole: one material point, seen from inside."},
      {"ISO, UNI, D2, D3",
       "Modes of deformation: all directions alike; one direction only; one in, one out, one at rest (plane "
       "pure shear); one "
       "in, two out (axisymmetric pure shear)."},
      {"seed",
       "Number that fixes the random initial packing; runs that differ only in it show the scatter of the "
       "material."},
      {"jamming", "The density at which a packing begins to carry load."},
      {"stress ratio", "Shear stress over pressure, as a friction coefficient; it has no unit."},
      {"reduced law",
       "Stress ratio and anisotropy relax exponentially to saturation values that depend on nu (Eqs. 2.17, "
       "2.18, 2.20)."},
      {"coupled law",
       "Pressure, shear stress and anisotropy change together through four moduli B, A₁, A₂, G (Eq. 4.16)."},
      {"relative error along the path",
       "√(Σ(law − DEM)²) / √(Σ DEM²) over the rows of the test (relative L₂ norm)."},
      {"standard error ±",
       "By how much the value would scatter if the campaign were repeated with other packings."},
      {"σ (difference)", "A difference divided by its standard error; beyond 3 it is hardly chance."},
      {"particle-step", "One grain moved by one time step: the unit of work of a DEM run."},
      {"thesis",
       "N. Kumar, Micro-Macro and jamming transition in granular materials, PhD thesis, University of "
       "Twente, 2014. Equation and "
       "table numbers are its."},
  };
  return list;
}

}  // namespace

Markup glossary_section() {
  Markup html = "<h3>Words</h3>\n"_html;
  Table terms;
  terms.column("Word"_html).column("Meaning"_html);
  for (const Word& entry : words()) terms.row({text(entry.word), prose(entry.meaning)});
  html += terms.html("small");
  for (const SymbolGroup& group : symbol_groups()) {
    html += element("h3", text(group.title)) + "\n"_html;
    Table table;
    table.column("Symbol"_html).column("Unit"_html).column("Name in files"_html).column("Meaning"_html);
    for (const Symbol& entry : group.symbols) {
      const auto dot = entry.key.rfind('.');
      table.row({Markup::trusted(std::string(entry.html)), text(entry.unit),
                 element("code", text(dot == std::string_view::npos ? entry.key : entry.key.substr(dot + 1))),
                 prose(entry.meaning, dot == std::string_view::npos ? "" : entry.key.substr(0, dot))});
    }
    html += table.html("small");
  }
  return html;
}

}  // namespace grainlaw::report
