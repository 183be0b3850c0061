// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <io/files/pending_file.hpp>
#include <io/mcap/writer.hpp>
#include <sim/recording_sink.hpp>

namespace penumbra::sim {

/// Writes a simulation as a bag of ROS 2 messages for `penumbra run`, and the URDF's folder next to
/// it. Messages are recorded at their stamps; messages without a frame at the first frame's stamp:
///   /robot_description, /tf_static                latched; the cameras' poses
///   /joint_states                                 as reported
///   /camera/depth/image_rect_raw, camera_info     16UC1, millimetres; /second_camera/... too
///   /camera/color/image_raw/compressed, camera_info   PNG
///   /truth/scene, /truth/model/compressed         latched; scene_text() and the object's image
///   /truth/joint_states, /truth/ids               true positions; 16UC1 SimFrame::ids
///   /truth/NAME/pose, /truth/targets              of each object; hidden fractions of all
class RecordingBag final : public RecordingSink {
 public:
  /// Throws InputError if the file exists or cannot be written. The bag does not exist before
  /// finish(). `simulation` must outlive this.
  RecordingBag(const std::filesystem::path& file, const Simulation& simulation,
               const std::string& scene, const SimulationOptions& options);

  void add(const SimFrame& frame, std::size_t index) override;
  void finish() override;
  [[nodiscard]] std::string where() const override;

 private:
  struct Channel {
    std::uint16_t id = 0;
    std::uint32_t messages = 0;
  };
  enum class Durability { latched, passing };

  template <typename M>
  void write(const std::string& topic, std::int64_t stamp, const M& message,
             Durability durability = Durability::passing);
  Channel& channel_of(const std::string& topic, const std::string& type, Durability durability);
  void write_scene(std::int64_t stamp);
  void write_camera(const SimFrame& frame);
  void write_second_camera(const SimFrame& frame);
  void write_truth(const SimFrame& frame);

  std::filesystem::path file_;
  std::filesystem::path meshes_;  // the URDF's folder next to the bag
  io::PendingFile pending_;
  io::mcap::Writer writer_;
  const Simulation& simulation_;
  bool second_camera_;
  std::string root_, scene_;
  std::map<std::string, std::uint16_t> schemas_;
  std::map<std::string, Channel> channels_;
  std::vector<std::byte> payload_, png_;
  Image<std::uint16_t> ids_;
};

}  // namespace penumbra::sim
