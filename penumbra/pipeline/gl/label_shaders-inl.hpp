// SPDX-License-Identifier: Apache-2.0
// The words of LabelRule as compute shaders. Products and sums are rounded one by one (`precise`),
// as the CPU's kernels round them, so that equal virtual depth gives equal labels.
#pragma once

namespace penumbra::gl {

/// Before every shader of this file, after OpenGL's version and the constants of label_passes.cpp:
/// GROUP, LABELS, cell, the marks and the labels. One invocation works on one pixel of `window`,
/// the part of the image in which anything may be labelled or decides about a label.
inline constexpr const char* label_prelude = R"(
layout(local_size_x = GROUP, local_size_y = GROUP) in;
layout(std140, binding = 0) uniform Rule {
  ivec4 window;           // first column and row, last column and row + 1
  ivec4 seen;             // the part of it that holds the robot; virtual_depth is old beside it
  ivec4 cell_window;      // in cells
  ivec2 size;             // of the image
  int millimetres;        // 1: the sensor's depth is in millimetres; 0: in metres
  int min_width;          // front_min_width; 0: no clean-up
  vec4 tolerance_beyond;  // a, b, c, and the factor of beyond; 0: beyond is folded
  uvec2 measured;         // bits of the least and the greatest depth that is a measurement
  int cells;              // that the edge margin reaches; 0: no margin
};

bool is_in(ivec2 p, ivec4 box) {
  return all(greaterThanEqual(p, box.xy)) && all(lessThan(p, box.zw));
}
ivec2 own_pixel() { return window.xy + ivec2(gl_GlobalInvocationID.xy); }
bool in_window(ivec2 p) { return is_in(p, window); }
float tolerance(float z) {
  precise float e = tolerance_beyond.x + (tolerance_beyond.y + tolerance_beyond.z * z) * z;
  return e;
}
)";

inline constexpr const char* robot_prelude = R"(
layout(binding = 0) uniform sampler2D virtual_image;
float virtual_depth(ivec2 p) { return is_in(p, seen) ? texelFetch(virtual_image, p, 0).x : 0.0; }
)";

inline constexpr const char* sensor_prelude = R"(
layout(binding = 1) uniform usampler2D sensor_millimetres;
layout(binding = 2) uniform sampler2D sensor_metres;
float measured_metres(ivec2 p) {
  if (millimetres == 0) return texelFetch(sensor_metres, p, 0).x;
  precise float d = float(texelFetch(sensor_millimetres, p, 0).x) * 0.001;
  return d;
}
// The bits of positive floats are ordered as the floats are, and those of all others come after.
bool is_measurement(float d) {
  uint bits = floatBitsToUint(d);
  return bits >= measured.x && bits <= measured.y;
}
)";

/// Labels by the rule alone, and the marks of front and of unmeasured pixels.
inline constexpr const char* label_shader = R"(
layout(r8ui, binding = 0) uniform writeonly uimage2D labels;
layout(r8ui, binding = 1) uniform writeonly uimage2D marks;
void main() {
  ivec2 p = own_pixel();
  if (!in_window(p)) return;
  float z = virtual_depth(p);
  float d = measured_metres(p);
  bool unmeasured = !is_measurement(d);
  uint label = LABEL_CLEAR;
  if (z > 0.0) {
    float e = tolerance(z);
    precise float before = z - e;
    precise float past = z + tolerance_beyond.w * e;
    label = unmeasured                                    ? LABEL_UNKNOWN
            : d < before                                  ? LABEL_FRONT
            : (tolerance_beyond.w > 0.0 && d > past)      ? LABEL_BEYOND
                                                          : LABEL_OCCLUDED;
  }
  imageStore(labels, p, uvec4(label));
  uint mark = (label == LABEL_FRONT ? FRONT : 0u) | (unmeasured ? UNMEASURED : 0u);
  if (cells == 0 && label == LABEL_FRONT) mark |= CERTAIN;
  imageStore(marks, p, uvec4(mark));
}
)";

/// The nearest virtual depth of each cell, +inf without robot. One invocation for each cell.
inline constexpr const char* cell_shader = R"(
layout(r32f, binding = 2) uniform writeonly image2D nearest;
void main() {
  ivec2 c = cell_window.xy + ivec2(gl_GlobalInvocationID.xy);
  if (!is_in(c, cell_window)) return;
  float z_min = uintBitsToFloat(0x7f800000u);
  for (int y = c.y * cell; y < min((c.y + 1) * cell, size.y); ++y) {
    for (int x = c.x * cell; x < min((c.x + 1) * cell, size.x); ++x) {
      float z = virtual_depth(ivec2(x, y));
      if (z > 0.0) z_min = min(z_min, z);
    }
  }
  imageStore(nearest, c, vec4(z_min));
}
)";

/// The nearest of the cells around, along `step`.
inline constexpr const char* nearest_shader = R"(
layout(r32f, binding = 2) uniform readonly image2D from;
layout(r32f, binding = 3) uniform writeonly image2D to;
layout(location = 0) uniform ivec2 step;
void main() {
  ivec2 c = cell_window.xy + ivec2(gl_GlobalInvocationID.xy);
  if (!is_in(c, cell_window)) return;
  float z_min = uintBitsToFloat(0x7f800000u);
  for (int i = -cells; i <= cells; ++i) {
    ivec2 n = c + i * step;
    if (is_in(n, cell_window)) z_min = min(z_min, imageLoad(from, n).x);
  }
  imageStore(to, c, vec4(z_min));
}
)";

/// Marks measured pixels that lie before all of the robot around as certain.
inline constexpr const char* certain_shader = R"(
layout(r32f, binding = 2) uniform readonly image2D nearest;
layout(r8ui, binding = 1) uniform uimage2D marks;
void main() {
  ivec2 p = own_pixel();
  if (!in_window(p)) return;
  uint mark = imageLoad(marks, p).x;
  float n = imageLoad(nearest, p / cell).x;
  if ((mark & UNMEASURED) != 0u || isinf(n)) return;
  float e = tolerance(n);
  precise float limit = n - e;
  if (measured_metres(p) < limit) imageStore(marks, p, uvec4(mark | CERTAIN));
}
)";

/// Marks as solid what is certain, and unmeasured pixels between two that are.
inline constexpr const char* solid_shader = R"(
layout(r8ui, binding = 1) uniform readonly uimage2D from;
layout(r8ui, binding = 4) uniform writeonly uimage2D to;
bool finds_certain(ivec2 p, ivec2 step) {
  for (int i = 1; i <= min_width; ++i) {
    ivec2 n = p + i * step;
    if (!in_window(n)) return false;
    if ((imageLoad(from, n).x & CERTAIN) != 0u) return true;
  }
  return false;
}
void main() {
  ivec2 p = own_pixel();
  if (!in_window(p)) return;
  uint mark = imageLoad(from, p).x;
  bool solid = (mark & CERTAIN) != 0u;
  if ((mark & UNMEASURED) != 0u) {
    solid = (finds_certain(p, ivec2(-1, 0)) && finds_certain(p, ivec2(1, 0))) ||
            (finds_certain(p, ivec2(0, -1)) && finds_certain(p, ivec2(0, 1)));
  }
  imageStore(to, p, uvec4(solid ? mark | SOLID : mark));
}
)";

/// Looks along `step` from pixel `first` to pixel `last`, counted from the own one, for the mark
/// `wanted`: in all of them, or in any. Marks the own pixel with `given`, or, with `needed` marks,
/// only where it has those.
inline constexpr const char* spread_shader = R"(
layout(r8ui, binding = 1) uniform readonly uimage2D from;
layout(r8ui, binding = 4) uniform writeonly uimage2D to;
layout(location = 0) uniform ivec2 step;
layout(location = 1) uniform ivec2 first_last;
layout(location = 2) uniform uvec3 wanted_given_needed;
layout(location = 3) uniform int all_of_them;
void main() {
  ivec2 p = own_pixel();
  if (!in_window(p)) return;
  uint mark = imageLoad(from, p).x;
  bool found = all_of_them != 0;
  for (int i = first_last.x; i <= first_last.y; ++i) {
    ivec2 n = p + i * step;
    bool has = in_window(n) && (imageLoad(from, n).x & wanted_given_needed.x) != 0u;
    found = all_of_them != 0 ? found && has : found || has;
  }
  uint needed = wanted_given_needed.z;
  uint given = wanted_given_needed.y;
  mark = found && (mark & needed) == needed ? mark | given : mark & ~given;
  imageStore(to, p, uvec4(mark));
}
)";

/// Calls front pixels that are not confirmed (ROW marks those that are) occluded, and counts
/// labels.
inline constexpr const char* finish_shader = R"(
layout(r8ui, binding = 0) uniform uimage2D labels;
layout(r8ui, binding = 1) uniform readonly uimage2D marks;
layout(std430, binding = 0) buffer Counts { uint counts[]; };
shared uint group_counts[LABELS];
void main() {
  uint own = gl_LocalInvocationIndex;
  if (own < LABELS) group_counts[own] = 0u;
  barrier();
  ivec2 p = own_pixel();
  if (in_window(p)) {
    uint label = imageLoad(labels, p).x;
    if (min_width > 0 && label == LABEL_FRONT && (imageLoad(marks, p).x & SQUARE) == 0u) {
      label = LABEL_OCCLUDED;
      imageStore(labels, p, uvec4(label));
    }
    if (label != LABEL_CLEAR) atomicAdd(group_counts[label], 1u);
  }
  barrier();
  uint n = own < LABELS ? group_counts[own] : 0u;
  if (n != 0u) atomicAdd(counts[own], n);
}
)";

/// Counts the labels in each of the boxes. One group for each box; its counts follow the image's.
inline constexpr const char* box_shader = R"(
layout(r8ui, binding = 0) uniform readonly uimage2D labels;
layout(std430, binding = 0) buffer Counts { uint counts[]; };
layout(std430, binding = 1) readonly buffer Boxes { ivec4 boxes[]; };
shared uint group_counts[LABELS];
void main() {
  uint box = gl_WorkGroupID.x;
  uint own = gl_LocalInvocationIndex;
  if (own < LABELS) group_counts[own] = 0u;
  barrier();
  ivec4 b = ivec4(max(boxes[box].xy, window.xy), min(boxes[box].zw, window.zw));
  for (int y = b.y + int(gl_LocalInvocationID.y); y < b.w; y += GROUP) {
    for (int x = b.x + int(gl_LocalInvocationID.x); x < b.z; x += GROUP) {
      uint label = imageLoad(labels, ivec2(x, y)).x;
      if (label != LABEL_CLEAR) atomicAdd(group_counts[label], 1u);
    }
  }
  barrier();
  if (own < LABELS) counts[LABELS * (box + 1u) + own] = group_counts[own];
}
)";

}  // namespace penumbra::gl
