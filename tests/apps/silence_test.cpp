// SPDX-License-Identifier: Apache-2.0
// A study of silence: plausible wrong inputs must be refused or noted, right ones in unusual forms
// must be neither. Each input is a change, of random amount, of one of three recordings. In full
// 300 of each, else a few.
#include "../support/data.hpp"
#include "../support/random.hpp"
#include "fixtures.hpp"

#include <cmath>
#include <iomanip>
#include <iostream>
#include <numbers>
#include <set>
#include <sstream>

#include <io/files/camera_info.hpp>
#include <io/files/csv.hpp>
#include <io/files/pose_file.hpp>

namespace penumbra::test::silence {
namespace {

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

std::string exact(double number) {
  std::ostringstream text;
  text << std::setprecision(17) << number;
  return text.str();
}

/// A table of numbers with a header.
struct Table {
  Words header;
  std::vector<Words> rows;

  explicit Table(const fs::path& file) {
    const std::string text = io::read_csv(file);
    io::CsvLines lines(text);
    while (lines.next()) {
      Words& row = header.empty() ? header : rows.emplace_back();
      row.assign(lines.cells().begin(), lines.cells().end());
    }
  }
  [[nodiscard]] std::string text() const {
    std::string all;
    const auto add = [&](const Words& row) {
      for (std::size_t i = 0; i < row.size(); ++i) all += (i == 0 ? "" : ",") + row[i];
      all += "\n";
    };
    add(header);
    for (const Words& row : rows) add(row);
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
    fs::remove_all(folder_);
    if (name == "example") {
      fs::copy(example, folder_, fs::copy_options::recursive);
      return;
    }
    fs::copy(data_folder() / name, folder_, fs::copy_options::recursive);
    const fs::path robots = fs::absolute(data_folder() / "robots/xarm7");
    fs::copy(robots / "xarm7.urdf", path("xarm7.urdf"));
    edit_file(path("recording.yaml"), "../robots/xarm7/xarm7.urdf", "xarm7.urdf");
    edit_file(path("recording.yaml"), "../robots/xarm7/xarm_description",
              robots / "xarm_description");
    write_info(k());  // its lists in lines
  }

  /// Writes a camera_info of the depth images' size.
  void write_info(const std::array<double, 4>& k) const {
    const auto [width, height] = size();
    const auto& [fx, fy, cx, cy] = k;
    std::ostringstream text;
    text << std::setprecision(17) << "frame_id: camera_optical_frame\nwidth: " << width
         << "\nheight: " << height << "\ndistortion_model: plumb_bob\nd: [0, 0, 0, 0, 0]\nk: ["
         << fx << ", 0, " << cx << ", 0, " << fy << ", " << cy << ", 0, 0, 1]\n"
         << "r: [1, 0, 0, 0, 1, 0, 0, 0, 1]\np: [" << fx << ", 0, " << cx << ", 0, 0, " << fy
         << ", " << cy << ", 0, 0, 0, 1, 0]\n";
    write_file(path("camera_info.yaml"), text.str());
  }
  /// fx, fy, cx, cy.
  [[nodiscard]] std::array<double, 4> k() const {
    const Intrinsics all = io::read_camera_info(path("camera_info.yaml"), false).intrinsics;
    return {all.fx(), all.fy(), all.cx(), all.cy()};
  }
  [[nodiscard]] std::string root() const { return name_ == "example" ? "base_link" : "link_base"; }
  [[nodiscard]] std::string last_link() const { return name_ == "example" ? "gripper" : "link7"; }

  [[nodiscard]] fs::path path(const std::string& file) const { return folder_ / file; }
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] Table joints() const { return Table(path("joint_states.csv")); }
  void write(const Table& joints) const { write_file(path("joint_states.csv"), joints.text()); }
  [[nodiscard]] Eigen::Isometry3d pose() const {
    return io::read_pose_csv(path("camera_pose.csv"));
  }
  void write(const Eigen::Isometry3d& pose) const {
    io::write_pose_csv(path("camera_pose.csv"), pose);
  }
  [[nodiscard]] fs::path depth(std::size_t frame) const {
    return path((name_ == "example" ? "depth/" : "depth_") + std::to_string(frame) + ".png");
  }
  [[nodiscard]] std::size_t frames() const { return joints().rows.size(); }
  template <typename Change>
  void each_depth(const Change& change) const {
    for (std::size_t i = 0; i < frames(); ++i) {
      auto image = read_image<std::uint16_t>(depth(i));
      change(image);
      io::write_png(depth(i), std::as_const(image).view());
    }
  }
  [[nodiscard]] std::array<int, 2> size() const {
    const auto image = read_image<std::uint16_t>(depth(0));
    return {image.width(), image.height()};
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
    rows += std::to_string(box.frame) + ",part," + std::to_string(box.track) + "," + exact(box.x) +
            "," + exact(box.y) + "," + exact(box.x + box.width) + "," + exact(box.y + box.height) +
            "," + exact(box.score) + "\n";
  return rows;
}

std::string mot(const std::vector<Box>& boxes, std::size_t first = 1) {
  std::string rows;
  for (const Box& box : boxes)
    rows += std::to_string(box.frame + first) + "," + std::to_string(box.track) + "," +
            exact(box.x) + "," + exact(box.y) + "," + exact(box.width) + "," + exact(box.height) +
            "," + exact(box.score) + ",-1,-1,-1\n";
  return rows;
}

void write_yolo(const Scene& scene, const std::vector<Box>& boxes, std::size_t first,
                const std::function<std::string(const Box&)>& end) {
  const auto [width, height] = scene.size();
  std::map<std::size_t, std::string> files;
  for (const Box& box : boxes)
    files[box.frame + first] += "0 " + exact((box.x + box.width / 2) / width) + " " +
                                exact((box.y + box.height / 2) / height) + " " +
                                exact(box.width / width) + " " + exact(box.height / height) +
                                end(box) + "\n";
  fs::create_directories(scene.path("labels"));
  for (const auto& [frame, text] : files)
    write_file(scene.path("labels/clip_" + std::to_string(frame) + ".txt"), text);
}

Words with(const Scene& scene, const std::string& file, const std::string& text) {
  write_file(scene.path(file), text);
  return {"--targets", scene.path(file)};
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

using EditBag = std::function<void(TinyBag&)>;

/// Returns the arguments of `penumbra run` of the scene's bag.
Words bag_of(const Scene& scene, const EditBag& edit) {
  add_stamps(scene);
  TinyBag bag = recording_bag(scene.path(""), scene.pose());
  edit(bag);
  bag.sort();
  bag.write_mcap(scene.path("scene.mcap"));
  const Words package =
      scene.name() == "example"
          ? example_package
          : Words{"--package",
                  "xarm_description=" + (data_folder() / "robots/xarm7/xarm_description").string()};
  return Words{scene.path("scene.mcap")} + package;
}

template <typename Change>
EditBag joint_states(const Change& change) {
  return [=](TinyBag& bag) { bag.edit<io::JointStateMessage>("/joint_states", change); };
}

void rename_frames(TinyBag& bag, const std::string& prefix) {
  bag.edit<io::TfMessage>("/tf_static", [&](io::TfMessage& message) {
    for (io::TransformMessage& transform : message.transforms) {
      transform.header.frame_id = prefix + transform.header.frame_id;
      transform.child_frame_id = prefix + transform.child_frame_id;
    }
  });
}

// Motions

/// Writes a motion of a few seconds from the first frame's positions. Its times and positions are
/// multiplied.
std::string motion(const Scene& scene, Random& random, double time, double position) {
  const Table joints = scene.joints();
  const std::size_t first = joints.first_joint();
  std::vector<double> begin, end;
  std::string text = "joint_names: [";
  for (std::size_t i = first; i < joints.header.size(); ++i) {
    text += (i == first ? "" : ", ") + joints.header[i];
    begin.push_back(std::stod(joints.rows[0][i]));
    end.push_back(begin.back() + (i == first ? off(random, 0.3, 0.6) : 0.0));
  }
  const double duration = between(random, 1.0, 4.0);
  text += "]\npoints:\n";
  for (int k = 0; k <= 10; ++k) {
    const double at = time * duration * k / 10.0;
    text += "- time_from_start: {sec: " + std::to_string(static_cast<int>(at)) +
            ", nanosec: " + std::to_string(std::llround(1e9 * (at - std::floor(at)))) +
            "}\n  positions: [";
    for (std::size_t i = 0; i < begin.size(); ++i)
      text += (i == 0 ? "" : ", ") + exact(position * (begin[i] + k / 10.0 * (end[i] - begin[i])));
    text += "]\n";
  }
  return text;
}

Words look_ahead(const Scene& scene, const std::string& motion) {
  write_file(scene.path("plan.yaml"), motion);
  write_file(scene.path("t.yaml"),
             "targets:\n  - {name: a, point: [0.5, 0.2, 0.3], radius: 0.05, link: " + scene.root() +
                 "}\n");
  return {"look-ahead", scene.path(""),      "--trajectory", scene.path("plan.yaml"),
          "--targets",  scene.path("t.yaml")};
}

/// A change of a scene. Returns the arguments of `penumbra run`, if they are not the folder alone:
/// options, or another input and options, or another command and all of it.
struct Kind {
  std::string name;
  std::function<Words(Random&, const Scene&)> change;
};

Words no_options() { return {}; }

const std::vector<Kind> wrong_kinds = {
    {"degrees",
     [](Random&, const Scene& scene) {
       Table joints = scene.joints();
       for (std::size_t i = joints.first_joint(); i < joints.header.size(); ++i)
         joints.change(i, [](double q) { return q * 180 / std::numbers::pi; });
       scene.write(joints);
       return no_options();
     }},
    {"a joint's zero is off",
     [](Random& random, const Scene& scene) {
       Table joints = scene.joints();
       const double by = off(random, 0.15, 0.6);
       joints.change(joints.some_joint(random), [&](double q) { return q + by; });
       scene.write(joints);
       return no_options();
     }},
    {"two joints are swapped",
     [](Random& random, const Scene& scene) {
       Table joints = scene.joints();
       const std::size_t one = joints.first_joint() + below(random, 3);
       std::swap(joints.header[one], joints.header[one + 1]);
       scene.write(joints);
       return no_options();
     }},
    {"joint names have a prefix",
     [](Random&, const Scene& scene) {
       Table joints = scene.joints();
       for (std::size_t i = joints.first_joint(); i < joints.header.size(); ++i)
         joints.header[i] = "left/" + joints.header[i];
       scene.write(joints);
       return no_options();
     }},
    {"a joint is NaN",
     [](Random& random, const Scene& scene) {
       Table joints = scene.joints();
       const std::size_t column = joints.some_joint(random);
       for (Words& row : joints.rows) row[column] = "nan";
       scene.write(joints);
       return no_options();
     }},
    {"stamps in seconds",
     [](Random&, const Scene& scene) {
       add_stamps(scene);
       Table joints = scene.joints();
       for (Words& row : joints.rows) row[1] = row[1].substr(0, row[1].size() - 9);
       scene.write(joints);
       return no_options();
     }},
    {"the pose is inverted",
     [](Random&, const Scene& scene) {
       scene.write(scene.pose().inverse());
       return no_options();
     }},
    {"the pose is in millimetres",
     [](Random&, const Scene& scene) {
       Eigen::Isometry3d pose = scene.pose();
       pose.translation() *= 1000.0;
       scene.write(pose);
       return no_options();
     }},
    {"the pose is of the body frame",
     [](Random&, const Scene& scene) {
       Eigen::Matrix3d optical;
       optical << 0, 0, 1, -1, 0, 0, 0, -1, 0;
       Eigen::Isometry3d pose = scene.pose();
       pose.linear() = pose.linear() * optical.transpose();
       scene.write(pose);
       return no_options();
     }},
    {"the camera has moved",
     [](Random& random, const Scene& scene) {
       Eigen::Isometry3d pose = scene.pose();
       pose.translation()[static_cast<Eigen::Index>(below(random, 3))] += off(random, 0.05, 0.3);
       scene.write(pose);
       return no_options();
     }},
    {"the camera has turned",
     [](Random& random, const Scene& scene) {
       const auto axis = Eigen::Vector3d::Unit(static_cast<Eigen::Index>(below(random, 3)));
       scene.write(scene.pose() * Eigen::AngleAxisd(off(random, 0.05, 0.4), axis));
       return no_options();
     }},
    {"another focal length",
     [](Random& random, const Scene& scene) {
       const double by =
           below(random, 2) == 0 ? between(random, 0.6, 0.85) : between(random, 1.2, 1.6);
       const auto [fx, fy, cx, cy] = scene.k();
       scene.write_info({fx * by, fy * by, cx, cy});
       return no_options();
     }},
    {"cx and cy are swapped",
     [](Random&, const Scene& scene) {
       const auto [fx, fy, cx, cy] = scene.k();
       scene.write_info({fx, fy, cy, cx});
       return no_options();
     }},
    {"depth in another unit",
     [](Random& random, const Scene& scene) {
       const std::array factors{0.1, 4.0, 10.0};
       const double by = factors[below(random, factors.size())];
       scene.each_depth([&](Depth& image) {
         for (std::size_t i = 0; i < image.size(); ++i)
           image.data()[i] = static_cast<std::uint16_t>(std::min(65534.0, by * image.data()[i]));
       });
       return no_options();
     }},
    {"normalised depth",
     [](Random& random, const Scene& scene) {
       const double farthest = between(random, 3000.0, 10000.0);
       scene.each_depth([](Depth&) {});
       for (std::size_t i = 0; i < scene.frames(); ++i) {
         const auto image = read_image<std::uint16_t>(scene.depth(i));
         Image<float> normal(image.width(), image.height());
         for (std::size_t k = 0; k < image.size(); ++k)
           normal.data()[k] = static_cast<float>(std::min(1.0, image.data()[k] / farthest));
         io::write_npy(scene.path("normal_" + std::to_string(i) + ".npy"),
                       std::as_const(normal).view());
       }
       edit_file(scene.path("recording.yaml"),
                 scene.name() == "example" ? "depth/%d.png" : "depth_%d.png", "normal_%d.npy");
       return no_options();
     }},
    {"depth along the rays",
     [](Random&, const Scene& scene) {
       const auto k = scene.k();
       scene.each_depth([&](Depth& image) {
         for (int v = 0; v < image.height(); ++v)
           for (int u = 0; u < image.width(); ++u)
             image(u, v) = static_cast<std::uint16_t>(
                 image(u, v) * std::hypot((u - k[2]) / k[0], (v - k[3]) / k[1], 1.0));
       });
       return no_options();
     }},
    {"images are mirrored",
     [](Random&, const Scene& scene) {
       scene.each_depth([](Depth& image) {
         for (int v = 0; v < image.height(); ++v)
           std::reverse(&image(0, v), &image(0, v) + image.width());
       });
       return no_options();
     }},
    {"frames of another time",
     [](Random&, const Scene& scene) {
       Table joints = scene.joints();
       const std::size_t first = joints.first_joint();
       auto rows = joints.rows;
       for (std::size_t i = 0; i < rows.size(); ++i)
         std::copy(rows[(i + 2) % rows.size()].begin() + static_cast<std::ptrdiff_t>(first),
                   rows[(i + 2) % rows.size()].end(),
                   joints.rows[i].begin() + static_cast<std::ptrdiff_t>(first));
       scene.write(joints);
       return no_options();
     }},
    {"COCO of resized images",
     [](Random& random, const Scene& scene) {
       auto [width, height] = scene.size();
       std::vector<Box> boxes = scene.boxes(random);
       const double by = below(random, 2) == 0 ? 2.0 : 0.5;
       for (Box& box : boxes) box.x *= by, box.y *= by, box.width *= by, box.height *= by;
       return with(scene, "d.json",
                   coco(boxes, {static_cast<int>(by * width), static_cast<int>(by * height)}));
     }},
    {"boxes in fractions",
     [](Random& random, const Scene& scene) {
       const auto [width, height] = scene.size();
       std::vector<Box> boxes = scene.boxes(random);
       for (Box& box : boxes)
         box.x /= width, box.width /= width, box.y /= height, box.height /= height;
       if (below(random, 3) == 0) return with(scene, "d.json", coco(boxes, scene.size()));
       return below(random, 2) == 0 ? with(scene, "d.csv", table(boxes))
                                    : with(scene, "d.txt", mot(boxes));
     }},
    {"boxes of larger images",
     [](Random& random, const Scene& scene) {
       std::vector<Box> boxes = scene.boxes(random);
       const double by = between(random, 2.0, 4.0);
       for (Box& box : boxes) box.x *= by, box.y *= by, box.width *= by, box.height *= by;
       return below(random, 2) == 0 ? with(scene, "d.csv", table(boxes))
                                    : with(scene, "d.txt", mot(boxes));
     }},
    {"corners in place of width and height",
     [](Random& random, const Scene& scene) {
       std::vector<Box> boxes = scene.boxes(random);
       for (Box& box : boxes) box.width += box.x, box.height += box.y;
       return below(random, 2) == 0 ? with(scene, "d.json", coco(boxes, scene.size()))
                                    : with(scene, "d.txt", mot(boxes));
     }},
    {"detections numbered from another frame",
     [](Random& random, const Scene& scene) {
       const std::vector<Box> boxes = scene.boxes(random);
       if (below(random, 3) == 0) return with(scene, "d.json", coco(boxes, scene.size(), 1));
       if (below(random, 2) == 0) return with(scene, "d.txt", mot(boxes, 0));
       write_yolo(scene, boxes, 1, [](const Box&) { return ""; });
       return Words{"--targets", scene.path("labels/clip_%d.txt")};
     }},
    {"percent as scores",
     [](Random& random, const Scene& scene) {
       std::vector<Box> boxes = scene.boxes(random);
       for (Box& box : boxes) box.score *= 100.0;
       write_file(scene.path("d.csv"), table(boxes));
       return with(scene, "t.yaml", "detections: d.csv\nclasses: {part: {min_score: 0.5}}\n");
     }},
    {"a track twice in a frame",
     [](Random& random, const Scene& scene) {
       std::vector<Box> boxes = scene.boxes(random);
       for (Box& box : boxes) box.track = 1;
       return below(random, 2) == 0 ? with(scene, "d.csv", table(boxes))
                                    : with(scene, "d.txt", mot(boxes));
     }},
    {"a target in millimetres",
     [](Random& random, const Scene& scene) {
       const std::string at = exact(between(random, 200, 900)) + ", " +
                              exact(between(random, 200, 900)) + ", " +
                              exact(between(random, 50, 900));
       const std::string link =
           scene.joints().header.back() == "joint7" ? "link_base" : "base_link";
       const std::string target =
           below(random, 2) == 0
               ? "point: [" + at + "]\n    radius: " + exact(between(random, 10, 100))
               : "box3d: [" + at + ", 0, 0, 0, 1]\n    size: [" + exact(between(random, 30, 300)) +
                     ", " + exact(between(random, 30, 300)) + ", 80]";
       return with(scene, "t.yaml",
                   "targets:\n  - name: a\n    " + target + "\n    link: " + link + "\n");
     }},
    {"an attached body in millimetres",
     [](Random& random, const Scene& scene) {
       const std::string edge = exact(between(random, 40, 300));
       edit_file(scene.path("recording.yaml"), "frames:",
                 "attached:\n  - name: part\n    link: " + scene.last_link() + "\n    box: [" +
                     edge + ", " + edge + ", 80]\nframes:");
       return no_options();
     }},
    {"a tolerance in millimetres",
     [](Random& random, const Scene&) {
       return Words{"--tolerance", exact(between(random, 3, 30)) + ",0,0"};
     }},
    {"a motion in milliseconds",
     [](Random& random, const Scene& scene) {
       return look_ahead(scene, motion(scene, random, 1000.0, 1.0));
     }},
    {"a motion too fast for the robot",
     [](Random& random, const Scene& scene) {
       return look_ahead(scene, motion(scene, random, between(random, 0.005, 0.02), 1.0));
     }},
    {"a motion in degrees",
     [](Random& random, const Scene& scene) {
       return look_ahead(scene, motion(scene, random, 1.0, 180.0 / std::numbers::pi));
     }},
    {"a motion without times",
     [](Random& random, const Scene& scene) {
       return look_ahead(scene, motion(scene, random, 0.0, 1.0));
     }},
    {"joint states without a joint",
     [](Random& random, const Scene& scene) {
       const std::size_t joint = below(random, 6);
       return bag_of(
           scene, joint_states([&](io::JointStateMessage& state) {
             state.names.erase(state.names.begin() + static_cast<std::ptrdiff_t>(joint));
             state.positions.erase(state.positions.begin() + static_cast<std::ptrdiff_t>(joint));
           }));
     }},
    {"joint states with other names",
     [](Random& random, const Scene& scene) {
       const bool is_prefix = below(random, 2) == 0;
       return bag_of(scene, joint_states([&](io::JointStateMessage& state) {
                       for (std::string& name : state.names)
                         name = is_prefix ? "left/" + name : name + "_position";
                     }));
     }},
    {"clocks that differ",
     [](Random& random, const Scene& scene) {
       const auto by = static_cast<std::int64_t>(1e9 * off(random, 1.3, 30.0));
       return bag_of(scene,
                     joint_states([&](io::JointStateMessage& state) { state.header.stamp += by; }));
     }},
    {"a joint twice in a message",
     [](Random& random, const Scene& scene) {
       const double by = off(random, 0.1, 0.5);
       return bag_of(scene, joint_states([&](io::JointStateMessage& state) {
                       state.names.push_back(state.names[1]);
                       state.positions.push_back(state.positions[1] + by);
                     }));
     }},
    {"frames with a prefix",
     [](Random&, const Scene& scene) {
       return bag_of(scene, [](TinyBag& bag) { rename_frames(bag, "robot1/"); });
     }},
};

const std::vector<Kind> right_kinds = {
    {"columns in another order",
     [](Random& random, const Scene& scene) {
       Table joints = scene.joints();
       const std::size_t first = joints.first_joint();
       for (std::size_t i = joints.header.size() - 1; i > first; --i) {
         const std::size_t other = first + below(random, i - first + 1);
         std::swap(joints.header[i], joints.header[other]);
         for (Words& row : joints.rows) std::swap(row[i], row[other]);
       }
       scene.write(joints);
       return no_options();
     }},
    {"rows in another order",
     [](Random& random, const Scene& scene) {
       Table joints = scene.joints();
       if (joints.header[1] == "stamp") return no_options();
       std::shuffle(joints.rows.begin(), joints.rows.end(), random);
       scene.write(joints);
       return no_options();
     }},
    {"a pose of six digits",
     [](Random&, const Scene& scene) {
       std::ostringstream text;
       text << std::setprecision(6)
            << scene.pose().matrix().format(
                   Eigen::IOFormat(6, Eigen::DontAlignCols, " , ", "\r\n"));
       write_file(scene.path("camera_pose.csv"), text.str());
       return no_options();
     }},
    {"intrinsics of other programs",
     [](Random& random, const Scene& scene) {
       const auto [width, height] = scene.size();
       const auto [fx, fy, cx, cy] = scene.k();
       const std::string w = std::to_string(width), h = std::to_string(height);
       const std::string list = exact(fx) + ", 0., " + exact(cx) + ", 0., " + exact(fy) + ", " +
                                exact(cy) + ", 0., 0., 1.";
       const std::array forms{
           "%YAML:1.0\n---\ncalibration_time: \"Sat 28 Nov 2026\"\nimage_width: " + w +
               "\nimage_height: " + h +
               "\nboard_width: 9\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: "
               "d\n"
               "   data: [ " +
               list +
               " ]\ndistortion_coefficients: !!opencv-matrix\n   rows: 5\n   cols: 1\n   dt: d\n"
               "   data: [ 0., 0., 0., 0., 0. ]\navg_reprojection_error: 0.2\n",
           "cam0:\n  camera_model: pinhole\n  distortion_coeffs: [0, 0, 0, 0]\n  distortion_model: "
           "radtan\n  intrinsics: [" +
               exact(fx) + ", " + exact(fy) + ", " + exact(cx) + ", " + exact(cy) +
               "]\n  resolution: [" + w + ", " + h + "]\n  rostopic: /camera\n",
           "{\"width\": " + w + ", \"height\": " + h + ", \"fx\": " + exact(fx) +
               ", \"fy\": " + exact(fy) + ", \"ppx\": " + exact(cx) + ", \"ppy\": " + exact(cy) +
               ", \"model\": \"distortion.inverse_brown_conrady\", \"coeffs\": [0, 0, 0, 0, 0]}"};
       write_file(scene.path("camera_info.yaml"), forms[below(random, forms.size())]);
       return no_options();
     }},
    {"poses of other programs",
     [](Random& random, const Scene& scene) {
       const Eigen::Isometry3d pose = scene.pose();
       const Eigen::Vector3d t = pose.translation();
       const Eigen::Quaterniond q(pose.linear());
       std::ostringstream rows;
       rows << std::setprecision(17) << pose.matrix().topRows<3>();
       const std::array forms{
           "parameters:\n  eye_on_hand: false\ntransformation: {x: " + exact(t.x()) +
               ", y: " + exact(t.y()) + ", z: " + exact(t.z()) + ", qx: " + exact(q.x()) +
               ", qy: " + exact(q.y()) + ", qz: " + exact(q.z()) + ", qw: " + exact(q.w()) + "}\n",
           exact(t.x()) + " " + exact(t.y()) + " " + exact(t.z()) + " " + exact(q.x()) + " " +
               exact(q.y()) + " " + exact(q.z()) + " " + exact(q.w()) + "\n",
           rows.str() + "\n"};
       write_file(scene.path("camera_pose.csv"), forms[below(random, forms.size())]);
       return no_options();
     }},
    {"images named by time",
     [](Random&, const Scene& scene) {
       add_stamps(scene);
       const Table joints = scene.joints();
       for (std::size_t i = 0; i < joints.rows.size(); ++i) {
         const std::string& stamp = joints.rows[i][1];
         const std::string seconds =
             stamp.substr(0, stamp.size() - 9) + "." + stamp.substr(stamp.size() - 9, 6);
         fs::rename(scene.depth(i), scene.path("at_" + seconds + ".png"));
       }
       edit_file(scene.path("recording.yaml"),
                 scene.name() == "example" ? "depth/%d.png" : "depth_%d.png", "at_%t.png");
       return no_options();
     }},
    {"an attached body in metres",
     [](Random& random, const Scene& scene) {
       const std::string edge = exact(between(random, 0.02, 0.06));
       edit_file(scene.path("recording.yaml"), "frames:",
                 "attached:\n  - name: part\n    link: " + scene.last_link() + "\n    box: [" +
                     edge + ", " + edge + ", " + edge + "]\nframes:");
       return no_options();
     }},
    {"a motion in seconds",
     [](Random& random, const Scene& scene) {
       return look_ahead(scene, motion(scene, random, 1.0, 1.0));
     }},
    {"depth in metres",
     [](Random&, const Scene& scene) {
       for (std::size_t i = 0; i < scene.frames(); ++i) {
         const auto image = read_image<std::uint16_t>(scene.depth(i));
         Image<float> metres(image.width(), image.height());
         for (std::size_t k = 0; k < image.size(); ++k)
           metres.data()[k] = 0.001F * static_cast<float>(image.data()[k]);
         io::write_npy(scene.path("metres_" + std::to_string(i) + ".npy"),
                       std::as_const(metres).view());
       }
       edit_file(scene.path("recording.yaml"),
                 scene.name() == "example" ? "depth/%d.png" : "depth_%d.png", "metres_%d.npy");
       return no_options();
     }},
    {"depth of another unit with its scale",
     [](Random&, const Scene& scene) {
       scene.each_depth([&](Depth& image) {
         for (std::size_t i = 0; i < image.size(); ++i)
           image.data()[i] = static_cast<std::uint16_t>(std::min(65534, 10 * image.data()[i]));
       });
       edit_file(scene.path("recording.yaml"), "camera:\n", "camera:\n  depth_scale: 0.0001\n");
       return no_options();
     }},
    {"detections in each form",
     [](Random& random, const Scene& scene) {
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
           write_yolo(scene, boxes, 0,
                      [](const Box& box) { return " " + std::to_string(box.track); });
           return Words{"--targets", scene.path("labels/clip_%d.txt")};
         default:
           write_yolo(scene, boxes, 1, [](const Box& box) { return " " + exact(box.score); });
           return with(scene, "t.yaml", "detections: labels/clip_%d.txt\nfirst_frame: 1\n");
       }
     }},
    {"some frames without detections",
     [](Random& random, const Scene& scene) {
       std::vector<Box> boxes = scene.boxes(random);
       std::erase_if(boxes, [&](const Box& box) { return box.frame > 0 && below(random, 2) == 0; });
       return below(random, 2) == 0 ? with(scene, "d.csv", table(boxes))
                                    : with(scene, "d.txt", mot(boxes));
     }},
    {"boxes that reach out of the image",
     [](Random& random, const Scene& scene) {
       std::vector<Box> boxes = scene.boxes(random);
       const auto [width, height] = scene.size();
       for (std::size_t i = 0; i < boxes.size(); i += 3) boxes[i].x -= 0.5 * boxes[i].width;
       for (std::size_t i = 1; i < boxes.size(); i += 4) boxes[i].y = height - 10.0;
       static_cast<void>(width);
       return with(scene, "d.csv", table(boxes));
     }},
    {"scores of another scale",
     [](Random& random, const Scene& scene) {
       std::vector<Box> boxes = scene.boxes(random);
       for (Box& box : boxes) box.score = between(random, -4.0, 30.0);
       return with(scene, "d.txt", mot(boxes));
     }},
    {"targets far away",
     [](Random& random, const Scene& scene) {
       return with(scene, "t.yaml",
                   "targets:\n  - name: a\n    point: [" + exact(off(random, 1, 20)) + ", 0, " +
                       exact(between(random, 5, 40)) + "]\n    radius: 0.5\n");
     }},
    {"a bag", [](Random&, const Scene& scene) { return bag_of(scene, [](TinyBag&) {}); }},
    {"joint states of two topics",
     [](Random& random, const Scene& scene) {
       const std::size_t cut = 1 + below(random, 5);
       return bag_of(scene,
                     [&](TinyBag& bag) {
                       for (TinyBag::Message& message : bag.messages)
                         if (message.topic == "/joint_states") message.log_time -= 1'000'000;
                       bag.copy("/joint_states", "/gripper/joint_states");
                       const auto keep = [&](const std::string& topic, bool first) {
                         bag.edit<io::JointStateMessage>(topic, [&](io::JointStateMessage& state) {
                           const auto at = static_cast<std::ptrdiff_t>(cut);
                           auto& names = state.names;
                           auto& positions = state.positions;
                           if (first) {
                             names.resize(cut), positions.resize(cut);
                           } else {
                             names.erase(names.begin(), names.begin() + at);
                             positions.erase(positions.begin(), positions.begin() + at);
                           }
                         });
                       };
                       keep("/joint_states", true);
                       keep("/gripper/joint_states", false);
                     }) +
              Words{"--joint-topic", "/joint_states", "--joint-topic", "/gripper/joint_states"};
     }},
    {"joints of other devices",
     [](Random&, const Scene& scene) {
       return bag_of(scene, joint_states([](io::JointStateMessage& state) {
                       state.names.insert(state.names.begin(), "lift");
                       state.positions.insert(state.positions.begin(), 0.3);
                     }));
     }},
    {"joint states with other names, and the option",
     [](Random&, const Scene& scene) {
       return bag_of(scene, joint_states([](io::JointStateMessage& state) {
                       for (std::string& name : state.names) name = "left/" + name + "_pos";
                     })) +
              Words{"--joint-names", "left/*_pos=*"};
     }},
    {"clocks that differ, and the option",
     [](Random& random, const Scene& scene) {
       const double by = off(random, 0.1, 9.0);
       return bag_of(scene, joint_states([&](io::JointStateMessage& state) {
                       state.header.stamp += std::llround(1e9 * by);
                     })) +
              Words{"--time-offset", exact(by)};
     }},
    {"images that come late",
     [](Random& random, const Scene& scene) {
       const auto by = static_cast<std::int64_t>(1e9 * between(random, 0.05, 0.8));
       return bag_of(scene, [&](TinyBag& bag) {
         for (TinyBag::Message& message : bag.messages)
           if (message.topic == "/camera/depth/image") message.log_time += by;
       });
     }},
    {"the same joint twice with one position",
     [](Random&, const Scene& scene) {
       return bag_of(scene, joint_states([](io::JointStateMessage& state) {
                       state.names.push_back(state.names[1]);
                       state.positions.push_back(state.positions[1]);
                     }));
     }},
};

class Silence : public FolderTest {
 protected:
  void SetUp() override {
    if (fs::exists(data_folder() / "xarm7_realsense"))
      names_ = {"example", "xarm7_realsense", "xarm7_realsense_2"};
  }

  static bool is_full() { return std::getenv("PENUMBRA_FULL") != nullptr; }

  /// Calls `call` for each kind on each recording, `rounds` times; unless it is a full run, for a
  /// fourth of the kinds on the shipped recording.
  template <typename Call>
  void for_each(const std::vector<Kind>& kinds, int rounds, const Call& call) const {
    if (!is_full())
      for (std::size_t i = 0; i < kinds.size(); i += 4) call(names_.front(), kinds[i]);
    else
      for (int round = 0; round < rounds; ++round)
        for (const Kind& kind : kinds)
          for (const std::string& name : names_) call(name, kind);
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

  Words names_ = {"example"};
  std::map<std::string, std::string> usual_;  // stderr of the unchanged scenes
};

TEST_F(Silence, WrongInputsAreNamed) {
  Random random = seeded_random(58);
  std::size_t inputs = 0;
  Words silent;
  for_each(wrong_kinds, 4, [&](const std::string& name, const Kind& kind) {
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
  for_each(right_kinds, 6, [&](const std::string& name, const Kind& kind) {
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
