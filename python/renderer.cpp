// SPDX-License-Identifier: Apache-2.0
#include <python/bindings.hpp>
#include <python/fields.hpp>
#include <python/renderer.hpp>

#include <penumbra/base/rigid-inl.hpp>
#include <penumbra/render/gl/gl_devices.hpp>

namespace penumbra::python {

Renderer::Renderer(Backend backend, const Intrinsics& intrinsics,
                   const std::vector<OwnedBody>& bodies, const RendererOptions& options)
    : renderer_(with_bodies(
          bodies,
          [&](auto all) { return make_depth_renderer(backend, intrinsics, all, options); })),
      frames_(static_cast<std::size_t>(renderer_->max_pending())) {}

void Renderer::submit(const Poses& T_camera_body) {
  const OneThread::Use use(thread_, "Renderer.submit");
  if (T_camera_body.size() != renderer_->body_count())
    throw py::value_error("T_camera_body: expected shape (" +
                          std::to_string(renderer_->body_count()) +
                          ", 4, 4), a pose for each body; "
                          "got " +
                          std::to_string(T_camera_body.size()) + " poses");
  for (const Eigen::Isometry3d& T : T_camera_body)
    if (!is_rigid(T))
      throw py::value_error("T_camera_body: expected finite rotations (to 1e-4) and translations");
  if (renderer_->pending() == renderer_->max_pending())
    throw py::value_error("Renderer.submit: " + std::to_string(renderer_->pending()) +
                          " frames are pending, as many as may be: collect() one first");
  ++submitted_;
  const py::gil_scoped_release others;
  renderer_->submit(T_camera_body);
}

std::uint64_t Renderer::collect() {
  const OneThread::Use use(thread_, "Renderer.collect");
  if (renderer_->pending() == 0)
    throw py::value_error("Renderer.collect: no frame is pending: submit() one first");
  {
    const py::gil_scoped_release others;
    frames_[collected_ % frames_.size()] = renderer_->collect();
  }
  return collected_++;
}

const VirtualDepthView& Renderer::images(std::uint64_t number) const {
  if (submitted_ > number + frames_.size())
    throw py::value_error(
        "VirtualDepth: the renderer has drawn another frame in its place: read "
        "depth and links before that");
  return frames_[number % frames_.size()];
}

namespace {

VirtualDepth collected(const std::shared_ptr<Renderer>& self) { return {self, self->collect()}; }

VirtualDepth rendered(const std::shared_ptr<Renderer>& self, const Poses& T_camera_body) {
  if (self->renderer().pending() > 0)
    throw py::value_error("Renderer.render: frames are pending: collect() them first");
  self->submit(T_camera_body);
  return collected(self);
}

void bind_renderer_settings(py::module_& m) {
  py::class_<RendererOptions> options(m, "RendererOptions", "How a renderer draws.");
  using O = RendererOptions;
  bind_fields(
      options, Field{"threads", &O::threads, "Of the cpu backend; results do not depend on it."},
      Field{"isa", &O::isa, "cpu: a SIMD target by name; empty: the best there is."},
      Field{"gl_device", &O::gl_device, "gl: index into gl_devices(); -1: the first usable."});
  py::class_<RendererInfo> info(m, "RendererInfo", "What draws.");
  using I = RendererInfo;
  show_fields(info, Field{"backend", &I::backend, "The backend."},
              Field{"isa", &I::isa, "Name of the SIMD target; scalar for the reference."},
              Field{"threads", &I::threads, "Of the cpu backend."},
              Field{"device", &I::device, "gl: OpenGL's own words; others: empty."});
  py::class_<GlDevice> device(m, "GlDevice",
                              "A device on which OpenGL may draw without a display.");
  using D = GlDevice;
  show_fields(device, Field{"name", &D::name, "GL_RENDERER."},
              Field{"version", &D::version, "GL_VERSION."},
              Field{"vendor", &D::vendor, "GL_VENDOR."},
              Field{"software", &D::software, "It draws on the CPU."},
              Field{"fault", &D::fault, "Why it cannot be used; empty: it can."});
  m.def("gl_devices", &gl_devices, WithoutGil(),
        "What EGL offers here. Raises InputError without OpenGL or EGL.");
}

std::shared_ptr<Renderer> make_renderer(Backend backend, const Intrinsics& intrinsics,
                                        const std::vector<OwnedBody>& bodies,
                                        const RendererOptions& options) {
  const py::gil_scoped_release others;
  return std::make_shared<Renderer>(backend, intrinsics, bodies, options);
}

void bind_renderer_classes(py::module_& m) {
  py::class_<VirtualDepth> shown_depth(
      m, "VirtualDepth",
      "What the camera would measure if only the bodies were there. Its arrays, (H, W), are "
      "read-only copies, made when they are first read. Raises ValueError for one that was not "
      "read before max_pending later frames were submitted.");
  show_properties(
      shown_depth,
      Field{"depth", &VirtualDepth::depth, "Metres along the optical axis; 0: no body on the ray."},
      Field{"links", &VirtualDepth::links, "Body index + 1 of the nearest surface; 0: none."});
  using R = Renderer;
  py::class_<R, std::shared_ptr<R>> renderer(
      m, "Renderer",
      "Renders bodies to metric z-depth at pixel centres, with which body is seen at each pixel. "
      "Clips at 1 cm and has no far cut. Serves one thread at a time.");
  renderer
      .def(py::init(&make_renderer), py::arg("backend"), py::arg("intrinsics"), py::arg("bodies"),
           py::arg("options") = RendererOptions(),
           "bodies: Robot.bodies, say. Raises InputError for what the backend, this build or this "
           "machine cannot do.")
      .def("render", &rendered, py::arg("T_camera_body"),
           "Draws the bodies at their poses in the optical frame, metres, one for each.")
      .def(
          "submit", [](R& self, const Poses& poses) { self.submit(poses); },
          py::arg("T_camera_body"), "Begins a frame, for collect() to wait for.")
      .def("collect", &collected, "The oldest pending frame.");
  const auto of = [](auto member) {
    return [member](const R& r) { return std::invoke(member, r.renderer()); };
  };
  using D = DepthRenderer;
  show_fields(renderer, Field{"info", of(&D::info), "What draws."},
              Field{"intrinsics", of(&D::intrinsics), "Of its images."},
              Field{"triangle_count", of(&D::triangle_count), "Of all bodies."},
              Field{"pending", of(&D::pending), "Frames submitted and not collected."},
              Field{"max_pending", of(&D::max_pending),
                    "The images of a frame are valid until this many more are submitted."});
}

}  // namespace

void bind_renderer(py::module_& m) {
  bind_renderer_settings(m);
  bind_renderer_classes(m);
}

}  // namespace penumbra::python
