// SPDX-License-Identifier: Apache-2.0
#include <iostream>

#include <apps/penumbra/help.hpp>
#include <apps/penumbra/options.hpp>
#include <io/files/names.hpp>
#include <io/files/printable.hpp>
#include <io/inputs/init_recording.hpp>

namespace penumbra::app {
namespace {

void add_options(CLI::App& app, io::InitOptions& init) {
  app.footer(init_examples);
  add_text(app, "FOLDER", "images, joint file, robot, camera_info", "", init.folder)->required();
  add_text(app, "--robot", "the robot: URDF, xacro or MJCF; default: the one in the folder", "URDF",
           init.robot);
  add_packages(app, init.packages, init.arguments);
  app.add_flag("--force", init.force, "replace a recording.yaml");
}

int execute(const io::InitOptions& options) {
  const io::InitResult result = io::init_recording(options);
  std::cout << "written: " << io::without_controls(result.file.string()) << '\n';
  for (const std::string& line : result.lacking)
    std::cout << "look at  " << io::without_controls(line) << '\n';
  const std::string folder = io::for_shell(options.folder.string());
  const std::string masks = result.has_depth ? "" : " --masks 'mask_%d.png'";
  std::cout << "next:    ";
  for (const std::string& key : result.needed)
    std::cout << (&key == &result.needed.front() ? "give " : " and ") << key;
  if (!result.needed.empty()) std::cout << " in recording.yaml, then ";
  std::cout << "penumbra "
            << (result.has_pose ? "run " + folder + " -o out --report"
                                : "calibrate " + folder + " --search" + masks + " -o calibrated")
            << '\n';
  return 0;
}

}  // namespace

Execute add_init(CLI::App& app) {
  return make_command<io::InitOptions>(app, add_options, nullptr, execute);
}

}  // namespace penumbra::app
