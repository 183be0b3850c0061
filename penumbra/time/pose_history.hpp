// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/mesh/prepared_mesh.hpp>
#include <penumbra/robot/robot.hpp>
#include <penumbra/time/joint_buffer.hpp>
#include <penumbra/time/transform_buffer.hpp>

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

struct PoseHistoryOptions {
  JointBufferOptions joints = {};
  TransformBufferOptions transforms = {};
};

/// Joint states and transforms of a robot and its cameras from all publishers, and what is attached
/// to it. One history serves
/// the queues of several cameras. Not synchronised between threads.
///
/// A clock jumped back (a bag played in a loop, a restarted simulation) if the stamp of a joint,
/// frame or image is more than least_clock_jump before its own last one. Everything except static
/// transforms and attached bodies is then removed, so that states from before and after do not mix.
/// States that are late by less are inserted in order.
class PoseHistory {
 public:
  /// Throws InputError for options out of range.
  explicit PoseHistory(const Robot& robot, const PoseHistoryOptions& options = {});

  /// As JointBuffer::insert. Refuses and counts states with a stamp of 0 or negative.
  std::size_t add_joints(std::int64_t stamp, std::span<const std::string> names,
                         std::span<const double> positions, std::string_view source = {});

  /// As TransformBuffer::insert and insert_static.
  TransformInsert add_transform(std::int64_t stamp, std::string_view parent, std::string_view child,
                                const Eigen::Isometry3d& T_parent_child,
                                std::string_view source = {});
  TransformInsert add_static_transform(std::string_view parent, std::string_view child,
                                       const Eigen::Isometry3d& T_parent_child);

  /// Removes the states and returns true if `stamp` is a clock jump before `newest`; for other
  /// stamps of the same clock. `of`: the name of what jumped, for the message.
  bool note_stamp(std::int64_t stamp, std::int64_t newest, std::string_view of);

  /// Removes everything except static transforms and what is attached last.
  void clear();

  [[nodiscard]] const JointBuffer& joints() const { return joints_; }
  [[nodiscard]] const TransformBuffer& transforms() const { return transforms_; }
  [[nodiscard]] Attachments& attachments() { return attachments_; }
  [[nodiscard]] const Attachments& attachments() const { return attachments_; }

  /// Grows whenever something is added or removed.
  [[nodiscard]] std::uint64_t revision() const { return revision_; }
  /// Grows whenever the states are removed.
  [[nodiscard]] std::uint64_t epoch() const { return epoch_; }

  [[nodiscard]] std::size_t clock_jumps() const { return clock_jumps_; }
  /// One line about the last jump; empty if there was none.
  [[nodiscard]] const std::string& last_jump() const { return last_jump_; }
  [[nodiscard]] std::size_t joint_states_without_stamp() const { return no_stamps_; }

 private:
  JointBuffer joints_;
  TransformBuffer transforms_;
  Attachments attachments_;
  std::uint64_t revision_ = 0;
  std::uint64_t epoch_ = 0;
  std::size_t clock_jumps_ = 0;
  std::size_t no_stamps_ = 0;
  std::string last_jump_;
};

}  // namespace penumbra
