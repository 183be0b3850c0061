// SPDX-License-Identifier: Apache-2.0
#include <penumbra/base/error.hpp>

#include <apps/penumbra/options.hpp>
#include <apps/penumbra/text.hpp>

namespace penumbra::app {
namespace {

constexpr int most_gl_devices = 1000;

}  // namespace

void refuse_option(const std::string& option, const std::string& value, const std::string& wanted) {
  throw InputError(option + ": '" + value + "' is not " + wanted);
}

Execute refuse_command(CLI::App& app, const char* why) {
  app.allow_extras();
  app.description(app.get_description() + " (not in this build: penumbra " + app.get_name() +
                  " says why)");
  return [why]() -> int { throw InputError(why); };
}

std::pair<std::string, std::string> to_pair(const std::string& option, const std::string& text,
                                            const std::string& wanted) {
  const std::size_t equals = text.find('=');
  if (equals == 0 || equals == std::string::npos || equals + 1 == text.size())
    refuse_option(option, text, wanted);
  return {text.substr(0, equals), text.substr(equals + 1)};
}

void add_packages(CLI::App& app, std::map<std::string, std::filesystem::path>& packages,
                  std::map<std::string, std::string>& arguments) {
  const auto take = [&packages](const std::string& text) {
    const auto [name, folder] = to_pair("--package", text, "NAME=DIR");
    std::error_code error;
    if (!std::filesystem::is_directory(folder, error))
      refuse_option("--package", text, "NAME=DIR with a folder that exists");
    if (!packages.emplace(name, folder).second)
      throw InputError("--package " + text + ": " + name + " is given twice");
  };
  add_list(app, "--package", "where package://NAME is; may be given several times", "NAME=DIR",
           take);
  add_list(app, "--arg", "an argument of a xacro file; may be given several times", "NAME:=VALUE",
           [&arguments](const std::string& text) {
             const std::size_t colon = text.find(":=");
             if (colon == 0 || colon == std::string::npos)
               refuse_option("--arg", text, "NAME:=VALUE");
             if (!arguments.emplace(text.substr(0, colon), text.substr(colon + 2)).second)
               throw InputError("--arg " + text + ": the argument is given twice");
           });
}

void add_robot(CLI::App& app, RobotOptions& options) {
  add_packages(app, options.packages, options.arguments);
  add_drawn(app, options, "collision");
}

void add_renderer(CLI::App& app, Backend& backend, RendererOptions& renderer) {
  add_choice<Backend>(
      app, "--renderer", "cpu (default), gl (OpenGL) or reference", backend,
      {{"cpu", Backend::cpu}, {"gl", Backend::gl}, {"reference", Backend::reference}});
  add_number(app, "--gl-device", "OpenGL device by its number in penumbra doctor", "N",
             renderer.gl_device, 0, most_gl_devices);
  add_number(app, "--threads", "threads of the cpu renderer; results do not depend on it", "N",
             renderer.threads, 1, RendererOptions::max_threads);
}

void add_links(CLI::App& app, std::vector<ExtraMesh>& extra,
               std::vector<std::string>& ignore_links) {
  add_list(app, "--ignore-links",
           "links that are not drawn, for example the sensor's own housing; of several robots "
           "ROBOT/PATTERN; with commas between, or given several times",
           "PATTERN", [&ignore_links](const std::string& text) {
             for (std::string& pattern : split(text, ','))
               ignore_links.push_back(std::move(pattern));
           });
  add_list(app, "--extra",
           "mesh that a link carries and the URDF lacks; may be given several times", "LINK=FILE",
           [&extra](const std::string& text) {
             const auto [link, file] = to_pair("--extra", text, "LINK=FILE");
             extra.push_back({link, file});
           });
}

void add_joints(CLI::App& app, std::map<std::string, double>& joints) {
  const std::string wanted = "NAME=VALUE, in radians or metres";
  add_list(app, "--joint",
           "a joint that does not move, or whose position is not received; may be given several "
           "times",
           "NAME=VALUE", [&joints, wanted](const std::string& text) {
             const auto [name, value] = to_pair("--joint", text, wanted);
             const auto number = io::parse_number<double>(value);
             if (!number) refuse_option("--joint", text, wanted);
             if (!joints.emplace(name, *number).second)
               throw InputError("--joint: '" + name + "' is given twice");
           });
}

void add_leniency(CLI::App& app, bool& allow_missing_meshes, bool& geometry_fallback) {
  app.add_flag("--allow-missing-meshes", allow_missing_meshes,
               "go on without meshes that cannot be read and links that lack the geometry of "
               "--geometry; every result names the missing links");
  app.add_flag("--geometry-fallback", geometry_fallback,
               "draw links that lack the geometry of --geometry by the other one, without a note");
}

void add_frames(CLI::App& app, io::FrameRange& frames) {
  const auto take = [&frames](const std::string& text) {
    const auto parts = split(text, ':');
    const auto read = [&](const std::string& part) -> std::optional<std::int64_t> {
      if (part.empty()) return std::nullopt;
      const auto bound = io::parse_number<std::int64_t>(part);
      return bound && *bound >= 0 ? bound : std::optional<std::int64_t>(-1);
    };
    if (parts.size() == 2) frames = {read(parts[0]), read(parts[1])};
    if (parts.size() != 2 || frames.first == -1 || frames.end == -1)
      refuse_option("--frames", text,
                    "A:B, the frames from A up to but without B (either may be left out)");
  };
  add_option(app, "--frames", "the frames from A up to but without B", "A:B", take);
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
