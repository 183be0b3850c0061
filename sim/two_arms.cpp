// SPDX-License-Identifier: Apache-2.0
#include <fstream>
#include <numbers>
#include <regex>

#include <penumbra/base/error.hpp>
#include <penumbra/base/whole_file-inl.hpp>

#include <sim/numbers.hpp>
#include <sim/two_arms.hpp>

namespace penumbra::sim {

std::vector<ArmPlace> two_places() {
  constexpr double apart = 0.35;  // metres from the middle
  std::vector<ArmPlace> places{{"left"}, {"right"}};
  places[0].T_world_root.translation().y() = apart;
  places[1].T_world_root.translation().y() = -apart;
  places[1].T_world_root.rotate(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitZ()));
  return places;
}

std::filesystem::path write_arms(const std::filesystem::path& urdf,
                                 const std::vector<ArmPlace>& arms,
                                 const std::filesystem::path& folder) {
  const std::string text = read_whole_file(urdf, FileLimit::text);
  const std::size_t begin = text.find('>', text.find("<robot")) + 1;
  const std::string body = text.substr(begin, text.rfind("</robot>") - begin);
  std::string all = "<robot name=\"arms\"><link name=\"world\"/>";
  for (const auto& [name, T] : arms) {
    static const std::regex names(R"re(\b(name|link|joint)=")re");
    all += std::regex_replace(body, names, "$1=\"" + name + "/");
    const Eigen::Vector3d at = T.translation(), zyx = T.linear().eulerAngles(2, 1, 0);
    all += "<joint name=\"" + name +
           "/mount\" type=\"fixed\"><parent link=\"world\"/><child link=\"" + name + "/" +
           arm_root + "\"/><origin xyz=\"" + numbers({at.x(), at.y(), at.z()}) + "\" rpy=\"" +
           numbers({zyx[2], zyx[1], zyx[0]}) + "\"/></joint>";
  }
  const std::filesystem::path file = folder / "arms.urdf";
  std::ofstream stream(file, std::ios::binary);
  stream << all << "</robot>";
  if (!stream.flush()) throw InputError(file.string() + ": cannot be written");
  return file;
}

}  // namespace penumbra::sim
