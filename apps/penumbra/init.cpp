// SPDX-License-Identifier: Apache-2.0
#include <iostream>

#include <apps/penumbra/commands.hpp>
#include <io/files/names.hpp>
#include <io/files/printable.hpp>

namespace penumbra::app {

int execute(const io::InitOptions& options) {
  const io::InitResult result = io::init_recording(options);
  std::cout << "written: " << io::without_controls(result.file.string()) << '\n';
  for (const std::string& line : result.lacking)
    std::cout << "look at  " << io::without_controls(line) << '\n';
  const std::string folder = io::for_shell(options.folder.string());
  std::cout << "next:    penumbra "
            << (result.has_pose ? "run " + folder + " -o out --report"
                                : "calibrate " + folder + " --search -o calibrated")
            << '\n';
  return 0;
}

}  // namespace penumbra::app
