// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/mesh/prepared_mesh.hpp>

namespace penumbra {

/// A thing that a link carries, for example a grasped object or a tool, or a fixture on the root
/// link. It hides the view as the link does. A target of the same name is `held`: its pose is the
/// body's. Pipeline::attach_target makes a body of a target.
struct AttachedBody {
  std::string name;  ///< not empty, and unique in a frame
  std::string link;  ///< the link that carries it
  /// In the body's frame, metres. Pass the same pointer for the same mesh: renderers are cached by
  /// pointer. Null: not known yet.
  std::shared_ptr<const PreparedMesh> mesh;
  Eigen::Isometry3d T_link_body = Eigen::Isometry3d::Identity();
  std::string reason = {};  ///< why there is no mesh that can be drawn, for the frames' messages
};

/// Which bodies are attached to a robot at a stamp. Calls may come late and in any order of stamps.
class Attachments {
 public:
  static constexpr std::size_t max_changes = 1000;  ///< that are stored; earlier ones are merged

  /// The body is attached from `stamp` (nanoseconds) on. It replaces one of the same name. With a
  /// mesh it also replaces those of the same name and link that have none, whatever their stamps.
  void attach(std::int64_t stamp, AttachedBody body);
  /// The body is not attached from `stamp` on.
  void detach(std::int64_t stamp, std::string_view name);
  /// Whatever is attached last is attached at every stamp, for a clock that was set back.
  void restart();

  /// Returns the stamp of a body's last change, in order of stamps; null if it has none.
  [[nodiscard]] std::optional<std::int64_t> last_change(std::string_view name) const;

  /// Writes the bodies that are attached at a stamp, in the order in which they were attached.
  void at(std::int64_t stamp, std::vector<AttachedBody>& bodies) const;

 private:
  struct Change {
    std::int64_t stamp;
    AttachedBody body;
    bool is_attached;
  };
  void add(Change change);
  void merge(std::size_t count);

  std::vector<Change> changes_;  // by stamp
};

}  // namespace penumbra
