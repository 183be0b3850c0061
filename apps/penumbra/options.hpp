// SPDX-License-Identifier: Apache-2.0
// Options of the command line. A text that cannot be read is an InputError that names the option
// and what is wanted.
#pragma once

#include <algorithm>
#include <cctype>
#include <concepts>
#include <filesystem>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include <apps/penumbra/commands.hpp>
#include <apps/penumbra/run_cameras.hpp>
#include <io/files/numbers.hpp>

namespace penumbra::app {

[[noreturn]] void refuse_option(const std::string& option, const std::string& value,
                                const std::string& wanted);

/// Makes a command that this build lacks: whatever its arguments are, it throws InputError with
/// `why`.
[[nodiscard]] Execute refuse_command(CLI::App& app, const char* why);

/// Splits NAME=VALUE at the first '='.
[[nodiscard]] std::pair<std::string, std::string> to_pair(const std::string& option,
                                                          const std::string& text,
                                                          const std::string& wanted);

/// Adds an option that may be given once and whose text `take` reads.
template <typename Take>
CLI::Option* add_option(CLI::App& app, const std::string& names, const std::string& help,
                        const std::string& value, Take take) {
  return app.add_option_function<std::string>(names, take, help)->type_name(value)->expected(1);
}

/// The same for an option that may be given several times.
template <typename Take>
CLI::Option* add_list(CLI::App& app, const std::string& names, const std::string& help,
                      const std::string& value, Take take) {
  return app
      .add_option_function<std::vector<std::string>>(
          names,
          [take](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) take(text);
          },
          help)
      ->type_name(value)
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

/// Adds an option with a text that is not empty. T: a string, a path or an optional one.
template <typename T>
CLI::Option* add_text(CLI::App& app, const std::string& names, const std::string& help,
                      const std::string& value, T& to) {
  return add_option(app, names, help, value, [&to, names, value](const std::string& text) {
    if (text.empty()) refuse_option(names, text, value.empty() ? "a path" : "a " + value);
    to = text;
  });
}

/// Adds an option with a number within bounds. To: T or an optional T.
template <typename T, typename To>
CLI::Option* add_number(CLI::App& app, const std::string& names, const std::string& help,
                        const std::string& unit, To& to, T least, T most) {
  return add_option(app, names, help, unit, [&to, names, least, most](const std::string& text) {
    const auto value = io::parse_number<T>(text);
    if (value && *value >= least && *value <= most) {
      to = *value;
      return;
    }
    std::ostringstream wanted;
    wanted << (std::floating_point<T> ? "a number" : "a whole number") << " from " << least
           << " to " << most;
    refuse_option(names, text, wanted.str());
  });
}

/// Adds an option with any finite number that T holds.
template <typename T>
void add_number(CLI::App& app, const std::string& names, const std::string& help,
                const std::string& unit, T& to) {
  using Limits = std::numeric_limits<T>;
  add_number(app, names, help, unit, to, Limits::lowest(), Limits::max());
}

/// Adds an option with one of several names. To: T or an optional T.
template <typename T, typename To>
CLI::Option* add_choice(CLI::App& app, const std::string& names, const std::string& help, To& to,
                        const std::vector<std::pair<std::string, T>>& choices) {
  return add_option(app, names, help, "NAME", [&to, names, choices](const std::string& text) {
    std::string known;
    for (const auto& [name, choice] : choices) {
      if (name == text) {
        to = choice;
        return;
      }
      known += (known.empty() ? "" : ", ") + name;
    }
    refuse_option(names, text, "one of " + known);
  });
}

// Options that several commands have.
void add_packages(CLI::App& app, std::map<std::string, std::filesystem::path>& packages,
                  std::map<std::string, std::string>& arguments);
void add_renderer(CLI::App& app, Backend& backend, RendererOptions& renderer);
void add_links(CLI::App& app, std::vector<ExtraMesh>& extra,
               std::vector<std::string>& ignore_links);
/// Positions at which joints are held.
void add_joints(CLI::App& app, std::map<std::string, double>& joints);
void add_leniency(CLI::App& app, bool& allow_missing_meshes, bool& geometry_fallback);
void add_frames(CLI::App& app, io::FrameRange& frames);

/// What is drawn of a robot. `Drawn`: RobotOptions or io::InputOptions.
template <typename Drawn>
void add_drawn(CLI::App& app, Drawn& drawn, const std::string& default_geometry) {
  add_choice<Geometry>(app, "--geometry",
                       "collision or visual; default: " + default_geometry +
                           ", and visual for links that have no other",
                       drawn.geometry,
                       {{"collision", Geometry::collision}, {"visual", Geometry::visual}});
  add_links(app, drawn.extra, drawn.ignore_links);
  add_leniency(app, drawn.allow_missing_meshes, drawn.geometry_fallback);
  if constexpr (std::is_same_v<Drawn, io::InputOptions>) add_joints(app, drawn.joints);
}

void add_robot(CLI::App& app, RobotOptions& options);

/// Texts in the help of a bag's options.
struct BagHelp {
  std::string group = "Of bags";
  std::string joints = "/joint_states, or the only one";  ///< default of --joint-topic
  std::string poses = "joints, else tf";                  ///< default of --poses
  bool time_offset = true;                                ///< has --time-offset S
  std::string sensor = "camera", frame = "optical frame", data = "images";
};

/// How run, tune, view and live judge frames: renderer, geometry, tolerance, labels.
void add_session(CLI::App& app, io::SessionOptions& session,
                 const std::string& geometry_default = "the recording's, else collision");
/// Adds an option for each setting of a struct: front_min_width as --front-min-width. `take` gets
/// the setting and its numbers, and returns whether they are a value of it.
template <typename Struct, typename Take>
void add_settings(CLI::App& app, Take take) {
  for_each_setting<Struct>([&]<typename Value>(const Setting<Struct, Value>& setting) {
    std::string option = std::string("--") + setting.name;
    std::replace(option.begin(), option.end(), '_', '-');
    std::string value = !NumberSetting<Value> ? "A,B,C" : *setting.unit != 0 ? setting.unit : "N";
    std::ranges::transform(value, value.begin(), [](unsigned char c) { return std::toupper(c); });
    add_option(app, option, setting.meaning, value,
               [take, setting, option](const std::string& text) {
                 if (!take(setting, io::parse_numbers(text)))
                   refuse_option(option, text, expected_of(setting));
               });
  });
}

/// How a bag says where the robot is, and options in place of that.
void add_bag_robot(CLI::App& app, io::BagOptions& bag, const BagHelp& help = {});
/// Which topics run, tune, view and live use, and values that they lack.
void add_bag(CLI::App& app, io::BagOptions& bag, const BagHelp& help = {});

/// An input of camera images, and which camera of a recording.
void add_path(CLI::App& app, io::InputOptions& input);
void add_input(CLI::App& app, io::InputOptions& input);
/// Which frames and targets are judged, in which images.
void add_sequence(CLI::App& app, io::SessionOptions& session);
/// Checks what run, tune and view have in common.
void check_session(const CLI::App& app, io::SessionOptions& session);
/// The same of view-planning and look-ahead.
void check_planned(const CLI::App& app, io::InputOptions& input);

/// Adds a camera. Refuses a name below which results cannot come, and one that is given already.
void add_camera(std::vector<NamedCamera>& cameras, const std::string& name,
                const std::string& depth_topic);

/// Notes which option of bags was given.
void note_bag_option(const CLI::App& app, io::InputOptions& input);

/// Refuses options that the chosen renderer does not use.
void check_renderer(Backend backend, const RendererOptions& options);

}  // namespace penumbra::app
