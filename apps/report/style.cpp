#include "grainlaw/apps/report/style.hpp"

namespace grainlaw::report {

const char* const style_sheet = R"css(
:root { color-scheme: light dark; --ink: #1b1f24; --soft: #5b636e; --line: #d5d9df; --paper: #ffffff; --shade: #f4f6f8;
  --link: #0060a0; --good: #00734f; --off: #8a5a00; --bad: #b03a00; }
@media (prefers-color-scheme: dark) { :root { --ink: #e4e7eb; --soft: #a0a8b3; --line: #3a4049; --paper: #15181c;
  --shade: #1e2329; --link: #6bb8f0; --good: #4cc79c; --off: #e3b04b; --bad: #ff9566; } }
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; }
body { margin: 0 auto; padding: 2rem 1.25rem 4rem; max-width: 1080px; background: var(--paper); color: var(--ink);
  font: 15px/1.5 system-ui, -apple-system, "Segoe UI", "Noto Sans", "DejaVu Sans", sans-serif; }
h1 { font-size: 1.9rem; line-height: 1.2; margin: 0 0 .3rem; }
h2 { font-size: 1.4rem; line-height: 1.25; margin: 3rem 0 .8rem; padding-top: .8rem; border-top: 2px solid var(--line); }
h3 { font-size: 1.05rem; margin: 1.8rem 0 .5rem; }
p { margin: .5rem 0; max-width: 75ch; }
a { color: var(--link); }
code { font-size: .92em; }
var { font-style: italic; }
sub, sup { font-size: .75em; line-height: 0; }
nav { color: var(--soft); margin: .8rem 0; }
nav a { white-space: nowrap; margin-right: 1.1em; }
ul { padding-left: 1.3rem; margin: .5rem 0; }
.lead, .note, figcaption, .absent { color: var(--soft); }
.note, figcaption { font-size: .87rem; }
figcaption { max-width: 90ch; margin-top: .3rem; }
figcaption b { color: var(--ink); }
.absent { border-left: 3px solid var(--line); padding-left: .8rem; }
.gaps { border: 1px solid var(--line); border-left: 4px solid var(--off); background: var(--shade); padding: .4rem 1rem;
  margin: 1.2rem 0; }
.scroll { overflow-x: auto; margin: .6rem 0; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { text-align: left; padding: .28rem .8rem .28rem 0; vertical-align: top; border-bottom: 1px solid var(--line); }
th { font-weight: 600; vertical-align: bottom; }
th.n, td.n { text-align: right; }
td.n, table.small td:first-child { white-space: nowrap; }
.long { min-width: 11rem; }
.quiet { color: var(--soft); }
thead th { border-bottom: 2px solid var(--line); }
tr.group th { padding-top: .9rem; color: var(--soft); }
table.small { font-size: .84rem; line-height: 1.4; }
table.matrix td, table.matrix th { padding-right: 1.8rem; }
.under { font-size: .82rem; font-weight: 400; color: var(--soft); }
.whole, .near { white-space: nowrap; }
.good { color: var(--good); font-weight: 600; white-space: nowrap; }
.off { color: var(--off); font-weight: 600; white-space: nowrap; }
.far, .bad { color: var(--bad); font-weight: 600; }
.far { white-space: nowrap; text-decoration: underline; text-underline-offset: .15em; }
figure { margin: 1.2rem 0 1.8rem; }
.legend { display: flex; flex-wrap: wrap; gap: .15rem 1.3rem; font-size: .84rem; margin-bottom: .4rem; }
.legend span { white-space: nowrap; }
.swatch { width: 28px; height: 12px; margin-right: .45em; vertical-align: -1px; fill: none; }
.plot { display: block; width: 100%; height: auto; color: var(--ink); }
.plot text { font-family: system-ui, -apple-system, "Segoe UI", "Noto Sans", "DejaVu Sans", sans-serif; }
.plot .gridline { stroke: currentColor; stroke-opacity: .13; stroke-dasharray: none; }
.plot .dots { stroke-opacity: .75; }
.bar { width: 320px; max-width: 40vw; height: .75em; margin-top: .32em; }
.bar div { height: 100%; min-width: 1px; }
@media print {
  :root { --ink: #000; --soft: #444; --line: #bbb; --paper: #fff; --shade: #fff; --link: #000; --good: #00573c; --off: #6b4600;
    --bad: #8f2f00; }
  body { max-width: none; padding: 0; font-size: 10pt; }
  nav { display: none; }
  h2, h3 { break-after: avoid; }
  figure, tr { break-inside: avoid; }
  .scroll { overflow: visible; }
  .bar div { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
}
)css";

}  // namespace grainlaw::report
