// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace penumbra::sim {

inline constexpr const char* conveyor_title = "Experiment 1: conveyor pick";
inline constexpr const char* handover_title = "Experiment 2: handover";

inline constexpr const char* conveyor_story =
    "A textured object moves on a conveyor while a robot arm sweeps over it. A pose estimator "
    "(SIFT "
    "features, PnP with RANSAC) follows it in the colour image. What is believed of the object's "
    "pose while the arm hides it, and at the moment of grasp?";
inline constexpr const char* handover_story =
    "A person's hand moves while a robot arm passes between it and the camera, and at times the "
    "hand "
    "is in front of the arm. A pose network's key point is right even where the arm hides the "
    "wrist; "
    "the depth behind it is not. Which positions are believed?";

inline constexpr const char* conveyor_limits =
    "<ul><li>Simulated images, a simulated detector and one kind of textured, flat object: figures "
    "tell the methods apart, they do not foretell those of another cell.</li></ul>";
inline constexpr const char* handover_limits = "<ul><li>Simulated images and key points.</li></ul>";
inline constexpr const char* left_out =
    "<p>A network trained to complete what is hidden (Luo 2021) is left out: it needs a data set "
    "of "
    "its own for each kind of target, and a figure without it would say nothing.</p>";

inline constexpr const char* report_style = R"(
:root{color-scheme:light dark;--ink:#1b1f23;--soft:#57606a;--paper:#fff;--line:#d0d7de;--tint:#e3f4ee;--shade:#d8dee4}
@media(prefers-color-scheme:dark){:root{--ink:#e6edf3;--soft:#9da7b1;--paper:#0f1419;--line:#30363d;--tint:#0f3d30;--shade:#2b323a}}
*{box-sizing:border-box}
body{margin:0;background:var(--paper);color:var(--ink);font:16px/1.5 system-ui,sans-serif}
main{max-width:1120px;margin:0 auto;padding:20px 16px 48px}
h1{font-size:1.7rem;line-height:1.2;margin:.3em 0}
h2{font-size:1.25rem;margin:2em 0 .6em}
.lead{font-size:1.08rem}
p,dd,li{max-width:75ch}
.wide{overflow-x:auto;border:1px solid var(--line);border-radius:6px}
table{border-collapse:collapse;width:100%;min-width:820px;font-variant-numeric:tabular-nums;font-size:.92rem}
th,td{padding:7px 10px;text-align:right;vertical-align:top;border-bottom:1px solid var(--line)}
tbody tr:last-child>*{border-bottom:0}
thead th{font-weight:600;font-size:.8rem;line-height:1.3;vertical-align:bottom;color:var(--soft)}
th:first-child{text-align:left;position:sticky;left:0;background:var(--paper);font-weight:600;min-width:9.5em}
td small{display:block;color:var(--soft);font-size:.76rem;white-space:nowrap}
.ours>*{background:var(--tint)!important}
.swatch{width:28px;height:8px;margin-right:8px;vertical-align:middle}
.pair{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,440px),1fr));gap:18px;margin-top:18px}
.pictures{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,330px),1fr));gap:14px}
figure{margin:0}
figcaption{color:var(--soft);font-size:.88rem;margin-top:4px}
img{width:100%;height:auto;border-radius:6px;display:block}
.plot{width:100%;height:auto;display:block}
.plot text{fill:var(--ink);font-size:13px;font-family:system-ui,sans-serif}
.grid{stroke:var(--line)}.goal{stroke:var(--ink);stroke-dasharray:3 3}.hid{fill:var(--shade)}
dt{font-weight:600;margin-top:.7em}dd{margin-left:36px}
footer{margin-top:3em;color:var(--soft);font-size:.85rem;overflow-wrap:anywhere}
)";

}  // namespace penumbra::sim
