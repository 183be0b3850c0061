// SPDX-License-Identifier: Apache-2.0
// A study of silence: plausible wrong inputs must be refused or noted, right ones in unusual forms
// must be neither. Each input is a change, of random amount, of one of three recordings. In full
// 300 of each, else a few.
#include "../support/pixels.hpp"
#include "../support/random.hpp"
#include "../support/run_length.hpp"
#include "real_recording.hpp"

#include <cmath>
#include <iomanip>
#include <iostream>
#include <numbers>
#include <set>
#include <sstream>

#include <io/files/camera_info.hpp>
#include <io/files/csv.hpp>

namespace penumbra::test::silence {
namespace {

using Eigen::Isometry3d;
using Random = std::mt19937_64;
using Depth = Image<std::uint16_t>;

double between(Random& random, double least, double most) {
  return std::uniform_real_distribution(least, most)(random);
}
/// Of random sign.
double off(Random& random, double least, double most) {
  return (random() % 2 == 0 ? 1.0 : -1.0) * between(random, least, most);
}
std::size_t below(Random& random, std::size_t n) { return random() % n; }
bool by_chance(Random& random, std::size_t n = 2) { return below(random, n) == 0; }

std::string exact(const std::vector<double>& numbers, const std::string& between = ",") {
  std::ostringstream text;
  text << std::setprecision(17);
  for (std::size_t i = 0; i < numbers.size(); ++i) text << (i == 0 ? "" : between) << numbers[i];
  return text.str();
}
std::string exact(double number) { return exact(std::vector{number}); }

/// Puts numbers where a text has "$" and their names.
std::string filled(std::string text, const std::map<std::string, double>& numbers) {
  for (const auto& [name, number] : numbers)
    for (std::size_t at = 0; (at = text.find("$" + name)) != std::string::npos;)
      text.replace(at, name.size() + 1, exact(number));
  return text;
}

/// A table of numbers with a header.
struct Table {
  Words header;
  std::vector<Words> rows;

  explicit Table(const fs::path& file) {
    const std::string text = io::read_csv(file);
    io::CsvLines lines(text, {});
    while (lines.next()) {
      Words& row = header.empty() ? header : rows.emplace_back();
      row.assign(lines.cells().begin(), lines.cells().end());
    }
  }
  [[nodiscard]] std::string text() const {
    std::string all = joined(header) + "\n";
    for (const Words& row : rows) all += joined(row) + "\n";
    return all;
  }
  [[nodiscard]] std::size_t first_joint() const { return header[1] == "stamp" ? 2 : 1; }
  /// A joint that moves much of the robot.
  [[nodiscard]] std::size_t some_joint(Random& random) const {
    return first_joint() + below(random, 4);
  }
  template <typename Change>
  void change(std::size_t column, const Change& by) {
    for (Words& row : rows) row[column] = exact(by(std::stod(row[column])));
  }
};

struct Box {
  std::size_t frame;
  double x, y, width, height, score;
  int track;
};

/// A copy of a recording, to be changed.
class Scene {
 public:
  Scene(const fs::path& folder, const std::string& name) : folder_(folder), name_(name) {
    if (is_example()) {
      fs::remove_all(folder_);
      fs::copy(example, folder_, fs::copy_options::recursive);
      return;
    }
    copy_real_recording(name, folder_);
    write_info(info());  // its lists in lines
  }

  void write_info(const std::map<std::string, double>& info) const {
    write_file(path("camera_info.yaml"),
               filled("frame_id: camera_optical_frame\nwidth: $w\nheight: $h\n"
                      "distortion_model: plumb_bob\nd: [0, 0, 0, 0, 0]\n"
                      "k: [$fx, 0, $cx, 0, $fy, $cy, 0, 0, 1]\nr: [1, 0, 0, 0, 1, 0, 0, 0, 1]\n"
                      "p: [$fx, 0, $cx, 0, 0, $fy, $cy, 0, 0, 0, 1, 0]\n",
                      info));
  }
  [[nodiscard]] std::map<std::string, double> info() const {
    const Intrinsics k = io::read_camera_info(path("camera_info.yaml"), false).intrinsics;
    const auto [w, h] = size();
    return {{"w", w}, {"h", h}, {"fx", k.fx()}, {"fy", k.fy()}, {"cx", k.cx()}, {"cy", k.cy()}};
  }
  [[nodiscard]] bool is_example() const { return name_ == "example"; }
  [[nodiscard]] std::string root() const { return is_example() ? "base_link" : "link_base"; }
  [[nodiscard]] fs::path path(const std::string& file) const { return folder_ / file; }
  void edit(const std::string& from, const std::string& to) const {
    edit_file(path("recording.yaml"), from, to);
  }
  /// Adds a body in the robot's hand. `box`: its size.
  void attach(const std::vector<double>& box) const {
    const std::string link = is_example() ? "gripper" : "link7";
    edit("frames:", "attached:\n  - name: part\n    link: " + link + "\n    box: [" + exact(box) +
                        "]\nframes:");
  }

  [[nodiscard]] Table joints() const { return Table(path("joint_states.csv")); }
  void write(const Table& joints) const { write_file(path("joint_states.csv"), joints.text()); }
  [[nodiscard]] Isometry3d pose() const { return io::read_pose_csv(path("camera_pose.csv")); }
  void write(const Isometry3d& pose) const { io::write_pose_csv(path("camera_pose.csv"), pose); }

  [[nodiscard]] fs::path depth(std::size_t frame) const {
    return path((is_example() ? "depth/" : "depth_") + std::to_string(frame) + ".png");
  }
  [[nodiscard]] std::size_t frames() const { return joints().rows.size(); }
  [[nodiscard]] std::array<int, 2> size() const {
    const auto image = read_image<std::uint16_t>(depth(0));
    return {image.width(), image.height()};
  }
  /// `change(image, u, v)`: what a pixel becomes. Images of floats take the place of the others.
  template <typename T, typename Change>
  void each_depth(const Change& change) const {
    for (std::size_t i = 0; i < frames(); ++i) {
      const auto before = read_image<std::uint16_t>(depth(i));
      Image<T> image(before.width(), before.height());
      for (const auto [u, v] : each_pixel(image))
        image(u, v) = static_cast<T>(std::min<double>(65534, change(before, u, v)));
      if constexpr (std::is_same_v<T, float>)
        io::write_npy(path("floats_" + std::to_string(i) + ".npy"), std::as_const(image).view());
      else
        io::write_png(depth(i), std::as_const(image).view());
    }
    if (std::is_same_v<T, float>) name_depth("floats_%d.npy");
  }
  void name_depth(const std::string& pattern) const {
    edit(is_example() ? "depth/%d.png" : "depth_%d.png", pattern);
  }
  [[nodiscard]] std::vector<Box> boxes(Random& random) const {
    const auto [width, height] = size();
    std::vector<Box> all;
    for (std::size_t frame = 0; frame < frames(); ++frame)
      for (int track = 1; track <= 3; ++track) {
        const double w = between(random, 20, width / 4.0), h = between(random, 20, height / 4.0);
        all.push_back({frame, between(random, 0, width - w), between(random, 0, height - h), w, h,
                       between(random, 0.3, 0.99), track});
      }
    return all;
  }

 private:
  fs::path folder_;
  std::string name_;
};

// A detector's file

void scale(std::vector<Box>& boxes, double x, double y) {
  for (Box& box : boxes) box.x *= x, box.width *= x, box.y *= y, box.height *= y;
}

std::string coco(const std::vector<Box>& boxes, std::array<int, 2> size, int first_id = 0) {
  Json images = Json::array(), annotations = Json::array();
  std::set<std::size_t> frames;
  for (const Box& box : boxes) {
    const int id = static_cast<int>(box.frame) + first_id;
    if (frames.insert(box.frame).second)
      images.push_back({{"id", id},
                        {"file_name", "rgb/" + std::to_string(id) + ".jpg"},
                        {"width", size[0]},
                        {"height", size[1]}});
    annotations.push_back({{"image_id", id},
                           {"category_id", 1},
                           {"bbox", {box.x, box.y, box.width, box.height}},
                           {"score", box.score},
                           {"track_id", box.track}});
  }
  return Json{{"images", images},
              {"categories", {{{"id", 1}, {"name", "part"}}}},
              {"annotations", annotations}}
      .dump();
}

std::string table(const std::vector<Box>& boxes) {
  std::string rows = "frame,class,track,x0,y0,x1,y1,score\n";
  for (const Box& box : boxes)
    rows += std::to_string(box.frame) + ",part," + std::to_string(box.track) + "," +
            exact({box.x, box.y, box.x + box.width, box.y + box.height, box.score}) + "\n";
  return rows;
}

std::string mot(const std::vector<Box>& boxes, std::size_t first = 1) {
  std::string rows;
  for (const Box& box : boxes)
    rows += std::to_string(box.frame + first) + "," + std::to_string(box.track) + "," +
            exact({box.x, box.y, box.width, box.height, box.score, -1, -1, -1}) + "\n";
  return rows;
}

void write_yolo(const Scene& scene, std::vector<Box> boxes, std::size_t first,
                const std::function<std::string(const Box&)>& end) {
  const auto [width, height] = scene.size();
  scale(boxes, 1.0 / width, 1.0 / height);
  std::map<std::size_t, std::string> files;
  for (const Box& box : boxes)
    files[box.frame + first] +=
        "0 " + exact({box.x + box.width / 2, box.y + box.height / 2, box.width, box.height}, " ") +
        end(box) + "\n";
  fs::create_directories(scene.path("labels"));
  for (const auto& [frame, text] : files)
    write_file(scene.path("labels/clip_" + std::to_string(frame) + ".txt"), text);
}

Words with(const Scene& scene, const std::string& file, const std::string& text) {
  write_file(scene.path(file), text);
  return {"--targets", scene.path(file)};
}

Words csv_or_mot(Random& random, const Scene& scene, const std::vector<Box>& boxes) {
  return by_chance(random) ? with(scene, "d.csv", table(boxes)) : with(scene, "d.txt", mot(boxes));
}

// Bags

/// Gives the frames stamps, a second apart.
void add_stamps(const Scene& scene) {
  Table joints = scene.joints();
  if (joints.header[1] == "stamp") return;
  joints.header.insert(joints.header.begin() + 1, "stamp");
  for (std::size_t i = 0; i < joints.rows.size(); ++i)
    joints.rows[i].insert(joints.rows[i].begin() + 1,
                          std::to_string(1'700'000'000'000'000'000 + 1'000'000'000LL * i));
  scene.write(joints);
}

/// Returns the arguments of `penumbra run` of the scene's bag.
Words bag_of(const Scene& scene, const std::function<void(TinyBag&)>& edit) {
  add_stamps(scene);
  TinyBag bag = recording_bag(scene.path(""), scene.pose());
  edit(bag);
  bag.sort();
  bag.write_mcap(scene.path("scene.mcap"));
  return Words{scene.path("scene.mcap")} + (scene.is_example() ? example_package : xarm_package());
}

Words bag_of_states(const Scene& scene, const std::function<void(io::JointStateMessage&)>& change) {
  return bag_of(scene, [&](TinyBag& bag) { bag.edit("/joint_states", change); });
}

// Motions

/// Writes a motion of a few seconds from the first frame's positions. Its times and positions are
/// multiplied.
std::string motion(const Scene& scene, Random& random, double time, double position) {
  const Table joints = scene.joints();
  const auto first = static_cast<std::ptrdiff_t>(joints.first_joint());
  std::vector<double> begin, way;
  for (auto cell = joints.rows[0].begin() + first; cell != joints.rows[0].end(); ++cell) {
    begin.push_back(std::stod(*cell));
    way.push_back(way.empty() ? off(random, 0.3, 0.6) : 0.0);
  }
  const double duration = between(random, 1.0, 4.0);
  std::string text = "joint_names: [" +
                     joined({joints.header.begin() + first, joints.header.end()}) + "]\npoints:\n";
  for (int k = 0; k <= 10; ++k) {
    const double at = time * duration * k / 10.0;
    std::vector<double> positions;
    for (std::size_t i = 0; i < begin.size(); ++i)
      positions.push_back(position * (begin[i] + k / 10.0 * way[i]));
    text += "- time_from_start: {sec: " + std::to_string(static_cast<int>(at)) +
            ", nanosec: " + std::to_string(std::llround(1e9 * (at - std::floor(at)))) +
            "}\n  positions: [" + exact(positions) + "]\n";
  }
  return text;
}

Words look_ahead(const Scene& scene, const std::string& motion) {
  write_file(scene.path("plan.yaml"), motion);
  return Words{"look-ahead", scene.path(""), "--trajectory", scene.path("plan.yaml")} +
         with(scene, "t.yaml",
              "targets:\n  - {name: a, point: [0.5, 0.2, 0.3], radius: 0.05, link: " +
                  scene.root() + "}\n");
}

/// A change of a scene. Returns the arguments of `penumbra run`, if they are not the folder alone:
/// options, or another input and options, or another command and all of it.
struct Kind {
  std::string name;
  std::function<Words(Random&, const Scene&)> change;
};

/// `change(random, it)` is of the scene, and may return arguments; or of what it takes: the table
/// of joints, the camera's pose, the boxes of a detector, or each message of joint states of a bag,
/// for which it draws the same.
template <typename F>
Words changed(Random& random, const Scene& scene, const F& change) {
  if constexpr (std::is_invocable_r_v<Words, F, Random&, const Scene&>) {
    return change(random, scene);
  } else if constexpr (std::is_invocable_v<F, Random&, const Scene&>) {
    change(random, scene);
  } else if constexpr (std::is_invocable_v<F, Random&, Table&>) {
    Table joints = scene.joints();
    change(random, joints);
    scene.write(joints);
  } else if constexpr (std::is_invocable_v<F, Random&, Isometry3d&>) {
    Isometry3d pose = scene.pose();
    change(random, pose);
    scene.write(pose);
  } else if constexpr (std::is_invocable_v<F, Random&, std::vector<Box>&>) {
    std::vector<Box> boxes = scene.boxes(random);
    change(random, boxes);
    return csv_or_mot(random, scene, boxes);
  } else {
    return bag_of_states(scene, [&, before = random](auto& state) {
      random = before;
      change(random, state);
    });
  }
  return {};
}

struct Kinds {
  std::vector<Kind> all;

  template <typename F>
  void add(const std::string& name, const F& change) {
    all.push_back(
        {name, [=](Random& random, const Scene& scene) { return changed(random, scene, change); }});
  }
};

std::vector<Kind> wrong_kinds() {
  Kinds kinds;
  kinds.add("degrees", [](Random&, Table& joints) {
    for (std::size_t i = joints.first_joint(); i < joints.header.size(); ++i)
      joints.change(i, [](double q) { return q * 180 / std::numbers::pi; });
  });
  kinds.add("a joint's zero is off", [](Random& random, Table& joints) {
    const double by = off(random, 0.15, 0.6);
    joints.change(joints.some_joint(random), [&](double q) { return q + by; });
  });
  kinds.add("two joints are swapped", [](Random& random, Table& joints) {
    const std::size_t one = joints.first_joint() + below(random, 3);
    std::swap(joints.header[one], joints.header[one + 1]);
  });
  kinds.add("joint names have a prefix", [](Random&, Table& joints) {
    for (std::size_t i = joints.first_joint(); i < joints.header.size(); ++i)
      joints.header[i] = "left/" + joints.header[i];
  });
  kinds.add("a joint is NaN", [](Random& random, Table& joints) {
    joints.change(joints.some_joint(random), [](double) { return std::nan(""); });
  });
  kinds.add("stamps in seconds", [](Random&, const Scene& scene) {
    add_stamps(scene);
    Table joints = scene.joints();
    for (Words& row : joints.rows) row[1] = row[1].substr(0, row[1].size() - 9);
    scene.write(joints);
  });
  kinds.add("the pose is inverted", [](Random&, Isometry3d& pose) { pose = pose.inverse(); });
  kinds.add("the pose is in millimetres",
            [](Random&, Isometry3d& pose) { pose.translation() *= 1000.0; });
  kinds.add("the pose is of the body frame", [](Random&, Isometry3d& pose) {
    Eigen::Matrix3d optical;
    optical << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    pose.linear() = pose.linear() * optical.transpose();
  });
  kinds.add("the camera has moved", [](Random& random, Isometry3d& pose) {
    pose.translation()[static_cast<Eigen::Index>(below(random, 3))] += off(random, 0.05, 0.3);
  });
  kinds.add("the camera has turned", [](Random& random, Isometry3d& pose) {
    const auto axis = Eigen::Vector3d::Unit(static_cast<Eigen::Index>(below(random, 3)));
    pose.rotate(Eigen::AngleAxisd(off(random, 0.05, 0.4), axis));
  });
  kinds.add("another focal length", [](Random& random, const Scene& scene) {
    const double by = by_chance(random) ? between(random, 0.6, 0.85) : between(random, 1.2, 1.6);
    auto info = scene.info();
    info["fx"] *= by, info["fy"] *= by;
    scene.write_info(info);
  });
  kinds.add("cx and cy are swapped", [](Random&, const Scene& scene) {
    auto info = scene.info();
    std::swap(info["cx"], info["cy"]);
    scene.write_info(info);
  });
  kinds.add("depth in another unit", [](Random& random, const Scene& scene) {
    const double by = std::array{0.1, 4.0, 10.0}[below(random, 3)];
    scene.each_depth<std::uint16_t>(
        [&](const Depth& image, int u, int v) { return by * image(u, v); });
  });
  kinds.add("normalised depth", [](Random& random, const Scene& scene) {
    const double farthest = between(random, 3000.0, 10000.0);
    scene.each_depth<float>(
        [&](const Depth& image, int u, int v) { return std::min(1.0, image(u, v) / farthest); });
  });
  kinds.add("depth along the rays", [](Random&, const Scene& scene) {
    scene.each_depth<std::uint16_t>([k = scene.info()](const Depth& image, int u, int v) {
      return image(u, v) *
             std::hypot((u - k.at("cx")) / k.at("fx"), (v - k.at("cy")) / k.at("fy"), 1.0);
    });
  });
  kinds.add("images are mirrored", [](Random&, const Scene& scene) {
    scene.each_depth<std::uint16_t>(
        [](const Depth& image, int u, int v) { return image(image.width() - 1 - u, v); });
  });
  kinds.add("frames of another time", [](Random&, Table& joints) {
    const auto first = static_cast<std::ptrdiff_t>(joints.first_joint());
    const std::vector<Words> rows = joints.rows;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const Words& other = rows[(i + 2) % rows.size()];
      std::copy(other.begin() + first, other.end(), joints.rows[i].begin() + first);
    }
  });
  kinds.add("COCO of resized images", [](Random& random, const Scene& scene) {
    const auto [width, height] = scene.size();
    std::vector<Box> boxes = scene.boxes(random);
    const double by = by_chance(random) ? 2.0 : 0.5;
    scale(boxes, by, by);
    return with(scene, "d.json",
                coco(boxes, {static_cast<int>(by * width), static_cast<int>(by * height)}));
  });
  kinds.add("boxes in fractions", [](Random& random, const Scene& scene) {
    const auto [width, height] = scene.size();
    std::vector<Box> boxes = scene.boxes(random);
    scale(boxes, 1.0 / width, 1.0 / height);
    return by_chance(random, 3) ? with(scene, "d.json", coco(boxes, scene.size()))
                                : csv_or_mot(random, scene, boxes);
  });
  kinds.add("boxes of larger images", [](Random& random, std::vector<Box>& boxes) {
    const double by = between(random, 2.0, 4.0);
    scale(boxes, by, by);
  });
  kinds.add("corners in place of width and height", [](Random& random, const Scene& scene) {
    std::vector<Box> boxes = scene.boxes(random);
    for (Box& box : boxes) box.width += box.x, box.height += box.y;
    return by_chance(random) ? with(scene, "d.json", coco(boxes, scene.size()))
                             : with(scene, "d.txt", mot(boxes));
  });
  kinds.add("detections numbered from another frame", [](Random& random, const Scene& scene) {
    const std::vector<Box> boxes = scene.boxes(random);
    if (by_chance(random, 3)) return with(scene, "d.json", coco(boxes, scene.size(), 1));
    if (by_chance(random)) return with(scene, "d.txt", mot(boxes, 0));
    write_yolo(scene, boxes, 1, [](const Box&) { return ""; });
    return Words{"--targets", scene.path("labels/clip_%d.txt")};
  });
  kinds.add("percent as scores", [](Random& random, const Scene& scene) {
    std::vector<Box> boxes = scene.boxes(random);
    for (Box& box : boxes) box.score *= 100.0;
    write_file(scene.path("d.csv"), table(boxes));
    return with(scene, "t.yaml", "detections: d.csv\nclasses: {part: {min_score: 0.5}}\n");
  });
  kinds.add("a track twice in a frame", [](Random&, std::vector<Box>& boxes) {
    for (Box& box : boxes) box.track = 1;
  });
  kinds.add("a target in millimetres", [](Random& random, const Scene& scene) {
    const auto some = [&](double least, double most) {
      return exact(between(random, least, most));
    };
    const std::string at = some(200, 900) + ", " + some(200, 900) + ", " + some(50, 900);
    const std::string target = by_chance(random)
                                   ? "point: [" + at + "]\n    radius: " + some(10, 100)
                                   : "box3d: [" + at + ", 0, 0, 0, 1]\n    size: [" +
                                         some(30, 300) + ", " + some(30, 300) + ", 80]";
    return with(scene, "t.yaml",
                "targets:\n  - name: a\n    " + target + "\n    link: " + scene.root() + "\n");
  });
  kinds.add("an attached body in millimetres", [](Random& random, const Scene& scene) {
    const double edge = between(random, 40, 300);
    scene.attach({edge, edge, 80});
  });
  kinds.add("a tolerance in millimetres", [](Random& random, const Scene&) {
    return Words{"--tolerance", exact(between(random, 3, 30)) + ",0,0"};
  });
  kinds.add("a motion in milliseconds", [](Random& random, const Scene& scene) {
    return look_ahead(scene, motion(scene, random, 1000.0, 1.0));
  });
  kinds.add("a motion too fast for the robot", [](Random& random, const Scene& scene) {
    return look_ahead(scene, motion(scene, random, between(random, 0.005, 0.02), 1.0));
  });
  kinds.add("a motion in degrees", [](Random& random, const Scene& scene) {
    return look_ahead(scene, motion(scene, random, 1.0, 180.0 / std::numbers::pi));
  });
  kinds.add("a motion without times", [](Random& random, const Scene& scene) {
    return look_ahead(scene, motion(scene, random, 0.0, 1.0));
  });
  kinds.add("joint states without a joint", [](Random& random, io::JointStateMessage& state) {
    const auto joint = static_cast<std::ptrdiff_t>(below(random, 6));
    state.names.erase(state.names.begin() + joint);
    state.positions.erase(state.positions.begin() + joint);
  });
  kinds.add("joint states with other names", [](Random& random, io::JointStateMessage& state) {
    const bool is_prefix = by_chance(random);
    for (std::string& name : state.names) name = is_prefix ? "left/" + name : name + "_position";
  });
  kinds.add("clocks that differ", [](Random& random, io::JointStateMessage& state) {
    state.header.stamp += static_cast<std::int64_t>(1e9 * off(random, 1.3, 30.0));
  });
  kinds.add("a joint twice in a message", [](Random& random, io::JointStateMessage& state) {
    state.names.push_back(state.names[1]);
    state.positions.push_back(state.positions[1] + off(random, 0.1, 0.5));
  });
  kinds.add("frames with a prefix", [](Random&, const Scene& scene) {
    return bag_of(scene, [](TinyBag& bag) {
      bag.rename_frames([](const std::string& frame) { return "robot1/" + frame; });
    });
  });
  return kinds.all;
}

std::vector<Kind> right_kinds() {
  Kinds kinds;
  kinds.add("columns in another order", [](Random& random, Table& joints) {
    const std::size_t first = joints.first_joint();
    for (std::size_t i = joints.header.size() - 1; i > first; --i) {
      const std::size_t other = first + below(random, i - first + 1);
      std::swap(joints.header[i], joints.header[other]);
      for (Words& row : joints.rows) std::swap(row[i], row[other]);
    }
  });
  kinds.add("rows in another order", [](Random& random, Table& joints) {
    if (joints.header[1] != "stamp") std::shuffle(joints.rows.begin(), joints.rows.end(), random);
  });
  kinds.add("a pose of six digits", [](Random&, const Scene& scene) {
    std::ostringstream text;
    text << scene.pose().matrix().format({6, Eigen::DontAlignCols, " , ", "\r\n"});
    write_file(scene.path("camera_pose.csv"), text.str());
  });
  kinds.add("intrinsics of other programs", [](Random& random, const Scene& scene) {
    const std::array forms{
        "%YAML:1.0\n---\ncalibration_time: \"Sat 28 Nov 2026\"\nimage_width: $w\n"
        "image_height: $h\nboard_width: 9\ncamera_matrix: !!opencv-matrix\n   rows: 3\n"
        "   cols: 3\n   dt: d\n   data: [ $fx, 0., $cx, 0., $fy, $cy, 0., 0., 1. ]\n"
        "distortion_coefficients: !!opencv-matrix\n   rows: 5\n   cols: 1\n   dt: d\n"
        "   data: [ 0., 0., 0., 0., 0. ]\navg_reprojection_error: 0.2\n",
        "cam0:\n  camera_model: pinhole\n  distortion_coeffs: [0, 0, 0, 0]\n"
        "  distortion_model: radtan\n  intrinsics: [$fx, $fy, $cx, $cy]\n  resolution: [$w, $h]\n"
        "  rostopic: /camera\n",
        R"({"width": $w, "height": $h, "fx": $fx, "fy": $fy, "ppx": $cx, "ppy": $cy, )"
        R"("model": "distortion.inverse_brown_conrady", "coeffs": [0, 0, 0, 0, 0]})"};
    write_file(scene.path("camera_info.yaml"),
               filled(forms[below(random, forms.size())], scene.info()));
  });
  kinds.add("poses of other programs", [](Random& random, const Scene& scene) {
    const Isometry3d pose = scene.pose();
    const Eigen::Vector3d t = pose.translation();
    const Eigen::Quaterniond q(pose.linear());
    std::ostringstream rows;
    rows << std::setprecision(17) << pose.matrix().topRows<3>();
    const std::array<std::string, 3> forms{
        "parameters:\n  eye_on_hand: false\ntransformation: {x: $tx, y: $ty, z: $tz, qx: $qx, "
        "qy: $qy, qz: $qz, qw: $qw}\n",
        "$tx $ty $tz $qx $qy $qz $qw\n", rows.str() + "\n"};
    write_file(scene.path("camera_pose.csv"),
               filled(forms[below(random, forms.size())], {{"tx", t.x()},
                                                           {"ty", t.y()},
                                                           {"tz", t.z()},
                                                           {"qx", q.x()},
                                                           {"qy", q.y()},
                                                           {"qz", q.z()},
                                                           {"qw", q.w()}}));
  });
  kinds.add("images named by time", [](Random&, const Scene& scene) {
    add_stamps(scene);
    const Table joints = scene.joints();
    for (std::size_t i = 0; i < joints.rows.size(); ++i) {
      const std::string& stamp = joints.rows[i][1];
      const std::string seconds =
          stamp.substr(0, stamp.size() - 9) + "." + stamp.substr(stamp.size() - 9, 6);
      fs::rename(scene.depth(i), scene.path("at_" + seconds + ".png"));
    }
    scene.name_depth("at_%t.png");
  });
  kinds.add("an attached body in metres", [](Random& random, const Scene& scene) {
    const double edge = between(random, 0.02, 0.06);
    scene.attach({edge, edge, edge});
  });
  kinds.add("a motion in seconds", [](Random& random, const Scene& scene) {
    return look_ahead(scene, motion(scene, random, 1.0, 1.0));
  });
  kinds.add("depth in metres", [](Random&, const Scene& scene) {
    scene.each_depth<float>([](const Depth& image, int u, int v) { return 0.001 * image(u, v); });
  });
  kinds.add("depth of another unit with its scale", [](Random&, const Scene& scene) {
    scene.each_depth<std::uint16_t>(
        [](const Depth& image, int u, int v) { return 10 * image(u, v); });
    scene.edit("camera:\n", "camera:\n  depth_scale: 0.0001\n");
  });
  kinds.add("detections in each form", [](Random& random, const Scene& scene) {
    std::vector<Box> boxes = scene.boxes(random);
    switch (below(random, 6)) {
      case 0:
        return with(scene, "d.json", coco(boxes, scene.size()));
      case 1:
        return with(scene, "d.csv", table(boxes));
      case 2:
        return with(scene, "d.txt", mot(boxes));
      case 3:
        for (Box& box : boxes) box.score = -1;
        return with(scene, "d.txt", mot(boxes));
      case 4:
        write_yolo(scene, boxes, 0, [](const Box& box) { return " " + std::to_string(box.track); });
        return Words{"--targets", scene.path("labels/clip_%d.txt")};
      default:
        write_yolo(scene, boxes, 1, [](const Box& box) { return " " + exact(box.score); });
        return with(scene, "t.yaml", "detections: labels/clip_%d.txt\nfirst_frame: 1\n");
    }
  });
  kinds.add("some frames without detections", [](Random& random, std::vector<Box>& boxes) {
    std::erase_if(boxes, [&](const Box& box) { return box.frame > 0 && by_chance(random); });
  });
  kinds.add("boxes that reach out of the image", [](Random& random, const Scene& scene) {
    std::vector<Box> boxes = scene.boxes(random);
    for (std::size_t i = 0; i < boxes.size(); i += 3) boxes[i].x -= 0.5 * boxes[i].width;
    for (std::size_t i = 1; i < boxes.size(); i += 4) boxes[i].y = scene.size()[1] - 10.0;
    return with(scene, "d.csv", table(boxes));
  });
  kinds.add("scores of another scale", [](Random& random, const Scene& scene) {
    std::vector<Box> boxes = scene.boxes(random);
    for (Box& box : boxes) box.score = between(random, -4.0, 30.0);
    return with(scene, "d.txt", mot(boxes));
  });
  kinds.add("targets far away", [](Random& random, const Scene& scene) {
    return with(scene, "t.yaml",
                "targets:\n  - name: a\n    point: [" + exact(off(random, 1, 20)) + ", 0, " +
                    exact(between(random, 5, 40)) + "]\n    radius: 0.5\n");
  });
  kinds.add("a bag", [](Random&, const Scene& scene) { return bag_of(scene, [](TinyBag&) {}); });
  kinds.add("joint states of two topics", [](Random& random, const Scene& scene) {
    const auto cut = static_cast<std::ptrdiff_t>(1 + below(random, 5));
    const std::string first = "/joint_states", second = "/gripper/joint_states";
    const Words line = bag_of(scene, [&](TinyBag& bag) {
      for (TinyBag::Message& message : bag.messages)
        if (message.topic == first) message.log_time -= 1'000'000;
      bag.copy(first, second);
      bag.edit<io::JointStateMessage>(first, [&](auto& state) {
        state.names.resize(static_cast<std::size_t>(cut));
        state.positions.resize(static_cast<std::size_t>(cut));
      });
      bag.edit<io::JointStateMessage>(second, [&](auto& state) {
        state.names.erase(state.names.begin(), state.names.begin() + cut);
        state.positions.erase(state.positions.begin(), state.positions.begin() + cut);
      });
    });
    return line + Words{"--joint-topic", first, "--joint-topic", second};
  });
  kinds.add("joints of other devices", [](Random&, io::JointStateMessage& state) {
    state.names.insert(state.names.begin(), "lift");
    state.positions.insert(state.positions.begin(), 0.3);
  });
  kinds.add("joint states with other names, and the option", [](Random&, const Scene& scene) {
    return bag_of_states(scene,
                         [](auto& state) {
                           for (std::string& name : state.names) name = "left/" + name + "_pos";
                         }) +
           Words{"--joint-names", "left/*_pos=*"};
  });
  kinds.add("clocks that differ, and the option", [](Random& random, const Scene& scene) {
    const double by = off(random, 0.1, 9.0);
    return bag_of_states(scene,
                         [&](auto& state) { state.header.stamp += std::llround(1e9 * by); }) +
           Words{"--time-offset", exact(by)};
  });
  kinds.add("images that come late", [](Random& random, const Scene& scene) {
    const auto by = static_cast<std::int64_t>(1e9 * between(random, 0.05, 0.8));
    return bag_of(scene, [&](TinyBag& bag) {
      for (TinyBag::Message& message : bag.messages)
        if (message.topic == "/camera/depth/image") message.log_time += by;
    });
  });
  kinds.add("the same joint twice with one position", [](Random&, io::JointStateMessage& state) {
    state.names.push_back(state.names[1]);
    state.positions.push_back(state.positions[1]);
  });
  return kinds.all;
}

class Silence : public FolderTest {
 protected:
  /// Calls `call` for each kind on each recording, `rounds` times; unless it is a full run, for a
  /// fourth of the kinds on the shipped recording.
  template <typename Call>
  void for_each(const std::vector<Kind>& kinds, int rounds, const Call& call) const {
    Words names = {"example"};
    if (fs::exists(data_folder() / "xarm7_realsense"))
      names = names + Words{"xarm7_realsense", "xarm7_realsense_2"};
    if (!is_full_run())
      for (std::size_t i = 0; i < kinds.size(); i += 4) call(names.front(), kinds[i]);
    else
      for (int round = 0; round < rounds; ++round)
        for (const Kind& kind : kinds)
          for (const std::string& name : names) call(name, kind);
  }

  /// Runs a changed scene. Lines of stderr that the unchanged scene has, too, are left out.
  Outcome run(const std::string& name, const Kind* kind, Random& random) {
    const Scene scene(path("scene"), name);
    Words arguments;
    if (kind != nullptr) arguments = kind->change(random, scene);
    if (!arguments.empty() && arguments.front() == "look-ahead")
      return penumbra(arguments + Words{"-o", path("ahead")});
    if (arguments.empty() || arguments.front().starts_with('-'))
      arguments = Words{path("scene")} + arguments;
    return penumbra(Words{"run"} + arguments + Words{"-o", out(), "--force"});
  }

  Words notes_of(const std::string& name, const Outcome& outcome) {
    Random none;
    if (!usual_.contains(name)) usual_[name] = run(name, nullptr, none).err;
    Words notes;
    std::istringstream lines(outcome.err);
    for (std::string line; std::getline(lines, line);)
      if (usual_[name].find(line) == std::string::npos && !line.starts_with("penumbra: target '"))
        notes.push_back(line);  // what a target's verdict is says nothing of the input
    return notes;
  }

  std::map<std::string, std::string> usual_;  // stderr of the unchanged scenes
};

TEST_F(Silence, WrongInputsAreNamed) {
  Random random = seeded_random(58);
  std::size_t inputs = 0;
  Words silent;
  for_each(wrong_kinds(), 4, [&](const std::string& name, const Kind& kind) {
    const Outcome outcome = run(name, &kind, random);
    ++inputs;
    EXPECT_TRUE(outcome.status == 0 || outcome.status == 2) << kind.name << outcome.err;
    if (outcome.status == 0 && notes_of(name, outcome).empty())
      silent.push_back(name + ": " + kind.name);
  });
  std::cout << silent.size() << " of " << inputs << " wrong inputs are silent\n";
  for (const std::string& line : silent) std::cout << "silent: " << line << '\n';
  EXPECT_LT(static_cast<double>(silent.size()), 0.02 * static_cast<double>(inputs));
}

TEST_F(Silence, RightInputsAreNeitherRefusedNorNoted) {
  Random random = seeded_random(59);
  std::size_t inputs = 0, refused = 0, noted = 0;
  for_each(right_kinds(), 6, [&](const std::string& name, const Kind& kind) {
    const Outcome outcome = run(name, &kind, random);
    ++inputs;
    refused += outcome.status != 0;
    const Words notes = notes_of(name, outcome);
    noted += !notes.empty();
    for (const std::string& line : notes)
      std::cout << name << ": " << kind.name << ": " << line << '\n';
  });
  std::cout << inputs << " right inputs: " << refused << " refused, " << noted << " noted\n";
  EXPECT_EQ(refused, 0U);
  EXPECT_LT(static_cast<double>(noted), 0.01 * static_cast<double>(inputs));
}

}  // namespace
}  // namespace penumbra::test::silence
