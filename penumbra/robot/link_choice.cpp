// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <penumbra/base/error.hpp>
#include <penumbra/base/text-inl.hpp>
#include <penumbra/robot/glob-inl.hpp>
#include <penumbra/robot/link_choice-inl.hpp>

namespace penumbra::detail {
namespace {

constexpr double kLargestMargin = 1.0;  // metres; more was meant in another unit
constexpr std::size_t kMostNames = 5;   // of links in a message

void require_match(const Urdf& urdf, const std::string& pattern, const std::string& option) {
  const bool matches = std::any_of(urdf.links.begin(), urdf.links.end(), [&](const auto& link) {
    return glob_match(pattern, link.name);
  });
  if (!matches)
    throw InputError(urdf.file + ": " + option + " " + in_quotes(pattern) +
                     " matches no link; see the robot's links for their names");
}

bool any_matches(const std::vector<std::string>& patterns, const std::string& link) {
  return std::any_of(patterns.begin(), patterns.end(),
                     [&](const auto& pattern) { return glob_match(pattern, link); });
}

// The value that `settings` hold for a link, or `otherwise`.
template <typename Value>
Value setting_of(const std::map<std::string, Value>& settings, const Urdf& urdf,
                 const std::string& link, Value otherwise) {
  if (const auto own = settings.find(link); own != settings.end()) return own->second;
  const std::string* first = nullptr;
  for (const auto& [pattern, value] : settings) {
    if (is_plain_name(pattern) || !glob_match(pattern, link)) continue;
    if (first != nullptr && settings.at(*first) != value)
      throw InputError(urdf.file + ": link " + in_quotes(link) + ": the patterns " +
                       in_quotes(*first) + " and " + in_quotes(pattern) +
                       " give it different values; give its name");
    if (first == nullptr) first = &pattern;
  }
  return first == nullptr ? otherwise : settings.at(*first);
}

Geometry other(Geometry g) {
  return g == Geometry::visual ? Geometry::collision : Geometry::visual;
}

void choose_geometry(const UrdfLink& link, Geometry wanted, bool fallback, LinkChoice& choice) {
  choice.geometry = wanted;
  const bool has_wanted = !link.elements(wanted).empty();
  const bool has_other = !link.elements(other(wanted)).empty();
  choice.draw = has_wanted || (fallback && has_other);
  if (has_wanted) {
    choice.reason = to_string(wanted);
  } else if (choice.draw) {
    choice.geometry = other(wanted);
    choice.reason = to_string(other(wanted)) + ", as it has no " + to_string(wanted);
  } else if (has_other) {
    choice.reason = "has no " + to_string(wanted) + ", only " + to_string(other(wanted));
    choice.lacks_geometry = true;
  } else {
    choice.reason = "has no geometry";
  }
}

void check_options(const Urdf& urdf, const RobotOptions& options) {
  for (const auto& pattern : options.ignore_links) require_match(urdf, pattern, "ignore_links");
  for (const auto& pattern : options.only_links) require_match(urdf, pattern, "only_links");
  for (const auto& [pattern, geometry] : options.geometry_of_links)
    require_match(urdf, pattern, "geometry");
  for (const auto& [pattern, margin] : options.margins) {
    require_match(urdf, pattern, "margin");
    if (!(std::abs(margin) <= kLargestMargin))
      throw InputError(urdf.file + ": margin of " + in_quotes(pattern) + " is " + printed(margin) +
                       "; expected metres within -1 and 1");
  }
  for (const ExtraMesh& extra : options.extra) {
    const auto is_its = [&](const UrdfLink& link) { return link.name == extra.link; };
    if (std::none_of(urdf.links.begin(), urdf.links.end(), is_its))
      throw InputError(urdf.file + ": extra: " + in_quotes(extra.link) +
                       " is no link of the robot");
  }
}

/// Links that have geometry, but none of the kind that is wanted of them.
std::vector<const UrdfLink*> lacking(const Urdf& urdf, const std::vector<LinkChoice>& choices,
                                     Geometry wanted) {
  std::vector<const UrdfLink*> links;
  for (std::size_t i = 0; i < choices.size(); ++i)
    if (choices[i].lacks_geometry && choices[i].geometry == wanted) links.push_back(&urdf.links[i]);
  return links;
}

std::string lacking_line(const std::vector<const UrdfLink*>& links, Geometry wanted) {
  std::string names;
  for (std::size_t i = 0; i < std::min(links.size(), kMostNames); ++i)
    names += (i == 0 ? "" : ", ") + in_quotes(links[i]->name);
  if (links.size() > kMostNames) names += ", ...";
  const std::string kind = to_string(other(wanted));
  return std::to_string(links.size()) + (links.size() == 1 ? " link has no " : " links have no ") +
         to_string(wanted) + " geometry, only " + kind + ": " + names + "; draw " +
         (links.size() == 1 ? "it" : "them") +
         " by that (--geometry-fallback, or geometry: {LINK: " + kind + "}), take " + kind +
         " for all (--geometry " + kind +
         "), or leave out what is not on the real robot (ignore_links)";
}

void refuse_lacking(const Urdf& urdf, const std::vector<LinkChoice>& choices) {
  for (const Geometry wanted : {Geometry::collision, Geometry::visual})
    if (const auto links = lacking(urdf, choices, wanted); !links.empty())
      throw InputError(urdf.file + ":" + std::to_string(links.front()->line) + ": " +
                       lacking_line(links, wanted));
}

}  // namespace

std::vector<LinkChoice> choose_links(const Urdf& urdf, const RobotOptions& options) {
  check_options(urdf, options);
  std::vector<LinkChoice> choices;
  for (const UrdfLink& link : urdf.links) {
    LinkChoice choice;
    choice.margin = setting_of(options.margins, urdf, link.name, 0.0);
    const Geometry wanted =
        setting_of(options.geometry_of_links, urdf, link.name, options.geometry);
    if (any_matches(options.ignore_links, link.name)) {
      choice.reason = "ignored by ignore_links";
    } else if (!options.only_links.empty() && !any_matches(options.only_links, link.name)) {
      choice.reason = "left out by only_links";
    } else {
      choose_geometry(link, wanted, options.geometry_fallback, choice);
    }
    choices.push_back(std::move(choice));
  }
  if (!options.allow_missing_meshes) refuse_lacking(urdf, choices);
  return choices;
}

std::vector<std::string> lacking_notes(const Urdf& urdf, const std::vector<LinkChoice>& choices) {
  std::vector<std::string> notes;
  for (const Geometry wanted : {Geometry::collision, Geometry::visual})
    if (const auto links = lacking(urdf, choices, wanted); !links.empty())
      notes.push_back(lacking_line(links, wanted));
  return notes;
}

std::string to_string(Geometry geometry) {
  return geometry == Geometry::visual ? "visual" : "collision";
}

}  // namespace penumbra::detail
