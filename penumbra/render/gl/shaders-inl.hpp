// SPDX-License-Identifier: Apache-2.0
// Draws metric depth and links. Clip coordinates are (x, y, near, z): OpenGL's depth is near / z,
// whose floating-point steps are the same share of the depth at every distance, cuts at the near
// plane and never beyond.
#pragma once

namespace penumbra::gl {

/// A body's matrix comes in rows; the third of four is (0, 0, 0, near) for all.
inline constexpr const char* vertex_shader = R"(#version 450 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 to_clip_x;
layout(location = 2) in vec4 to_clip_y;
layout(location = 3) in vec4 to_clip_w;
layout(location = 4) in uint body;
layout(location = 5) in vec2 box_depths;
layout(location = 0) uniform float near;
flat out uint link;
flat out vec2 depths;
void main() {
  vec4 p = vec4(position, 1.0);
  gl_Position = vec4(dot(to_clip_x, p), dot(to_clip_y, p), near, dot(to_clip_w, p));
  link = body + 1u;
  depths = box_depths;
}
)";

/// Metres from gl_FragCoord.z and not from w, which is the rougher of the two in llvmpipe: by 6e-4
/// of itself on long slivers. Faces seen edge-on get any depth, or none that is a number, from a
/// device: nothing of a body is drawn outside the depths of its box.
inline constexpr const char* fragment_shader = R"(#version 450 core
layout(location = 0) uniform float near;
flat in uint link;
flat in vec2 depths;
layout(location = 0) out float metres;
layout(location = 1) out uint shown_link;
void main() {
  metres = near / gl_FragCoord.z;
  if (!(metres >= depths.x && metres <= depths.y)) discard;
  shown_link = link;
}
)";

}  // namespace penumbra::gl
