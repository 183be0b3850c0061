// SPDX-License-Identifier: Apache-2.0
// Times the gl backend beside the cpu backend on the same frames:
// gl_benchmark [--device N] [--rounds N] [--frames N] [--seed N] [--json FILE] [--soak]
// gl_benchmark [--device N] --name
// --soak also draws 10,000 frames, makes 1,000 renderers and the like, and tells what is left of
// them.
// --name prints the device's short name, for the results' file, and does nothing else.
#include "gl_benchmark.hpp"

#include "scenes.hpp"
#include "timing.hpp"

#include <cctype>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <string>
#include <thread>

#include <nlohmann/json.hpp>

#include <penumbra/base/error.hpp>
#include <penumbra/base/simd_target.hpp>
#include <penumbra/render/gl/gl_devices.hpp>

namespace penumbra::bench {
namespace {

using nlohmann::json;

struct Arguments {
  GlSettings settings;
  std::string json_file;
  bool soak = false;
  bool name = false;
};

Arguments parse(int argc, char** argv) {
  Arguments a;
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    if (option == "--soak" || option == "--name") {
      (option == "--soak" ? a.soak : a.name) = true;
      continue;
    }
    if (i + 1 == argc) throw InputError(option + ": unknown, or its value is missing");
    const std::string value = argv[++i];
    if (option == "--device") {
      a.settings.gl.gl_device = std::stoi(value);
    } else if (option == "--rounds") {
      a.settings.rounds = std::stoi(value);
    } else if (option == "--frames") {
      a.settings.frames = std::stoul(value);
    } else if (option == "--seed") {
      a.settings.seed = std::stoul(value);
    } else if (option == "--json") {
      a.json_file = value;
    } else {
      throw InputError(option + ": unknown option");
    }
  }
  if (a.settings.rounds < 1 || a.settings.frames < 4)
    throw InputError("--rounds must be 1 at least, --frames 4");
  return a;
}

/// The device that a gl renderer takes with these options.
GlDevice device_of(const RendererOptions& options) {
  const BenchScene scene = ur5e_scene(Geometry::collision, 64, 48, 60.0, 1, 1);
  const auto renderer = make_depth_renderer(Backend::gl, scene.intrinsics, scene.bodies(), options);
  for (const GlDevice& device : gl_devices()) {
    if (renderer->info().device == device.name + ", OpenGL " + device.version) return device;
  }
  throw InputError("the device '" + renderer->info().device + "' is not in EGL's list");
}

/// "NVIDIA H200/PCIe/SSE2" becomes "nvidia-h200", "llvmpipe (LLVM 15.0.6, 512 bits)" "llvmpipe".
std::string short_name(const std::string& renderer) {
  std::string name;
  int brackets = 0;
  for (const char c : renderer) {
    if (c == '/') break;
    if (c == '(') ++brackets;
    const bool word = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (brackets == 0 && word) {
      name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    } else if (!name.empty() && name.back() != '-') {
      name += '-';
    }
    if (c == ')') --brackets;
  }
  while (name.ends_with('-')) name.pop_back();
  return name;
}

std::string load_average() {
  std::ifstream file("/proc/loadavg");
  std::string one, five, fifteen;
  file >> one >> five >> fifteen;
  return one + " " + five + " " + fifteen;
}

json settings_of(const GlSettings& s, const GlDevice& device) {
  const char* driver_threads = std::getenv("LP_NUM_THREADS");
  return {{"device", device.name + ", OpenGL " + device.version},
          {"software", device.software},
          {"lp_num_threads", driver_threads == nullptr ? "not set" : driver_threads},
          {"cpu", cpu_model()},
          {"cores", std::thread::hardware_concurrency()},
          {"isa", simd_target_names().front()},
          {"threads", 1},
          {"rounds", s.rounds},
          {"frames", s.frames},
          {"seed", s.seed}};
}

void run(const Arguments& a) {
  const GlSettings& s = a.settings;
  const GlDevice device = device_of(s.gl);
  if (a.name) {
    std::cout << short_name(device.name) << '\n';
    return;
  }
  json report = settings_of(s, device);
  report["load_average"]["start"] = load_average();
  std::cout << "gl: " << device.name << ", OpenGL " << device.version
            << (device.software ? " (draws on the CPU; LP_NUM_THREADS " : " (")
            << (device.software ? report["lp_num_threads"].get<std::string>() : "hardware")
            << ")\nprocessor: " << cpu_model() << ", " << report["cores"]
            << " cores; cpu: " << report["isa"].get<std::string>()
            << " is the best target, one thread; " << s.rounds << " rounds of " << s.frames
            << " frames, a new pose every frame, seed " << s.seed
            << "\ntypical: median over the frames of each frame's fastest round, from submit to "
               "collect; CPU: time of the process per frame, thread: of the calling one (fastest "
               "rounds); right of the bar: with frames ahead\nload average at the start: "
            << load_average() << '\n';
  if (a.soak) report["soak"] = soak(s);  // first: memory freed before would hide what is lost
  report["frame_costs"] = compare_frames(s);
  report["cameras"] = compare_cameras(s);
  report["load_average"]["end"] = load_average();
  std::cout << "load average at the end: " << load_average() << '\n';
  if (!a.json_file.empty()) std::ofstream(a.json_file) << report.dump(1) << '\n';
}

}  // namespace
}  // namespace penumbra::bench

int main(int argc, char** argv) {
  try {
    penumbra::bench::run(penumbra::bench::parse(argc, argv));
    return 0;
  } catch (const penumbra::InputError& error) {
    std::cerr << "gl_benchmark: " << error.what() << '\n';
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "gl_benchmark: " << error.what() << '\n';
    return 1;
  }
}
