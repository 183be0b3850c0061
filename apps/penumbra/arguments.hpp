// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/robot/robot.hpp>

#include <io/assembly/cloud_input.hpp>
#include <io/dds/participant.hpp>
#include <io/run/calibration_input.hpp>
#include <io/run/cloud_run.hpp>
#include <io/run/init_recording.hpp>
#include <io/run/input_session.hpp>
#include <io/run/look_ahead_input.hpp>
#include <io/run/output_folder.hpp>
#include <io/run/planning_input.hpp>
#include <io/web/web_server.hpp>
#include <sim/simulation.hpp>

namespace penumbra::app {

/// A camera that is named on the command line.
struct NamedCamera {
  std::string name, depth_topic;
};

struct RunArguments {
  io::SessionOptions session;
  io::OutputOptions output;
  std::vector<NamedCamera> cameras = {};  ///< several of a bag
};

struct RenderArguments {
  std::filesystem::path robot;
  RobotOptions options;
  std::filesystem::path camera_info;
  bool rectified = false;  ///< the images are free of distortion: p of camera_info is the camera
  std::filesystem::path pose;
  std::string parent;
  std::vector<std::pair<std::string, double>> joints;  ///< name and value, in the given order
  std::filesystem::path output;
  std::optional<std::filesystem::path> links;
  Backend backend = Backend::cpu;
  RendererOptions renderer;
  int repeat = 1;
  bool json = false;
};

struct InspectArguments {
  std::filesystem::path robot;
  RobotOptions options;
  bool json = false;
};

struct TuneArguments {
  io::SessionOptions session;  ///< with the current rule
  std::filesystem::path output;
  bool force = false;  ///< advise although the setup looks wrong
};

struct CalibrateArguments {
  io::CalibrationInputOptions input;
  std::filesystem::path output;  ///< empty: nothing is written
  std::optional<std::filesystem::path> initial;
  bool search = false;
  bool focal = false;
  bool joint_offsets = false;  ///< the time offset is in `input`
};

struct ViewPlanningArguments {
  io::PlanningOptions input;
  std::filesystem::path output;  ///< empty: nothing is written
  std::size_t cameras = 1;       ///< of the largest set
  std::optional<int> threads;    ///< null: one per core
};

struct LookAheadArguments {
  io::LookAheadOptions input;
  std::filesystem::path output;  ///< empty: nothing is written
  std::optional<int> threads;    ///< null: one per core
};

struct TopicsArguments {
  io::ParticipantOptions graph;
  double wait = 2.0;  ///< seconds
  bool json = false;
};

struct PlayArguments {
  std::filesystem::path bag;
  io::ParticipantOptions graph;
  double rate = 1.0;
  double start = 0.0;  ///< seconds after the first message
  double delay = 1.0;  ///< seconds before it is published
  bool loop = false;
  std::vector<std::string> topics;   ///< empty: all
  std::vector<std::string> latched;  ///< empty: by their names
  std::map<std::string, std::string> remaps;
  bool restamp = false;
};

struct DoctorArguments {
  bool json = false;
};

struct SimulateArguments {
  std::string scene;
  std::filesystem::path output;
  io::FrameRange frames;
  sim::SimulationOptions options;
};

/// The address of the viewer's page.
struct ServerArguments {
  std::optional<std::uint16_t> port;
  std::optional<std::string> address;
};

[[nodiscard]] io::WebOptions web_options(const ServerArguments& server);

struct CloudArguments {
  io::CloudRunOptions run;
  ServerArguments server;  ///< no page is served without a port
};

struct LiveArguments {
  io::SessionOptions session;  ///< renderer, what is drawn, the rule of labels, topics
  io::ParticipantOptions graph;
  std::vector<NamedCamera> cameras;  ///< empty and no clouds: one, found by type and name
  std::vector<io::CloudInputOptions> clouds;
  std::string name_space;
  std::vector<std::string> remaps;     ///< FROM:=TO
  bool reliable = false;               ///< asked of images, joint states and tf
  int queue = 8;                       ///< images that wait at a time, of each camera
  std::optional<std::string> publish;  ///< names of results; nothing: all
  PointsRule points;
  double points_rate = 0;          ///< see io::LiveOptions
  std::optional<double> duration;  ///< seconds
  std::optional<std::filesystem::path> summary;
  ServerArguments server;  ///< no page is served without a port
};

struct ViewArguments {
  io::SessionOptions session;
  std::string judging_option;  ///< name of an option that was given; empty: none
  ServerArguments server;
};

using Command =
    std::variant<RunArguments, RenderArguments, InspectArguments, DoctorArguments,
                 SimulateArguments, TopicsArguments, PlayArguments, LiveArguments, ViewArguments,
                 TuneArguments, CalibrateArguments, ViewPlanningArguments, LookAheadArguments,
                 CloudArguments, io::InitOptions>;

/// Reads the command line. Returns nothing after --help or --version, which it prints. Throws
/// InputError that names the argument.
[[nodiscard]] std::optional<Command> parse_arguments(int argc, const char* const* argv);

}  // namespace penumbra::app
