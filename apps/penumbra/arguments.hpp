// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <penumbra/labels/labels.hpp>
#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/pipeline/pose_lookup.hpp>
#include <penumbra/robot/robot.hpp>

#include <io/dds/participant.hpp>
#include <io/web/web_server.hpp>
#include <sim/simulation.hpp>

namespace penumbra::app {

/// Which images `run` writes beside the report.
struct Saves {
  bool vdi = false, labels = false, links = false, overlay = false, filtered = false,
       points = false;
  bool operator==(const Saves&) const = default;
};

/// Frames first <= index < end; what is not set is the recording's own end.
struct FrameRange {
  std::optional<std::int64_t> first, end;
};

struct RendererArguments {
  Backend backend = Backend::cpu;
  bool is_named = false;  ///< the backend, by --renderer
  RendererOptions options;
};

/// What is said of a bag on the command line. Topics are found by type and name where not given.
struct BagArguments {
  std::optional<std::string> depth_topic, camera_info_topic, color_topic;
  std::vector<std::string> joint_topics, target_topics;
  std::optional<PoseSource> poses;             ///< nothing: joints, or tf where there are none
  std::optional<std::filesystem::path> robot;  ///< in place of /robot_description
  std::map<std::string, std::filesystem::path> packages;
  std::string frame_prefix;                   ///< before link names in tf, without a leading "/"
  std::optional<std::string> camera_frame;    ///< in place of the images' frame_id
  std::optional<std::string> parent;          ///< link that the camera sits on
  std::optional<std::filesystem::path> pose;  ///< of the camera in that link, in place of tf's
  bool rectified = false;
  bool first_publisher = false;  ///< publishers of one joint are not compared
  double time_offset = 0.0;      ///< FrameQueueOptions::time_offset
  std::string given;             ///< one of the options that were given; empty: none
  // What --help says of these options.
  std::string group = "Of bags";
  std::string joints_default = "/joint_states, or the only one";
  std::string poses_default = "joints, else tf";
};

struct RunArguments {
  std::filesystem::path input;
  std::filesystem::path output;
  RendererArguments renderer;
  std::optional<Geometry> geometry;
  std::string geometry_default = "the recording's, else collision";  ///< in --help
  bool geometry_fallback = false;     ///< as in RobotOptions, on top of the recording's
  bool allow_missing_meshes = false;  ///< likewise
  std::vector<ExtraMesh> extra;       ///< likewise
  std::optional<Tolerance> tolerance;
  std::optional<int> front_min_width;  ///< pixels
  std::optional<int> fringe_reach;     ///< pixels
  std::optional<std::string> sensor;   ///< of LabelRule::for_sensor
  bool paper_labels = false;
  ImageSpace image = ImageSpace::raw;
  FrameRange frames;
  std::optional<double> fps;  ///< of a recording without stamps, 1/s
  Saves saves;
  std::string points_frame;  ///< link that points are given in; empty: the optical frame
  std::optional<std::filesystem::path> targets;  ///< in place of the recording's
  bool no_targets = false;                       ///< not the recording's either
  bool report_page = false;                      ///< report.html, too
  bool force = false;                            ///< into a folder that holds other files, too
  bool is_shown = false;                         ///< in the viewer
  BagArguments bag;

  /// Whether pictures are made, which want the recorded colour.
  [[nodiscard]] bool needs_color() const {
    return saves.overlay || saves.points || report_page || is_shown;
  }
};

struct RenderArguments {
  std::filesystem::path robot;
  RobotOptions options;
  std::filesystem::path camera_info;
  bool rectified = false;  ///< the images are free of distortion: p of camera_info is the camera
  std::filesystem::path pose;
  std::string parent;
  std::vector<std::pair<std::string, double>> joints;  ///< name and value, as they were given
  std::filesystem::path output;
  std::optional<std::filesystem::path> links;
  RendererArguments renderer;
  int repeat = 1;
  bool json = false;
};

struct InspectArguments {
  std::filesystem::path robot;
  RobotOptions options;
  bool json = false;
};

struct TuneArguments {
  RunArguments judging;  ///< its input and output, what is drawn, the current rule
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
  FrameRange frames;
  sim::SimulationOptions options;
};

/// Where the viewer's page is served.
struct ServerArguments {
  std::optional<std::uint16_t> port;
  std::optional<std::string> address;
};

[[nodiscard]] io::WebOptions web_options(const ServerArguments& server);

struct LiveArguments {
  /// A camera that is named on the command line.
  struct NamedCamera {
    std::string name, depth_topic;
  };

  RunArguments judging;  ///< its renderer, what is drawn, the rule of labels, its topics
  io::ParticipantOptions graph;
  std::vector<NamedCamera> cameras;  ///< empty: one, found by type and name
  std::string name_space;
  std::vector<std::string> remaps;     ///< FROM:=TO
  bool reliable = false;               ///< asked of images, joint states and tf
  int queue = 8;                       ///< images that wait at a time, of each camera
  std::optional<std::string> publish;  ///< names of results; nothing: all
  std::optional<double> duration;      ///< seconds
  std::optional<std::filesystem::path> summary;
  ServerArguments server;  ///< without a port no page is served
};

struct ViewArguments {
  RunArguments judging;  ///< its input: what is shown
  ServerArguments server;
};

using Command = std::variant<RunArguments, RenderArguments, InspectArguments, DoctorArguments,
                             SimulateArguments, TopicsArguments, PlayArguments, LiveArguments,
                             ViewArguments, TuneArguments>;

/// Reads the command line. Prints what --help and --version ask for and then answers nothing.
/// Throws InputError that names the argument.
[[nodiscard]] std::optional<Command> parse_arguments(int argc, const char* const* argv);

}  // namespace penumbra::app
