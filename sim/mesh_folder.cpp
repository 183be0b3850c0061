// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <string>
#include <system_error>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/base/whole_file-inl.hpp>

#include <sim/mesh_folder.hpp>

namespace penumbra::sim {
namespace {

namespace fs = std::filesystem;

bool is_same_file(const fs::path& one, const fs::path& other) {
  std::error_code error;
  if (!fs::is_regular_file(other, error) ||
      fs::file_size(one, error) != fs::file_size(other, error))
    return false;
  return read_whole_file(one, FileLimit::data) == read_whole_file(other, FileLimit::data);
}

/// Returns whether `folder` has every file of `wanted`.
bool holds(const fs::path& folder, const fs::path& wanted) {
  for (const auto& entry : fs::recursive_directory_iterator(wanted))
    if (entry.is_regular_file() &&
        !is_same_file(entry.path(), folder / entry.path().lexically_relative(wanted)))
      return false;
  return true;
}

/// A temporary folder that is removed with its content.
struct PartFolder {
  fs::path path;
  ~PartFolder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
};

}  // namespace

MeshFolder::MeshFolder(fs::path description, const fs::path& bag)
    : description_(std::move(description)), path_(bag.parent_path() / description_.filename()) {
  check();
}

void MeshFolder::check() const {
  std::error_code error;
  if (fs::exists(fs::symlink_status(path_, error)) && !holds(path_, description_))
    throw InputError("--output: " + path_.string() +
                     " is there and does not hold the simulated arm's meshes, which go there; "
                     "choose another folder for the bag");
}

void MeshFolder::copy() const {
  const auto refuse = [&](const std::string& why) {
    throw InputError(path_.string() + ": cannot be written (" + why + "); choose another with -o");
  };
  std::error_code error;
  if (fs::exists(path_, error)) return check();
  std::string pattern = path_.string() + ".penumbra.part.XXXXXX";
  if (mkdtemp(pattern.data()) == nullptr) refuse("no permission, or no space");
  const PartFolder part{pattern};
  const fs::path whole = part.path / path_.filename();
  fs::copy(description_, whole, fs::copy_options::recursive, error);
  if (error) refuse(error.message());
  fs::rename(whole, path_, error);
  // Another simulation may have copied it meanwhile.
  if (error && !holds(path_, description_)) refuse(error.message());
}

}  // namespace penumbra::sim
