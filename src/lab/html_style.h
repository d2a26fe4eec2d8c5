/// How the laboratory's page looks, by day and by night.
#pragma once

namespace alhazen {

inline constexpr const char* html_style = R"(
:root { color-scheme: light dark; --paper: #fdfdfb; --card: #f2f3f1; --ink: #1c2128; --soft: #5b6470; --line: #d5d8d8;
  --batch: #2563a8; --single: #8db8e0; --build: #4d7c4a; --mark: #c2410c; }
@media (prefers-color-scheme: dark) { :root { --paper: #14171b; --card: #1e2329; --ink: #e6e8ea; --soft: #a0a8b2;
  --line: #39404a; --batch: #6cb0f5; --single: #33608c; --build: #84b880; --mark: #fb923c; } }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 84rem; padding: 1.5rem; background: var(--paper); color: var(--ink);
  font: 1rem/1.55 system-ui, sans-serif; }
h1 { font-size: 2rem; margin: 0 0 .3rem; } h2 { margin: 0 0 .6rem; } header p { color: var(--soft); margin-top: 0; }
section { margin: 2.2rem 0; } p, dl { max-width: 62rem; }
dt { font-weight: 600; font-family: ui-monospace, monospace; } dd { margin: 0 0 .7rem 1.5rem; }
.plots { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(34rem, 100%), 1fr)); gap: 1rem; }
.maps { display: grid; gap: .8rem; } .maps figure, .view figure { max-width: 26rem; }
.view { display: flex; flex-wrap: wrap; gap: 1.2rem; margin-bottom: 1rem; } .view p { flex: 1 1 20rem; margin: 0; }
figure { margin: 0; padding: .7rem; background: var(--card); border-radius: .5rem; }
.plots figcaption { font-weight: 600; } .maps figcaption, .view figcaption { text-align: center; font: .85rem/1.3 ui-monospace, monospace; }
figure img { width: 100%; height: auto; display: block; image-rendering: pixelated; margin-bottom: .4rem; }
svg { width: 100%; height: auto; display: block; } svg.legend { max-width: 26rem; margin-bottom: .6rem; }
svg text { fill: var(--ink); font: 11px system-ui, sans-serif; } .label { text-anchor: end; }
svg text.tick { text-anchor: middle; fill: var(--soft); } svg text.end { text-anchor: end; } .grid { stroke: var(--line); stroke-width: 1; }
.mark { stroke: var(--mark); stroke-width: 1.5; stroke-dasharray: 5 3; } svg text.marklabel { fill: var(--mark); }
rect.batch { fill: var(--batch); } rect.single { fill: var(--single); } rect.build { fill: var(--build); }
.key { display: inline-block; width: .9em; height: .7em; border-radius: 2px; }
.key.batch { background: var(--batch); } .key.single { background: var(--single); }
.wide { overflow-x: auto; margin-top: 1rem; } table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { padding: .2rem .8rem; text-align: right; border-bottom: 1px solid var(--line); }
th:first-child { text-align: left; } thead th { color: var(--soft); font-weight: 600; } tbody th { font-weight: 500; }
summary { cursor: pointer; }
)";

} // namespace alhazen
