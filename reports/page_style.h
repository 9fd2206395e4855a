#pragma once

#include <string_view>

namespace coppice {

/// The page's style sheet.
inline constexpr std::string_view kPageStyle = R"(
:root { color-scheme: light dark; --ink: #1f2328; --soft: #59636e; --paper: #fff; --line: #d1d9e0;
  --shade: #f6f8fa; --good: #1a7f37; --bad: #cf222e; --open: #9a6700; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e6edf3; --soft: #9198a1; --paper: #0d1117; --line: #3d444d; --shade: #151b23;
    --good: #3fb950; --bad: #f85149; --open: #d29922; }
}
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 2rem 1.25rem 4rem; max-width: 72rem; color: var(--ink);
  background: var(--paper); font: 1rem/1.5 system-ui, "Segoe UI", "Helvetica Neue", Arial, sans-serif; }
h1 { margin: 0; font-size: 1.9rem; }
h2 { margin: 2.5rem 0 .5rem; padding-top: .6rem; border-top: 1px solid var(--line); font-size: 1.3rem; }
h3 { margin: 1.75rem 0 .25rem; font-size: 1.05rem; }
p { margin: .25rem 0 .6rem; max-width: 48rem; }
a { color: inherit; }
small, .soft, figcaption { color: var(--soft); font-size: .85rem; }
figure { margin: 0; overflow-x: auto; }
figcaption { margin-top: .35rem; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { padding: .35rem .8rem; border-bottom: 1px solid var(--line); text-align: left; vertical-align: top; }
thead th { background: var(--shade); border-top: 1px solid var(--line); vertical-align: bottom; }
tbody th { font-weight: 600; }
thead small, td small { display: block; font-weight: 400; white-space: nowrap; }
.number { text-align: right; }
.interval { color: var(--soft); white-space: nowrap; }
.done { color: var(--good); } .failed { color: var(--bad); } .missing { color: var(--open); }
pre { margin: .25rem 0 1rem; padding: .75rem 1rem; overflow-x: auto; background: var(--shade);
  border-left: 3px solid var(--bad); font-size: .85rem; white-space: pre-wrap; overflow-wrap: anywhere; }
details { margin: .5rem 0; }
summary { cursor: pointer; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: .2rem 1.25rem; margin: .5rem 0; }
dt { color: var(--soft); }
dd { margin: 0; overflow-wrap: anywhere; }
@media print {
  :root { color-scheme: light; --ink: #000; --soft: #444; --paper: #fff; --line: #bbb; --shade: #fff; }
  body { padding: 0; max-width: none; font-size: 10pt; }
  h2, h3 { break-after: avoid; }
  tr, pre { break-inside: avoid; }
}
)";

}  // namespace coppice
