// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <sstream>

#include <fnmatch.h>

#include <penumbra/base/error.hpp>
#include <penumbra/base/text.hpp>
#include <penumbra/robot/link_choice-inl.hpp>

namespace penumbra::detail {
namespace {

constexpr double largest_margin = 1.0;  // metres

bool matches(const std::string& pattern, const std::string& link) {
  return ::fnmatch(pattern.c_str(), link.c_str(), FNM_NOESCAPE) == 0;
}

bool any_matches(const std::vector<std::string>& patterns, const std::string& link) {
  return std::any_of(patterns.begin(), patterns.end(),
                     [&](const std::string& pattern) { return matches(pattern, link); });
}

void require_match(const Urdf& urdf, const std::string& pattern, const std::string& option) {
  const auto is_match = [&](const UrdfLink& link) { return matches(pattern, link.name); };
  if (std::none_of(urdf.links.begin(), urdf.links.end(), is_match))
    throw InputError(urdf.file + ": " + option + " " + in_quotes(pattern) +
                     " matches no link; 'penumbra inspect' lists the links");
}

/// Returns the value of a setting for a link; null: no pattern matches it.
template <typename Value>
std::optional<Value> setting_of(const std::map<std::string, Value>& settings,
                                const UrdfLink& link) {
  if (const auto own = settings.find(link.name); own != settings.end()) return own->second;
  const std::string* first = nullptr;
  for (const auto& [pattern, value] : settings) {
    if (!matches(pattern, link.name)) continue;
    if (first != nullptr && settings.at(*first) != value)
      throw InputError(link.place + ": the patterns " + in_quotes(*first) + " and " +
                       in_quotes(pattern) + " have different values; use the link's name");
    if (first == nullptr) first = &pattern;
  }
  return first == nullptr ? std::nullopt : std::optional(settings.at(*first));
}

Geometry other(Geometry g) {
  return g == Geometry::visual ? Geometry::collision : Geometry::visual;
}

std::string name_of(Geometry g) { return g == Geometry::visual ? "visual" : "collision"; }

/// `given`: what was asked for; null: nothing.
void choose_geometry(const UrdfLink& link, std::optional<Geometry> given, bool fallback,
                     LinkChoice& choice) {
  const Geometry wanted = given.value_or(Geometry::collision);
  choice.geometry = wanted;
  const bool has_wanted = !link.elements(wanted).empty();
  const bool has_other = !link.elements(other(wanted)).empty();
  choice.draw = has_wanted || (has_other && (fallback || !given));
  if (has_wanted) {
    choice.reason = name_of(wanted);
  } else if (choice.draw) {
    choice.geometry = other(wanted);
    choice.is_substitute = !fallback;
    choice.reason = name_of(other(wanted)) + ", as it has no " + name_of(wanted);
  } else if (has_other) {
    choice.reason = "has no " + name_of(wanted) + ", only " + name_of(other(wanted));
    choice.lacks_geometry = true;
  } else {
    choice.reason = "has no geometry";
  }
}

/// Names the first of the links that a test picks, which have only the other kind of geometry;
/// empty: it picks none.
std::string without(Geometry wanted, const Urdf& urdf, const std::vector<LinkChoice>& choices,
                    const std::function<bool(const LinkChoice&)>& is_picked) {
  constexpr std::size_t most_names = 5;
  std::string names;
  std::size_t count = 0;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    if (!is_picked(choices[i])) continue;
    ++count;
    if (count <= most_names) names += (count > 1 ? ", " : "") + in_quotes(urdf.links[i].name);
  }
  if (count == 0) return {};
  return std::to_string(count) + (count == 1 ? " link has no " : " links have no ") +
         name_of(wanted) + " geometry, only " + name_of(other(wanted)) + ": " + names +
         (count > most_names ? ", ..." : "");
}

void check_options(const Urdf& urdf, const RobotOptions& options) {
  for (const auto& pattern : options.ignore_links) require_match(urdf, pattern, "ignore_links");
  for (const auto& pattern : options.only_links) require_match(urdf, pattern, "only_links");
  for (const auto& [pattern, geometry] : options.geometry_of_links)
    require_match(urdf, pattern, "geometry");
  for (const auto& [pattern, margin] : options.margins) {
    require_match(urdf, pattern, "margin");
    if (!(std::abs(margin) <= largest_margin))
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

}  // namespace

std::vector<LinkChoice> choose_links(const Urdf& urdf, const RobotOptions& options) {
  check_options(urdf, options);
  std::vector<LinkChoice> choices;
  for (const UrdfLink& link : urdf.links) {
    LinkChoice choice;
    choice.margin = setting_of(options.margins, link).value_or(0.0);
    if (any_matches(options.ignore_links, link.name)) {
      choice.reason = "ignored by ignore_links";
    } else if (!options.only_links.empty() && !any_matches(options.only_links, link.name)) {
      choice.reason = "left out by only_links";
    } else {
      const std::optional<Geometry> of_link = setting_of(options.geometry_of_links, link);
      choose_geometry(link, of_link ? of_link : options.geometry, options.geometry_fallback,
                      choice);
    }
    choices.push_back(std::move(choice));
  }
  if (!options.allow_missing_meshes && std::ranges::any_of(choices, &LinkChoice::lacks_geometry))
    throw InputError(urdf.file + ": " + geometry_notes(urdf, choices).front());
  return choices;
}

std::vector<std::string> geometry_notes(const Urdf& urdf, const std::vector<LinkChoice>& choices) {
  std::vector<std::string> notes;
  for (const Geometry wanted : {Geometry::collision, Geometry::visual}) {
    const std::string kind = name_of(other(wanted));
    const std::string links = without(wanted, urdf, choices, [&](const LinkChoice& choice) {
      return choice.lacks_geometry && choice.geometry == wanted;
    });
    if (links.empty()) continue;
    std::ostringstream note;
    note << links << "; use " << kind
         << " for such links (--geometry-fallback, or geometry: {LINK: " << kind
         << "}) or for all (--geometry " << kind
         << "), or leave out links that the real robot does not have (ignore_links)";
    notes.push_back(note.str());
  }
  const std::string drawn = without(Geometry::collision, urdf, choices, &LinkChoice::is_substitute);
  if (!drawn.empty())
    notes.push_back(drawn +
                    "; visual is drawn: leave out links that the real robot does not have "
                    "(ignore_links)");
  return notes;
}

}  // namespace penumbra::detail
