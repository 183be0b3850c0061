// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include <penumbra/tuning/stages-inl.hpp>
#include <penumbra/tuning/voxels-inl.hpp>

namespace penumbra::tuning {
namespace {

constexpr int stride = 2;                 // pixels, in both directions
constexpr double nearby = 0.25;           // metres from the robot, and from the link's own box
constexpr double attached = 0.08;         // metres from the link's box to a piece
constexpr int least_views = 3;            // frames in which a voxel is occupied
constexpr double consistent = 0.6;        // of the frames in which a voxel is visible
constexpr double prior_frames = 2.0;      // empty frames added to each score
constexpr double same_surface = 0.5;      // of e(z)
constexpr std::size_t least_voxels = 20;  // of a piece, without those that may be fringe
constexpr int grow = 3;                   // voxels around a piece

using Groups = std::vector<std::vector<std::size_t>>;
constexpr std::size_t scenery = 0;  // the root's group, which does not move
constexpr std::size_t unexplained = ~std::size_t{0};

/// A measured point that belongs neither to the robot nor to the background.
struct Point {
  Eigen::Vector3d camera;  // metres, optical frame
  std::size_t frame = 0;
  bool is_certain = false;  // not fringe: far from the outline, or in front of the robot
  std::size_t group = 0;    // moves with the point
  Voxel voxel = 0;          // in that group's frame
};

void add_points(const Scene& scene, const LabelRule& rule, const LabelView& labels,
                std::size_t frame_number, std::vector<Point>& points) {
  const KeptFrame& frame = scene.frames[frame_number];
  const NearestPixels robot = seen_robot(labels);
  const auto point = [&](int u, int v) -> Eigen::Vector3d {
    return scene.camera.ray(u, v) * frame.depth(u, v);
  };
  for (int v = 0; v < scene.camera.height(); v += stride) {
    for (int u = 0; u < scene.camera.width(); u += stride) {
      const float z = frame.depth(u, v);
      const bool is_front = labels.labels(u, v) == static_cast<std::uint8_t>(Label::front);
      const double distance = robot.distance(u, v);
      if ((frame.virtual_depth(u, v) > 0.0f && !is_front) || std::isinf(distance) ||
          !scene.is_new(u, v, z, rule.tolerance))
        continue;
      const auto near = robot.at(u, v);
      if ((point(u, v) - point(near.u, near.v)).norm() > nearby) continue;
      const float near_z = frame.depth(near.u, near.v);
      const bool may_be_fringe = !is_front && distance <= rule.fringe_reach &&
                                 std::abs(z - near_z) < rule.tolerance.at(near_z);
      points.push_back(
          {.camera = point(u, v), .frame = frame_number, .is_certain = !may_be_fringe});
    }
  }
}

/// Returns groups of links that do not move relative to each other; the first link is the frame.
Groups rigid_groups(const Scene& scene) {
  Groups groups;
  const auto moves = [&](std::size_t a, std::size_t b) {
    const auto pose = [&](const KeptFrame& frame) -> Eigen::Isometry3d {
      return frame.T_root_link[a].inverse() * frame.T_root_link[b];
    };
    const Eigen::Isometry3d first = pose(scene.frames.front());
    return std::any_of(scene.frames.begin(), scene.frames.end(),
                       [&](const KeptFrame& frame) { return !pose(frame).isApprox(first, 1e-3); });
  };
  for (std::size_t link = 0; link < scene.robot.links().size(); ++link) {
    const auto same = std::find_if(groups.begin(), groups.end(),
                                   [&](const auto& group) { return !moves(group.front(), link); });
    if (same != groups.end())
      same->push_back(link);
    else
      groups.push_back({link});
  }
  return groups;
}

struct NearLink {
  std::size_t link;
  double distance;  // metres from the link's box, or from its origin if it has none
};

/// Returns the link of the group that is nearest to a voxel in the group's frame.
NearLink nearest_link(const Scene& scene, const std::vector<std::size_t>& group, Voxel voxel) {
  const std::vector<Eigen::Isometry3d>& links = scene.frames.front().T_root_link;
  const Eigen::Vector3d centre = links[group.front()] * centre_of(voxel);
  NearLink nearest{group.front(), std::numeric_limits<double>::infinity()};
  for (const std::size_t link : group) {
    const Eigen::Vector3d point = links[link].inverse() * centre;
    const Eigen::AlignedBox3d& box = scene.robot.report()[link].bounds;
    const double distance = box.isEmpty() ? point.norm() : box.exteriorDistance(point);
    if (distance < nearest.distance) nearest = {link, distance};
  }
  return nearest;
}

/// Scores voxels in the frame of one group by the number of frames in which they are occupied.
class Grid {
 public:
  Grid(const Scene& scene, const std::vector<std::size_t>& group) : scene_(scene), group_(group) {
    for (const KeptFrame& frame : scene.frames)
      T_camera_group_.push_back(frame.T_root_camera->inverse() * frame.T_root_link[group.front()]);
  }

  [[nodiscard]] Voxel voxel_of(const Point& point) const {
    return voxel_at(T_camera_group_[point.frame].inverse() * point.camera);
  }
  void add(const Point& point) { hits_[voxel_of(point)] |= 1U << point.frame; }

  /// Returns the scores after all points were added. Scenery may be far from the links.
  [[nodiscard]] std::unordered_map<Voxel, double> scores(bool is_scenery) const {
    std::unordered_map<Voxel, double> scores;
    for (const auto& [voxel, hits] : hits_)
      scores[voxel] = is_scenery || nearest_link(scene_, group_, voxel).distance <= nearby
                          ? score(centre_of(voxel), hits)
                          : 0.0;
    return scores;
  }

 private:
  [[nodiscard]] double score(const Eigen::Vector3d& centre, std::uint32_t hits) const {
    int occupied = std::popcount(hits), empty = 0;
    for (std::size_t i = 0; i < scene_.frames.size(); ++i) {
      if ((hits >> i & 1U) != 0) continue;
      const Eigen::Vector3d point = T_camera_group_[i] * centre;
      const float measured = depth_at(scene_.frames[i].depth, point);
      const double behind = measured - point.z();
      const double same = same_surface * LabelRule().tolerance.at(point.z());
      if (!(measured > 0.0f) || behind < -same) continue;  // not seen
      ++(behind <= same ? occupied : empty);
    }
    const int seen = occupied + empty;
    if (occupied < least_views || occupied < consistent * seen) return 0.0;
    return occupied / (seen + prior_frames);
  }

  [[nodiscard]] float depth_at(const Image<float>& depth, const Eigen::Vector3d& point) const {
    if (!(point.z() > 0.0)) return 0.0f;
    const Eigen::Vector2d pixel = scene_.camera.project(point);
    if (!(pixel.cwiseAbs().maxCoeff() < Intrinsics::max_size)) return 0.0f;
    const int u = static_cast<int>(std::lround(pixel.x())),
              v = static_cast<int>(std::lround(pixel.y()));
    return u >= 0 && v >= 0 && u < depth.width() && v < depth.height() ? depth(u, v) : 0.0f;
  }

  const Scene& scene_;
  const std::vector<std::size_t>& group_;
  std::vector<Eigen::Isometry3d> T_camera_group_;  // of each frame
  std::unordered_map<Voxel, std::uint32_t> hits_;  // a bit for each frame
};
static_assert(most_tuning_frames <= 32);

/// Returns each point's score in the frame of each group.
std::vector<std::vector<double>> scores_of(const Scene& scene, const Groups& groups,
                                           const std::vector<Point>& points) {
  std::vector<std::vector<double>> scores;
  for (std::size_t group = 0; group < groups.size(); ++group) {
    Grid grid(scene, groups[group]);
    for (const Point& point : points) grid.add(point);
    const auto of_voxels = grid.scores(group == scenery);
    std::vector<double>& of_points = scores.emplace_back();
    for (const Point& point : points) of_points.push_back(of_voxels.at(grid.voxel_of(point)));
  }
  return scores;
}

/// Assigns each point to a group: to the scenery unless a link explains it better, else to the link
/// that explains most of the remaining points. Of equal links the last wins (a tool is at the end).
void assign(const Scene& scene, const Groups& groups, std::vector<Point>& points) {
  const auto scores = scores_of(scene, groups, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    double best = 0.0;
    for (std::size_t group = 1; group < groups.size(); ++group)
      best = std::max(best, scores[group][i]);
    points[i].group = best > scores[scenery][i] ? unexplained : scenery;
  }
  while (true) {
    std::size_t best = scenery;
    double most = 0.0;
    for (std::size_t group = 1; group < groups.size(); ++group) {
      double sum = 0.0;
      for (std::size_t i = 0; i < points.size(); ++i)
        if (points[i].group == unexplained) sum += scores[group][i];
      if (sum > 0.0 && sum >= most) most = sum, best = group;
    }
    if (best == scenery) return;
    const Grid grid(scene, groups[best]);
    for (std::size_t i = 0; i < points.size(); ++i)
      if (points[i].group == unexplained && scores[best][i] > 0.0)
        points[i].group = best, points[i].voxel = grid.voxel_of(points[i]);
  }
}

/// Returns the part made of the pieces, in the frame of the nearest link of the group.
ExtraPart make_part(const Scene& scene, const std::vector<std::size_t>& group,
                    const std::vector<VoxelSet>& pieces) {
  const std::vector<Eigen::Isometry3d>& links = scene.frames.front().T_root_link;
  const auto in_frame = [&](std::size_t link, const Eigen::Vector3d& point) -> Eigen::Vector3d {
    return links[link].inverse() * links[group.front()] * point;
  };
  ExtraPart part;
  part.link = nearest_link(scene, group, pieces.front().begin()->first).link;
  for (const VoxelSet& piece : pieces) {
    const std::size_t first = part.mesh.vertices.size();
    TriangleMesh mesh;
    add_boundary(piece, mesh);
    Eigen::AlignedBox3d& box = part.boxes.emplace_back();
    for (const Eigen::Vector3f& vertex : mesh.vertices) {
      const Eigen::Vector3d placed = in_frame(part.link, vertex.cast<double>());
      box.extend(placed);
      part.mesh.vertices.emplace_back(placed.cast<float>());
    }
    for (auto triangle : mesh.triangles) {
      for (std::uint32_t& corner : triangle) corner += static_cast<std::uint32_t>(first);
      part.mesh.triangles.push_back(triangle);
    }
  }
  return part;
}

}  // namespace

std::vector<ExtraPart> find_extras(const Scene& scene, const LabelRule& rule) {
  std::vector<ExtraPart> parts;
  LabelRule used = rule;  // with at least the default reach
  used.fringe_reach = std::max(rule.fringe_reach, LabelRule().fringe_reach);
  Classifier classifier(scene.camera.width(), scene.camera.height(), used);
  std::vector<Point> points;
  for (std::size_t i = 0; i < scene.frames.size(); ++i)
    add_points(scene, used, label(classifier, scene.frames[i]), i, points);
  const auto groups = rigid_groups(scene);
  assign(scene, groups, points);
  for (std::size_t group = 1; group < groups.size(); ++group) {
    VoxelSet voxels;
    for (const Point& point : points)
      if (point.group == group) voxels[point.voxel] |= point.is_certain;
    std::vector<VoxelSet> pieces = pieces_of(voxels, least_voxels, grow);
    std::erase_if(pieces, [&](const VoxelSet& piece) {
      return std::none_of(piece.begin(), piece.end(), [&](const auto& voxel) {
        return nearest_link(scene, groups[group], voxel.first).distance <= attached;
      });
    });
    if (!pieces.empty()) parts.push_back(make_part(scene, groups[group], pieces));
  }
  return parts;
}

}  // namespace penumbra::tuning
