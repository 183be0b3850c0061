// SPDX-License-Identifier: Apache-2.0
#include <python/bindings.hpp>
#include <python/fields.hpp>
#include <python/renderer.hpp>

#include <penumbra/base/rigid-inl.hpp>
#include <penumbra/render/gl/gl_devices.hpp>

namespace penumbra::python {
namespace {

std::unique_ptr<DepthRenderer> make_bodies_renderer(Backend backend, const Intrinsics& intrinsics,
                                                    const std::vector<OwnedBody>& owned,
                                                    const RendererOptions& options) {
  std::vector<std::vector<PreparedMesh>> meshes;
  for (const OwnedBody& body : owned) {
    auto& of_body = meshes.emplace_back();
    for (const Mesh& mesh : body.meshes)
      of_body.push_back(mesh.prepared ? *mesh.prepared : PreparedMesh(*mesh.triangles));
  }
  std::vector<Body> bodies;
  for (std::size_t i = 0; i < owned.size(); ++i) bodies.push_back({owned[i].name, meshes[i]});
  return make_depth_renderer(backend, intrinsics, bodies, options);
}

}  // namespace

Renderer::Renderer(Backend backend, const Intrinsics& intrinsics,
                   const std::vector<OwnedBody>& bodies, const RendererOptions& options)
    : renderer_(make_bodies_renderer(backend, intrinsics, bodies, options)),
      slots_(static_cast<std::size_t>(renderer_->max_pending())) {}

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
  Slot& slot = slot_of(submitted_);
  slot.lease.end("Renderer.submit", "an earlier frame's depth or links");
  slot.number = submitted_++;
  const py::gil_scoped_release others;
  renderer_->submit(T_camera_body);
}

std::uint64_t Renderer::collect(VirtualDepthView& view) {
  const OneThread::Use use(thread_, "Renderer.collect");
  if (renderer_->pending() == 0)
    throw py::value_error("Renderer.collect: no frame is pending: submit() one first");
  {
    const py::gil_scoped_release others;
    view = renderer_->collect();
  }
  return collected_++;
}

py::object Renderer::base_of(std::uint64_t number, const std::shared_ptr<const void>& owner) {
  Slot& slot = slot_of(number);
  if (slot.number != number)
    throw py::value_error(
        "VirtualDepth: the renderer has drawn another frame in its place; take a "
        "copy of what is needed longer");
  return slot.lease.base(owner);
}

namespace {

VirtualDepth collected(const std::shared_ptr<Renderer>& self) {
  VirtualDepthView view;
  const std::uint64_t number = present(self, "Renderer")->collect(view);
  return {self, number, view};
}

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
        "What EGL offers here. Raises InputError where there is no OpenGL or EGL.");
}

std::shared_ptr<Renderer> make_renderer(Backend backend, const Intrinsics& intrinsics,
                                        const std::vector<OwnedBody>& bodies,
                                        const RendererOptions& options) {
  const py::gil_scoped_release others;
  return std::make_shared<Renderer>(backend, intrinsics, bodies, options);
}

void bind_renderer_classes(py::module_& m) {
  py::class_<VirtualDepth>(
      m, "VirtualDepth",
      "What the camera would measure if only the bodies were there. Its arrays are read-only "
      "views: "
      "while one is in use, the call that would overwrite it raises ValueError; after that call "
      "they are not to be had any more.")
      .def_property_readonly("depth", method(&VirtualDepth::depth),
                             "Metres along the optical axis; 0: no body on the ray.")
      .def_property_readonly("links", method(&VirtualDepth::links),
                             "Body index + 1 of the nearest surface; 0: none.");
  py::class_<Renderer, std::shared_ptr<Renderer>>(
      m, "Renderer",
      "Renders bodies to metric z-depth at pixel centres, with which body is seen at each pixel. "
      "Clips at 1 cm and has no far cut. Serves one thread at a time.")
      .def(py::init(&make_renderer), py::arg("backend"), py::arg("intrinsics"), py::arg("bodies"),
           py::arg("options") = RendererOptions(),
           "bodies: Robot.bodies, say. Raises InputError for what the backend, this build or this "
           "machine cannot do.")
      .def("render", &rendered, py::arg("T_camera_body"),
           "Draws the bodies at their poses in the optical frame, metres, one for each.")
      .def(
          "submit", [](Renderer& self, const Poses& poses) { self.submit(poses); },
          py::arg("T_camera_body"), "Begins a frame, for collect() to wait for.")
      .def("collect", &collected, "The oldest pending frame.")
      .def_property_readonly(
          "pending", [](const Renderer& r) { return r.renderer().pending(); },
          "Frames submitted and not collected.")
      .def_property_readonly(
          "max_pending", [](const Renderer& r) { return r.renderer().max_pending(); },
          "The images of a frame last until so many more are submitted.")
      .def_property_readonly(
          "intrinsics", [](const Renderer& r) { return r.renderer().intrinsics(); },
          "Of its images.")
      .def_property_readonly(
          "triangle_count", [](const Renderer& r) { return r.renderer().triangle_count(); },
          "Of all bodies.")
      .def_property_readonly(
          "info", [](const Renderer& r) { return r.renderer().info(); }, "What draws.");
}

}  // namespace

void bind_renderer(py::module_& m) {
  bind_renderer_settings(m);
  bind_renderer_classes(m);
}

}  // namespace penumbra::python
