// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>
#include <numeric>
#include <system_error>
#include <utility>
#include <vector>

#include <penumbra/base/error.hpp>

#include <io/files/names.hpp>
#include <io/files/printable.hpp>

namespace penumbra::io {
namespace {

constexpr std::size_t max_listed = 8;
constexpr std::size_t max_near = 3;
constexpr std::size_t max_compared = 128;  // letters; longer names are nobody's typing error

bool same_letter(char a, char b) {
  return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
}

// Levenshtein's distance, whatever the case.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (same_letter(a[i], b[j]) ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

std::string joined(std::span<const std::string_view> names) {
  std::string text;
  for (const std::string_view name : names) text += (text.empty() ? "" : ", ") + std::string(name);
  return text;
}

}  // namespace

std::string near_names(std::string_view name, std::span<const std::string_view> known) {
  if (known.size() <= max_listed) return known.empty() ? "" : "; known are: " + joined(known);
  std::vector<std::pair<std::size_t, std::string_view>> near;
  for (const std::string_view other : known) {
    if (name.size() > max_compared || other.size() > max_compared) continue;
    const std::size_t d = distance(name, other);
    if (d <= std::max(name.size(), other.size()) / 2) near.emplace_back(d, other);
  }
  std::stable_sort(near.begin(), near.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  if (near.size() > max_near) near.resize(max_near);
  std::vector<std::string_view> names;
  names.reserve(near.size());
  for (const auto& [d, other] : near) names.push_back(other);
  return names.empty() ? "" : "; did you mean " + joined(names) + "?";
}

std::string input_name(const std::filesystem::path& path) {
  std::error_code ignored;
  const std::filesystem::path name = path.filename();
  if (name.empty() || name == "." || name == "..")
    if (auto found = std::filesystem::canonical(path, ignored); !found.empty()) return found;
  return path.string();
}

void check_name(std::string_view name) {
  if (name.empty()) throw InputError("the name is empty");
  if (without_controls(name) != name)
    throw InputError("the name '" + printable(name) +
                     "' has a control character; expected letters, digits and signs");
}

void check_camera_name(std::string_view name) {
  constexpr std::size_t longest = 255;  // of a folder's name, bytes
  check_name(name);
  if (name.front() == '.' || name.find('/') != std::string_view::npos || name.size() > longest ||
      name == "views.json" || name == "report.html")
    throw InputError("the name '" + printable(name) +
                     "' cannot be that of a folder of results; expected letters and digits");
}

std::string for_shell(const std::string& text) {
  constexpr std::string_view plain = "_-./:@%+=,";
  const bool is_plain = !text.empty() && std::all_of(text.begin(), text.end(), [&](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || plain.find(c) != plain.npos;
  });
  if (is_plain) return text;
  std::string quoted = "'";
  for (const char c : without_controls(text)) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

}  // namespace penumbra::io
