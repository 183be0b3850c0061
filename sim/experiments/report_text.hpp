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
    "<ul><li>Most of the gain is the tracker's, which is part of Penumbra: it was given to every "
    "method whose idea allows one. Without it (no handling; height threshold, silhouette "
    "subtraction and URDF filter as they are) the last estimate grows old while the belt moves "
    "on. The object's own model and the second camera work from a tracked pose: they have no other "
    "form.</li>"
    "<li>Here the robot stands before the belt only, so that silhouette subtraction and URDF "
    "filter take away nearly the same.</li>"
    "<li>SIFT features are not found on the arm, so that RANSAC is robust to it by itself. With a "
    "careful estimator (ten inliers at least, a covariance) every method with a tracker is alike, "
    "and "
    "one that goes on estimating from what is still seen can be a little better than Penumbra, "
    "which "
    "predicts from 5 % hidden on. Whoever has such an estimator lets the tracker take partial "
    "verdicts: 'Penumbra, partial'.</li>"
    "<li>Errors count frames with a known pose only: read them beside the time without one.</li>"
    "<li>With an eager estimator (any four matches that agree, no covariance) the verdict is what "
    "keeps wrong poses out.</li>"
    "<li>A pose that is off although nothing hides the object is the estimator's own fault; no "
    "verdict refuses it, and the tracker's gate only if it is far off.</li>"
    "<li>Prediction is as good as the motion model: the belt's direction is known, its speed "
    "wanders "
    "by 2 %. After seconds of hiding, or on a belt that stops, it is wrong, and says so by its "
    "growing covariance.</li>"
    "<li>The height threshold and the second camera are given the exact height of belt and object; "
    "the object's own model is given its exact size.</li>"
    "<li>Simulated images without motion blur, a simulated detector, one flat textured object: the "
    "figures tell methods apart; they do not foretell those of another cell.</li></ul>";
inline constexpr const char* handover_limits =
    "<ul><li>While the wrist is hidden nobody measures it: methods that hold its last position are "
    "wrong by what it moved meanwhile, all alike. What tells them apart is what they believe "
    "instead, "
    "and what they throw away.</li>"
    "<li>Silhouette subtraction refuses every key point on the robot's silhouette, a hand before "
    "the arm too. The URDF filter looks at the depth and keeps that hand, and of depths nearer "
    "than "
    "5 cm before the robot nothing. Here, with our tracker, it is nearly as good as Penumbra, "
    "which "
    "refuses a few visible hands by its verdict or for want of trusted depths.</li>"
    "<li>'On the robot's body': the surface that was measured lies within 3 cm of the robot's true "
    "surface and nearer to it than to the wrist's true one, however far off the position is. A "
    "position measured elsewhere, and wrong, counts as off by > 10 cm only.</li>"
    "<li>Errors count frames with a known position only: read them beside the time without "
    "one.</li>"
    "<li>A second camera that sees the wrist from the other side goes on measuring it, and is "
    "better "
    "than anything that holds. It works from the held position, as the hand's own model does: both "
    "fail where the hand moves further than they allow for, and at the start.</li>"
    "<li>The height threshold is given the wrist's true height at every instant, which no real "
    "system "
    "knows.</li>"
    "<li>Penumbra holds from 5 % hidden on, although part of the key point may still be measured; "
    "'Penumbra, partial' uses that part.</li>"
    "<li>Errors while the hand moves are mostly latency (50 to 300 ms): a held position does not "
    "predict. Key points are simulated, with noise but without gross errors.</li></ul>";
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
