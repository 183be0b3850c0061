// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <epoxy/gl.h>

#include <penumbra/base/error.hpp>
#include <penumbra/pipeline/gl/label_passes-inl.hpp>
#include <penumbra/pipeline/gl/label_shaders-inl.hpp>
#include <penumbra/render/gl/buffer.hpp>
#include <penumbra/render/gl/gl_check.hpp>
#include <penumbra/render/gl/program.hpp>

namespace penumbra::gl {
namespace {

constexpr int group = 16;  // invocations along each side of a work group

// Marks of the shaders.
constexpr unsigned front = 1, certain = 2, unmeasured = 4, solid = 8, seed = 16, in_row = 32,
                   in_square = 64;

// Where the shaders expect things.
enum Binding : GLuint { labels_image, marks_image, cells_image, other_cells, other_marks };
enum Texture : GLuint { virtual_texture, millimetre_texture, metre_texture };

/// What the shaders must have as this program has it.
std::string shader_constants() {
  std::string text = "#version 450 core\nconst int GROUP = " + std::to_string(group) +
                     ", cell = " + std::to_string(LabelRule::cell) + ";\n";
  const auto add = [&](const char* name, unsigned value) {
    text += "const uint " + std::string(name) + " = " + std::to_string(value) + "u;\n";
  };
  add("LABELS", label_count);
  add("LABEL_CLEAR", static_cast<unsigned>(Label::clear));
  add("LABEL_FRONT", static_cast<unsigned>(Label::front));
  add("LABEL_OCCLUDED", static_cast<unsigned>(Label::occluded));
  add("LABEL_UNKNOWN", static_cast<unsigned>(Label::unknown));
  add("LABEL_BEYOND", static_cast<unsigned>(Label::beyond));
  add("FRONT", front);
  add("CERTAIN", certain);
  add("UNMEASURED", unmeasured);
  add("SOLID", solid);
  add("SEED", seed);
  add("ROW", in_row);
  add("SQUARE", in_square);
  return text;
}

GLuint make_texture(GLenum format, int width, int height) {
  GLuint texture = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &texture);
  glTextureStorage2D(texture, 1, format, width, height);
  // Integers cannot be interpolated: with other filters the texture would count as incomplete.
  glTextureParameteri(texture, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(texture, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return texture;
}

int cells_along(int pixels) { return (pixels + LabelRule::cell - 1) / LabelRule::cell; }

GLuint groups_for(int invocations) {
  return static_cast<GLuint>((invocations + group - 1) / group);
}

/// Runs a shader over a box, and lets what follows see what it wrote.
void dispatch(GLuint program, const std::array<std::int32_t, 4>& box) {
  glUseProgram(program);
  glDispatchCompute(groups_for(box[2] - box[0]), groups_for(box[3] - box[1]), 1);
  glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
}

std::size_t counts_size(std::size_t boxes) {
  return (1 + boxes) * label_count * sizeof(std::uint32_t);
}

void bind_marks(GLuint from, GLuint to) {
  glBindImageTexture(marks_image, from, 0, GL_FALSE, 0, GL_READ_WRITE, GL_R8UI);
  glBindImageTexture(other_marks, to, 0, GL_FALSE, 0, GL_READ_WRITE, GL_R8UI);
}

void bind_cells(GLuint from, GLuint to) {
  glBindImageTexture(cells_image, from, 0, GL_FALSE, 0, GL_READ_WRITE, GL_R32F);
  glBindImageTexture(other_cells, to, 0, GL_FALSE, 0, GL_READ_WRITE, GL_R32F);
}

}  // namespace

/// The two images of marks: each pass reads one and writes the other.
class LabelPasses::Marks {
 public:
  explicit Marks(const std::array<unsigned, 2>& images) : images_(images) {}
  void pass(GLuint program, const Box& window) {
    dispatch(program, window);
    std::swap(images_[0], images_[1]);
    bind_marks(images_[0], images_[1]);
  }

 private:
  std::array<unsigned, 2> images_;
};

LabelPasses::LabelPasses(int width, int height, const LabelRule& rule)
    : width_(width), height_(height), rule_(rule), stride_(row_stride(width)) {
  make_images();
  make_buffers();
  make_programs();
}

void LabelPasses::make_images() {
  labels_ = make_texture(GL_R8UI, width_, height_);
  sensor_millimetres_ = make_texture(GL_R16UI, width_, height_);
  sensor_metres_ = make_texture(GL_R32F, width_, height_);
  for (unsigned& marks : marks_) marks = make_texture(GL_R8UI, width_, height_);
  for (unsigned& cells : cells_) {
    cells = make_texture(GL_R32F, cells_along(width_), cells_along(height_));
  }
  const std::string error = take_error();
  if (!error.empty()) {
    throw InputError("labels with OpenGL: images of " + std::to_string(width_) + " x " +
                     std::to_string(height_) + " pixels are more than " + text(GL_RENDERER) +
                     " takes (" + error + "); label with the CPU");
  }
}

void LabelPasses::make_buffers() {
  constexpr GLbitfield access =
      GL_MAP_READ_BIT | GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
  const std::size_t pixels = stride_ * static_cast<std::size_t>(height_);
  std::byte* shared = nullptr;
  std::byte* labels = nullptr;
  counts_ = make_buffer(count_room * sizeof(Counts), nullptr, 0, "the counts of labels");
  shared_buffer_ =
      make_buffer(slots * shared_size, nullptr, access, "the counts of labels", &shared);
  label_buffer_ = make_buffer(slots * pixels, nullptr, access | GL_CLIENT_STORAGE_BIT,
                              std::to_string(slots) + " label images", &labels);
  std::fill_n(labels, slots * pixels, std::byte{0});
  for (std::size_t i = 0; i < slots; ++i) {
    Slot& slot = slots_[i];
    slot.shared = shared + i * shared_size;
    slot.labels = reinterpret_cast<std::uint8_t*>(labels + i * pixels);
    slot.touched = TileMask(width_, height_);
    slot.boxes.reserve(GlLabeller::max_boxes);
    slot.asked.reserve(GlLabeller::max_boxes);
  }
}

void LabelPasses::make_programs() {
  const std::string constants = shader_constants();
  const auto make = [&](std::initializer_list<const char*> sources) {
    std::vector<const char*> pieces{constants.c_str(), label_prelude};
    pieces.insert(pieces.end(), sources);
    return make_program({{GL_COMPUTE_SHADER, std::move(pieces)}});
  };
  label_ = make({robot_prelude, sensor_prelude, label_shader});
  cell_ = make({robot_prelude, cell_shader});
  nearest_ = make({nearest_shader});
  certain_ = make({sensor_prelude, certain_shader});
  solid_ = make({solid_shader});
  spread_ = make({spread_shader});
  finish_ = make({finish_shader});
  box_ = make({box_shader});
}

void LabelPasses::start(std::size_t index, unsigned depth, const PixelRectangle& seen,
                        const DepthView& measured, std::span<const PixelRectangle> boxes) {
  Slot& slot = slots_[index];
  for_each_outside(slot.rectangle, seen, [&](const PixelRectangle& r) {
    for (int v = r.v0; v < r.v1; ++v) {
      std::fill_n(slot.labels + static_cast<std::size_t>(v) * stride_ + r.u0, r.width(),
                  std::uint8_t{0});
    }
  });
  slot.rectangle = seen;
  std::fill(slot.touched.rows.begin(), slot.touched.rows.end(), std::uint64_t{0});
  slot.asked.assign(boxes.begin(), boxes.end());
  std::memset(slot.shared + counts_at, 0, counts_size(boxes.size()));
  if (seen.empty()) return;
  slot.touched.mark(seen.u0, seen.v0, seen.u1 - 1, seen.v1 - 1);
  set_parameters(slot, measured.index() == 0);
  std::memcpy(slot.shared, &slot.parameters, sizeof(Parameters));
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Box box{boxes[i].u0, boxes[i].v0, boxes[i].u1, boxes[i].v1};
    std::memcpy(slot.shared + boxes_at + i * sizeof(Box), &box, sizeof(Box));
  }
  upload(slot.parameters.window, measured);
  const std::size_t at = index * shared_size;
  glBindBufferRange(GL_UNIFORM_BUFFER, 0, shared_buffer_, static_cast<GLintptr>(at),
                    sizeof(Parameters));
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, counts_);
  glBindBufferRange(GL_SHADER_STORAGE_BUFFER, 1, shared_buffer_,
                    static_cast<GLintptr>(at + boxes_at), GlLabeller::max_boxes * sizeof(Box));
  glBindTextureUnit(virtual_texture, depth);
  glTextureBarrier();  // it is still attached to the framebuffer
  run(slot);
  fetch(index, slot);
  slot.fence = make_fence();
}

void LabelPasses::set_parameters(Slot& slot, bool millimetres) const {
  const PixelRectangle& seen = slot.rectangle;
  // A front pixel's square reaches its width beyond the robot, and a hole in it as far again.
  const int beside = 2 * rule_.width;
  Parameters& p = slot.parameters;
  p.window = {std::max(seen.u0 - beside, 0), std::max(seen.v0 - beside, 0),
              std::min(seen.u1 + beside, width_), std::min(seen.v1 + beside, height_)};
  p.seen = {seen.u0, seen.v0, seen.u1, seen.v1};
  p.cell_window = {p.window[0] / LabelRule::cell, p.window[1] / LabelRule::cell,
                   cells_along(p.window[2]), cells_along(p.window[3])};
  p.size = {width_, height_};
  p.millimetres = millimetres ? 1 : 0;
  p.min_width = rule_.width;
  const float beyond = std::isinf(rule_.beyond_factor) ? 0.0F : rule_.beyond_factor;
  p.tolerance_beyond = {rule_.a, rule_.b, rule_.c, beyond};
  const labelling::MeasuredRange& range = millimetres ? rule_.millimetres : rule_.metres;
  p.measured = {std::bit_cast<std::uint32_t>(range.near), std::bit_cast<std::uint32_t>(range.far)};
  p.cells = rule_.cells;
}

void LabelPasses::upload(const Box& window, const DepthView& measured) const {
  const int u0 = window[0];
  const int v0 = window[1];
  const int u1 = window[2];
  const int v1 = window[3];
  const auto copy = [&](unsigned texture, GLenum format, GLenum type, const auto& image) {
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    if (image.stride >= image.width) {
      glPixelStorei(GL_UNPACK_ROW_LENGTH, static_cast<GLint>(image.stride));
      glTextureSubImage2D(texture, 0, u0, v0, u1 - u0, v1 - v0, format, type, image.row(v0) + u0);
      return;
    }
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);  // rows that run upwards or overlap
    for (int v = v0; v < v1; ++v) {
      glTextureSubImage2D(texture, 0, u0, v, u1 - u0, 1, format, type, image.row(v) + u0);
    }
  };
  if (const auto* millimetres = std::get_if<ImageView<const std::uint16_t>>(&measured)) {
    copy(sensor_millimetres_, GL_RED_INTEGER, GL_UNSIGNED_SHORT, *millimetres);
  } else {
    copy(sensor_metres_, GL_RED, GL_FLOAT, std::get<ImageView<const float>>(measured));
  }
  glBindTextureUnit(millimetre_texture, sensor_millimetres_);
  glBindTextureUnit(metre_texture, sensor_metres_);
}

void LabelPasses::run(const Slot& slot) const {
  const Parameters& p = slot.parameters;
  glClearNamedBufferSubData(counts_, GL_R32UI, 0,
                            static_cast<GLsizeiptr>(counts_size(slot.asked.size())), GL_RED_INTEGER,
                            GL_UNSIGNED_INT, nullptr);
  glBindImageTexture(labels_image, labels_, 0, GL_FALSE, 0, GL_READ_WRITE, GL_R8UI);
  bind_marks(marks_[0], marks_[1]);
  dispatch(label_, p.window);
  if (rule_.cleans_up()) clean_up(p);
  dispatch(finish_, p.window);
  if (!slot.asked.empty()) {
    glUseProgram(box_);
    glDispatchCompute(static_cast<GLuint>(slot.asked.size()), 1, 1);
  }
}

void LabelPasses::clean_up(const Parameters& p) const {
  if (rule_.cells > 0) {
    bind_cells(cells_[0], cells_[1]);
    dispatch(cell_, p.cell_window);
    glProgramUniform2i(nearest_, 0, 1, 0);
    dispatch(nearest_, p.cell_window);
    bind_cells(cells_[1], cells_[0]);
    glProgramUniform2i(nearest_, 0, 0, 1);
    dispatch(nearest_, p.cell_window);
    bind_cells(cells_[0], cells_[1]);
    dispatch(certain_, p.window);
  }
  Marks marks(marks_);
  marks.pass(solid_, p.window);
  const int last = rule_.width - 1;
  // Squares that are solid, by their first pixels; then all of their pixels.
  spread(marks, p.window, {1, 0, 0, last, solid, in_row, 0, true});
  spread(marks, p.window, {0, 1, 0, last, in_row, in_square, 0, true});
  spread(marks, p.window, {-1, 0, 0, last, in_square, in_row, 0, false});
  spread(marks, p.window, {0, -1, 0, last, in_row, seed, front | certain, false});
  // What is near enough to a seed to be confirmed.
  const int reach = rule_.reach;
  spread(marks, p.window, {1, 0, -reach, reach, seed, in_row, 0, false});
  spread(marks, p.window, {0, 1, -reach, reach, in_row, in_square, 0, false});
}

void LabelPasses::spread(Marks& marks, const Box& window, const Spread& s) const {
  glProgramUniform2i(spread_, 0, s.step_u, s.step_v);
  glProgramUniform2i(spread_, 1, s.first, s.last);
  glProgramUniform3ui(spread_, 2, s.wanted, s.given, s.needed);
  glProgramUniform1i(spread_, 3, s.all ? 1 : 0);
  marks.pass(spread_, window);
}

void LabelPasses::fetch(std::size_t index, const Slot& slot) const {
  glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT | GL_PIXEL_BUFFER_BARRIER_BIT |
                  GL_BUFFER_UPDATE_BARRIER_BIT);
  glCopyNamedBufferSubData(counts_, shared_buffer_, 0,
                           static_cast<GLintptr>(index * shared_size + counts_at),
                           static_cast<GLsizeiptr>(counts_size(slot.asked.size())));
  const PixelRectangle& r = slot.rectangle;
  const std::size_t pixels = stride_ * static_cast<std::size_t>(height_);
  const std::size_t first =
      index * pixels + static_cast<std::size_t>(r.v0) * stride_ + static_cast<std::size_t>(r.u0);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, label_buffer_);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glPixelStorei(GL_PACK_ROW_LENGTH, static_cast<GLint>(stride_));
  glGetTextureSubImage(labels_, 0, r.u0, r.v0, 0, r.width(), r.height(), 1, GL_RED_INTEGER,
                       GL_UNSIGNED_BYTE, static_cast<GLsizei>(slots * pixels - first),
                       as_address(first));
}

DeviceLabels LabelPasses::wait(std::size_t index) {
  Slot& slot = slots_[index];
  wait_for(slot.fence);
  const auto count = [](const Counts& counts, std::size_t all) {
    std::array<std::size_t, label_count> pixels{};
    std::copy(counts.begin(), counts.end(), pixels.begin());
    for (const std::size_t labelled : counts) all -= labelled;
    pixels[static_cast<std::size_t>(Label::clear)] = all;
    return pixels;
  };
  std::memcpy(slot.counts.data(), slot.shared + counts_at, counts_size(slot.asked.size()));
  DeviceLabels out;
  out.image.labels = {slot.labels, width_, height_, static_cast<std::ptrdiff_t>(stride_)};
  out.image.touched = &slot.touched;
  out.image.pixels =
      count(slot.counts[0], static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  slot.boxes.clear();
  for (std::size_t i = 0; i < slot.asked.size(); ++i) {
    const PixelRectangle inside = overlap(slot.asked[i], {0, 0, width_, height_});
    slot.boxes.push_back(count(slot.counts[i + 1], static_cast<std::size_t>(inside.width()) *
                                                       static_cast<std::size_t>(inside.height())));
  }
  out.boxes = slot.boxes;
  return out;
}

}  // namespace penumbra::gl
