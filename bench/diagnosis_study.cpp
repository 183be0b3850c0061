// SPDX-License-Identifier: Apache-2.0
// Spoils right setups by one mistake at a time, and counts what the diagnosis says. Without
// arguments, or of images or masks, it writes a table of bench/results/diagnosis.txt. VERBOSE=1
// prints each diagnosis. usage: diagnosis_study [images | masks]
//            [TIMES [PART OF A MISTAKE [PART OF A CELL [SEED [CELLS OF EACH KIND]]]]]
#include "simulated_cell.hpp"
#include "study_page.hpp"

#include <ctime>
#include <functional>
#include <iostream>
#include <map>

#include <penumbra/base/error.hpp>
#include <penumbra/diagnosis/diagnosis.hpp>
#include <penumbra/poses/pose_stage.hpp>

#include <io/inputs/run_input.hpp>

namespace penumbra::study {
namespace {

/// A sequence with everything that a mistake may spoil.
struct Sequence {
  std::string name;
  std::shared_ptr<const Robot> robot;
  Camera camera{{1, 1, 1, 1, 0, 0}, {}, {}, {}};
  std::size_t parent = 0;
  Eigen::Isometry3d T_parent_camera = Eigen::Isometry3d::Identity();
  struct Instant {
    std::size_t index;
    std::optional<std::int64_t> stamp;
    std::vector<double> joints;
    std::shared_ptr<const KeptFrame> seen;  // its images
  };
  std::vector<Instant> instants;
  double depth_factor = 1.0;
};

struct Outcome {
  Diagnosis diagnosis;
  double seconds = 0.0;
};

Diagnosis diagnosis_of(const Sequence& sequence) {
  if (sequence.instants[0].seen->depth.empty()) {
    KeptFrames kept(*sequence.robot, sequence.camera,
                    {.most = SetupCheck::most_by_color,
                     .needs_depth = false,
                     .parent = sequence.parent,
                     .camera_stays = false,
                     .columns = 640});
    for (const auto& instant : sequence.instants) {
      Frame frame{.index = instant.index, .stamp = instant.stamp};
      frame.pose.positions = instant.joints;
      std::optional<KeptFrame> wanted = kept.pass(frame);
      if (!wanted) continue;
      const KeptFrame& seen = *instant.seen;
      if (seen.mask.empty())
        wanted->color = kept.image_of(seen.color.view());
      else
        wanted->mask = kept.image_of(seen.mask.view());
      kept.add(*std::move(wanted));
    }
    return diagnose(kept.frames(), kept.camera(), kept.raw_camera(), *sequence.robot,
                    sequence.parent, sequence.T_parent_camera);
  }
  Camera camera = sequence.camera;
  camera.parent = sequence.robot->links()[sequence.parent];
  camera.T_parent_camera = sequence.T_parent_camera;
  Pipeline pipeline(*sequence.robot, camera);
  SetupCheck check(pipeline.robot(), sequence.camera, sequence.parent);
  Image<float> depth;
  for (const auto& instant : sequence.instants) {
    depth = instant.seen->depth;
    for (std::size_t i = 0; i < depth.size(); ++i)
      depth.data()[i] *= static_cast<float>(sequence.depth_factor);
    const FrameReport& report = pipeline.process({.index = instant.index,
                                                  .stamp = instant.stamp,
                                                  .depth = depth.view(),
                                                  .pose = {.positions = instant.joints}});
    check.add(report, instant.joints);
  }
  return check.diagnose();
}

Outcome outcome_of(const Sequence& sequence) {
  const auto start = std::clock();
  Outcome outcome;
  outcome.diagnosis = diagnosis_of(sequence);
  outcome.seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  return outcome;
}

Sequence recorded(const std::filesystem::path& path) {
  io::InputOptions options;
  options.path = path;
  options.with_color = true;
  options.needs_depth = false;
  io::RunInput input = io::open_input(options, [](const std::string&) {});
  Sequence sequence;
  sequence.name = path.stem().string();
  sequence.robot = std::make_shared<Robot>(std::move(input.robot));
  sequence.camera = *input.camera;
  sequence.parent = find_camera_parent(*sequence.robot, input.camera->parent);
  sequence.T_parent_camera = input.camera->pose();
  const auto source = input.frames();
  Frame frame;
  while (source->next(frame)) {
    KeptFrame seen;
    if (input.config.has_depth) {
      seen.depth = metres_of(frame.depth.view, {});
    } else {
      const ImageView<const Rgb8>& color = frame.color.view;
      seen.color = Image<Rgb8>(color.width, color.height);
      std::copy_n(color.data, seen.color.size(), seen.color.data());
    }
    sequence.instants.push_back({sequence.instants.size(), frame.stamp, frame.pose.positions,
                                 std::make_shared<KeptFrame>(std::move(seen))});
  }
  return sequence;
}

Sequence simulated(const RobotChoice& choice, const Setup& setup, std::uint64_t seed) {
  Cell cell(choice, setup, seed);
  Sequence sequence;
  sequence.name = choice.name + (setup.speed > 0.0 ? ", moving" : ", poses") +
                  (setup.on_hand ? ", on hand" : "") + (setup.tool ? ", tool" : "") +
                  (setup.person ? ", person" : "") + (setup.object ? ", object" : "") + " " +
                  std::to_string(seed);
  sequence.robot = std::make_shared<Robot>(cell.robot());
  sequence.camera.intrinsics = Cell::intrinsics();
  if (setup.on_hand) sequence.parent = *cell.robot().find_link(choice.flange);
  sequence.T_parent_camera = cell.truth();
  if (setup.speed > 0.0) {
    cell.start_swing();
    for (std::size_t i = 0; i < setup.frames; ++i) {
      KeptFrame frame;
      frame.index = i;
      const double seconds = static_cast<double>(i) / 30.0;
      frame.joints = cell.joints_at(seconds);
      cell.draw(frame);
      if (setup.masks) cell.draw_mask(frame);
      if (setup.colors) cell.draw_colors(frame);
      std::vector<double> joints = frame.joints;
      sequence.instants.push_back({i, static_cast<std::int64_t>(1e9 * seconds), std::move(joints),
                                   std::make_shared<KeptFrame>(std::move(frame))});
    }
    return sequence;
  }
  for (KeptFrame& frame : cell.frames())
    sequence.instants.push_back(
        {frame.index, {}, frame.joints, std::make_shared<KeptFrame>(std::move(frame))});
  return sequence;
}

/// Spoils a sequence; returns what was done, or nothing if this mistake cannot be made here.
using Cause = Diagnosis::Cause;
using Mistake = std::function<std::string(Sequence&, sim::Random&)>;
struct Fault {
  std::string name;
  Cause cause;
  Mistake make;
};

Eigen::Vector3d any(sim::Random& random) {
  return Eigen::Vector3d(random.normal(), random.normal(), random.normal()).normalized();
}

double log_uniform(sim::Random& random, double from, double to) {
  return from * std::pow(to / from, random.uniform(0.0, 1.0));
}

std::size_t pick(sim::Random& random, std::size_t count) {
  return std::min(count - 1, static_cast<std::size_t>(random.uniform(0.0, 1.0) * count));
}

std::vector<Fault> faults() {
  const auto pose = [](double least, double most, double least_turn, double most_turn) -> Mistake {
    return [=](Sequence& s, sim::Random& random) {
      const double by = log_uniform(random, least, most),
                   turn = log_uniform(random, least_turn, most_turn);
      s.T_parent_camera.translation() += by * any(random);
      s.T_parent_camera.linear() =
          s.T_parent_camera.linear() * Eigen::AngleAxisd(turn * degree, any(random)).matrix();
      return number(1e3 * by, 0) + " mm, " + number(turn, 1) + " degrees";
    };
  };
  const auto matrix = [](Eigen::Matrix3d R) -> Mistake {
    return [=](Sequence& s, sim::Random&) {
      s.T_parent_camera.linear() = s.T_parent_camera.linear() * R;
      return std::string("axes");
    };
  };
  const auto depth = [](double factor) -> Mistake {
    return [=](Sequence& s, sim::Random&) {
      s.depth_factor = factor;
      return "times " + number(factor, 3);
    };
  };
  const auto focal = [](double sx, double sy, double sc) {
    return [=](Sequence& s, sim::Random&) {
      const Intrinsics right = s.camera.intrinsics;
      const Intrinsics& wrong = s.camera.intrinsics =
          Intrinsics(right.width(), right.height(), sx * right.fx(), sy * right.fy(),
                     sc * (right.cx() + 0.5) - 0.5, sc * (right.cy() + 0.5) - 0.5);
      return "f " + number(wrong.fx(), 0) + ", cx " + number(wrong.cx(), 0);
    };
  };
  Eigen::Matrix3d optical_body, gl;
  optical_body << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  gl << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  return {
      {"camera 8 to 30 mm, 0.5 to 2 degrees off", Cause::camera_pose, pose(0.008, 0.03, 0.5, 2)},
      {"camera 30 to 100 mm, 1 to 10 degrees off", Cause::camera_pose, pose(0.03, 0.1, 1, 10)},
      {"camera 100 to 300 mm, 5 to 20 degrees off", Cause::camera_pose, pose(0.1, 0.3, 5, 20)},
      {"camera only turned, 0.5 to 20 degrees", Cause::camera_pose, pose(1e-6, 2e-6, 0.5, 20)},
      {"camera only moved, 8 to 300 mm", Cause::camera_pose, pose(0.008, 0.3, 1e-6, 2e-6)},
      {"translation in mm", Cause::camera_unit,
       [](Sequence& s, sim::Random&) {
         s.T_parent_camera.translation() *= 1000;
         return std::string("mm");
       }},
      {"rotation transposed", Cause::camera_transposed,
       [](Sequence& s, sim::Random&) {
         s.T_parent_camera.linear() = s.T_parent_camera.linear().transpose().eval();
         return std::string("transposed");
       }},
      {"body frame", Cause::camera_axes, matrix(optical_body)},
      {"OpenGL frame", Cause::camera_axes, matrix(gl)},
      {"pose inverted", Cause::camera_inverted,
       [](Sequence& s, sim::Random&) {
         s.T_parent_camera = s.T_parent_camera.inverse();
         return std::string("inverted");
       }},
      {"depth in 0.1 mm", Cause::depth_unit, depth(10)},
      {"depth in 0.25 mm", Cause::depth_unit, depth(4)},
      {"depth in mm read as m", Cause::depth_unit, depth(1000)},
      {"joints in degrees", Cause::joint_unit,
       [](Sequence& s, sim::Random&) {
         for (auto& instant : s.instants)
           for (double& joint : instant.joints) joint /= degree;
         return std::string("degrees");
       }},
      {"sign of a joint", Cause::joint_sign,
       [](Sequence& s, sim::Random& random) {
         const std::size_t j = pick(random, s.instants[0].joints.size());
         for (auto& instant : s.instants) instant.joints[j] = -instant.joints[j];
         return s.robot->variables()[j];
       }},
      {"zero of a joint, 3 to 180 degrees", Cause::joint_zero,
       [](Sequence& s, sim::Random& random) {
         const std::size_t j = pick(random, s.instants[0].joints.size());
         const double by = log_uniform(random, 3.0, 180.0) * (random.uniform(0, 1) < 0.5 ? -1 : 1);
         for (auto& instant : s.instants) instant.joints[j] += by * degree;
         return s.robot->variables()[j] + " by " + number(by, 1);
       }},
      {"two joints exchanged", Cause::joint_order,
       [](Sequence& s, sim::Random& random) {
         const std::size_t n = s.instants[0].joints.size();
         const std::size_t i = pick(random, n), j = (i + 1 + pick(random, n - 1)) % n;
         for (auto& instant : s.instants) std::swap(instant.joints[i], instant.joints[j]);
         return s.robot->variables()[i] + " and " + s.robot->variables()[j];
       }},
      {"joint rows shifted by 1 to 3", Cause::joint_time,
       [](Sequence& s, sim::Random& random) {
         const int by = static_cast<int>(pick(random, 3)) + 1;
         const int shift = random.uniform(0, 1) < 0.5 ? -by : by;
         const int n = static_cast<int>(s.instants.size());
         std::vector<std::vector<double>> rows;
         for (int i = 0; i < n; ++i)
           rows.push_back(s.instants[static_cast<std::size_t>(((i + shift) % n + n) % n)].joints);
         for (int i = 0; i < n; ++i)
           s.instants[static_cast<std::size_t>(i)].joints = rows[static_cast<std::size_t>(i)];
         return "by " + std::to_string(shift);
       }},
      {"K of half the resolution", Cause::intrinsics, focal(0.5, 0.5, 0.5)},
      {"K of 1.5 times the resolution", Cause::intrinsics, focal(1.5, 1.5, 1.5)},
      {"K of 1/1.5 times the resolution", Cause::intrinsics, focal(1 / 1.5, 1 / 1.5, 1 / 1.5)},
      {"f 640 for 908", Cause::intrinsics, focal(640.0 / 908, 640.0 / 908, 1.0)},
      {"f 908 for 640", Cause::intrinsics, focal(908.0 / 640, 908.0 / 640, 1.0)},
      {"right", Cause::none, [](Sequence&, sim::Random&) { return std::string(); }},
  };
}

int study_all(int argc, char** argv) {
  const std::string kind = argc > 1 ? argv[1] : "";
  const bool by_color = kind == "images", by_masks = kind == "masks";
  if (by_color || by_masks) --argc, ++argv;
  const auto is_of_depth = [](Cause cause) {
    return cause == Cause::depth_unit || cause == Cause::depth_scale || cause == Cause::depth_ray;
  };
  const int times = argc > 1 ? std::stoi(argv[1]) : 5;
  const std::uint64_t first_seed = argc > 4 ? std::stoull(argv[4]) : 100;
  const std::string wanted = argc > 2 ? argv[2] : "", only = argc > 3 ? argv[3] : "";
  std::vector<Sequence> cells;
  const auto is_wanted = [&](const std::string& name) {
    return name.find(only) != std::string::npos;
  };
  const std::filesystem::path data = data_folder();
  if (by_color) {
    for (const char* path : {"ur3e_webcam_1", "ur3e_webcam_4"})
      if (is_wanted(path)) cells.push_back(recorded(data / path));
  } else if (!by_masks) {
    for (const char* path : {"xarm7_realsense", "xarm7_realsense_2"})
      if (is_wanted(path)) cells.push_back(recorded(data / path));
  }
  std::uint64_t seed = 1;
  const int rounds = argc > 5 ? std::stoi(argv[5]) : 1;
  std::vector<RobotChoice> choices = robots();
  std::vector<Setup> setups;
  setups.reserve(1000);
  for (int round = 0; round < rounds; ++round)
    for (const RobotChoice& robot : choices)
      for (const bool moves : {false, true}) {
        sim::Random random(++seed, 8);
        const auto chance = [&](double share) { return random.uniform(0.0, 1.0) < share; };
        Setup setup{.name = "", .frames = moves ? 60U : 10U, .speed = moves ? 0.4 : 0.0};
        setup.on_hand = !moves && chance(0.25) && !by_color;
        setup.colors = by_color, setup.masks = by_masks;
        setup.tool = chance(0.4), setup.person = chance(0.3), setup.object = chance(0.3);
        setup.missing = chance(0.3) ? 0.2 : 0.0;
        if (chance(0.33)) {  // a time-of-flight camera
          setup.sensor.quadratic = 0.002;
          setup.sensor.disparity_step = 0.0;
          setup.sensor.edge_mixed = 0.6;
        } else if (chance(0.5)) {  // stereo with a short baseline
          setup.sensor.quadratic *= 2.5;
          setup.sensor.edge_width = 6.0;
        }
        if (is_wanted(robot.name + (moves ? ", moving" : ", poses")))
          cells.push_back(simulated(robot, setups.emplace_back(setup), seed));
      }
  const bool is_verbose = std::getenv("VERBOSE") != nullptr;
  std::vector<std::vector<std::string>> rows{{"mistake", "setups", "named first", "second",
                                              "nothing said", "another alone", "CPU s, mean"}};
  for (const Fault& fault : faults()) {
    if (fault.name.find(wanted) == std::string::npos) continue;
    if ((by_color || by_masks) && is_of_depth(fault.cause)) continue;
    int right = 0, shared = 0, none = 0, wrong = 0, count = 0;
    double longest = 0.0, seconds = 0.0;
    std::uint64_t draw = first_seed;  // each setup and time has its own amount
    for (const Sequence& cell : cells)
      for (int i = 0; i < times; ++i) {
        sim::Random random(draw++, 5);
        Sequence spoiled = cell;
        const std::string done = fault.make(spoiled, random);
        if (done.empty() && fault.cause != Cause::none) continue;
        const Outcome outcome = outcome_of(spoiled);
        ++count;
        const Diagnosis& d = outcome.diagnosis;
        right += d.cause == fault.cause;
        none += d.cause == Cause::none;
        shared += d.cause != fault.cause && d.other == fault.cause && d.other != Cause::none;
        wrong += d.cause != Cause::none && d.cause != fault.cause && d.other != fault.cause;
        longest = std::max(longest, outcome.seconds);
        seconds += outcome.seconds;
        if (is_verbose || d.cause != fault.cause) {
          std::cout << "  " << fault.name << " (" << done << ") in " << cell.name << ": "
                    << number(d.score, 3) << " [" << d.message << "]\n";
        }
      }
    std::cout << fault.name << ": of " << count << " right " << right << ", second " << shared
              << ", nothing " << none << ", wrong " << wrong << "; CPU s mean "
              << number(seconds / std::max(count, 1), 2) << ", most " << number(longest, 2)
              << std::endl;
    rows.push_back({fault.name, std::to_string(count),
                    fault.cause == Cause::none ? "" : std::to_string(right), std::to_string(shared),
                    std::to_string(none), std::to_string(wrong),
                    number(seconds / std::max(count, 1), 1)});
  }
  if (wanted.empty() && only.empty())
    update_page(std::filesystem::path(PENUMBRA_STUDY_ROOT) / "bench/results/diagnosis.txt",
                "diagnosis_" + (kind == "images" || kind == "masks" ? kind : "study"), table(rows));
  return 0;
}

}  // namespace
}  // namespace penumbra::study

int main(int argc, char** argv) {
  try {
    return penumbra::study::study_all(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
}
