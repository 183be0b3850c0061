// SPDX-License-Identifier: Apache-2.0
#include <penumbra/base/error.hpp>

#include <apps/penumbra/options.hpp>

namespace penumbra::app {
namespace {

constexpr int most_gl_devices = 1000;
constexpr int most_port = 65535;
constexpr std::uint16_t default_port = 8470;

}  // namespace

CLI::Option* add_path(CLI::App& app, const std::string& names, const std::string& help,
                      const std::string& value, std::filesystem::path& to) {
  return add_option(app, names, help, value, [&to, names](const std::string& text) {
    if (text.empty()) refuse_option(names, text, "a path");
    to = text;
  });
}

io::WebOptions web_options(const ServerArguments& server) {
  io::WebOptions options{.port = server.port.value_or(default_port)};
  if (server.address) options.address = *server.address;
  return options;
}

void add_server(CLI::App& app, ServerArguments& server, const std::string& port_help) {
  add_option(app, "--port", port_help, "N", [&](const std::string& text) {
    server.port = static_cast<std::uint16_t>(to_count("--port", text, 0, most_port));
  });
  add_option(app, "--address",
             "IP address to serve on; default 127.0.0.1, this machine alone; another wants the "
             "token that is printed",
             "IP", [&](const std::string& text) {
               if (text.empty()) refuse_option("--address", text, "an IP address");
               server.address = text;
             });
}

void add_renderer(CLI::App& app, Backend& backend, RendererOptions& renderer) {
  add_option(app, "--renderer", "cpu (default), gl (OpenGL) or reference", "NAME",
             [&](const std::string& text) { backend = to_backend(text); });
  add_option(app, "--gl-device", "OpenGL device by its number in penumbra doctor", "N",
             [&](const std::string& text) {
               renderer.gl_device = to_count("--gl-device", text, 0, most_gl_devices);
             });
  add_option(app, "--threads", "threads of the cpu renderer; results do not depend on it", "N",
             [&](const std::string& text) {
               renderer.threads = to_count("--threads", text, 1, RendererOptions::max_threads);
             });
}

void add_extra(CLI::App& app, std::vector<ExtraMesh>& extra) {
  add_list(app, "--extra",
           "mesh that a link carries and the URDF lacks; may be given several times", "LINK=FILE",
           [&extra](const std::string& text) {
             const auto [link, file] = to_pair("--extra", text, "LINK=FILE");
             extra.push_back({link, file});
           });
}

void add_leniency(CLI::App& app, bool& allow_missing_meshes, bool& geometry_fallback) {
  app.add_flag("--allow-missing-meshes", allow_missing_meshes,
               "go on without meshes that cannot be read and links that have only the other "
               "geometry; every result names the missing links");
  app.add_flag("--geometry-fallback", geometry_fallback,
               "draw links that have only the other geometry by that; inspect says which");
}

void check_renderer(Backend backend, const RendererOptions& options) {
  const std::string name(to_string(backend));
  if (backend != Backend::cpu && options.threads > 1)
    throw InputError("--threads " + std::to_string(options.threads) + ": the " + name +
                     " renderer uses one thread; leave --threads out, or choose --renderer cpu");
  if (backend != Backend::gl && options.gl_device >= 0)
    throw InputError("--gl-device " + std::to_string(options.gl_device) + ": the " + name +
                     " renderer uses no OpenGL; choose --renderer gl");
}

}  // namespace penumbra::app
