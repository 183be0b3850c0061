// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include <penumbra/robot/mesh_formats-inl.hpp>
#include <penumbra/robot/mesh_text-inl.hpp>

namespace penumbra::mesh_formats {
namespace {

constexpr int deepest = 200;          // Assimp's reader recurses
constexpr double largest_unit = 1e6;  // metres

[[noreturn]] void damaged(const std::string& what) {
  throw FormatError(what + "; it is truncated or damaged; export or copy it again");
}

/// The value of an attribute of a tag's text; empty if it has none.
std::string attribute(std::string_view tag, std::string_view name) {
  for (std::size_t at = tag.find(name); at != std::string_view::npos; at = tag.find(name, at + 1)) {
    std::size_t i = at + name.size();
    while (i < tag.size() && is_space(tag[i])) ++i;
    if (at == 0 || !is_space(tag[at - 1]) || i >= tag.size() || tag[i] != '=') continue;
    ++i;
    while (i < tag.size() && is_space(tag[i])) ++i;
    if (i >= tag.size()) return {};
    const std::size_t end = tag.find(tag[i], i + 1);
    return std::string(tag.substr(i + 1, end == std::string_view::npos ? end : end - i - 1));
  }
  return {};
}

/// Calls f(text between < and >, text up to the next <) for every tag of an XML text.
template <typename F>
void for_each_tag(std::string_view xml, F&& f) {
  const auto skip_past = [&xml](std::string_view mark) {
    const std::size_t at = xml.find(mark);
    xml.remove_prefix(at == std::string_view::npos ? xml.size() : at + mark.size());
  };
  for (;;) {
    skip_past("<");
    if (xml.empty()) return;
    if (xml.starts_with("!--")) {
      skip_past("-->");
    } else if (xml.starts_with("![CDATA[")) {
      skip_past("]]>");
    } else {
      const std::string_view tag = xml.substr(0, xml.find('>'));
      xml.remove_prefix(std::min(tag.size() + 1, xml.size()));
      f(tag, xml.substr(0, xml.find('<')));
    }
  }
}

std::uint64_t count_attribute(std::string_view tag, const char* name,
                              std::optional<std::uint64_t> otherwise) {
  const std::string text = attribute(tag, name);
  if (text.empty() && otherwise) return *otherwise;
  const auto value = parse_number<std::uint32_t>(text);
  if (!value)
    damaged("Collada: " + std::string(name) + "=\"" + text.substr(0, 40) + "\" is no count in <" +
            std::string(tag.substr(0, 60)) + ">");
  return *value;
}

template <typename Number>
std::uint64_t count_numbers(std::string_view element, std::string_view text) {
  std::uint64_t count = 0;
  for (std::string_view word = take_word(text); !word.empty(); word = take_word(text), ++count)
    if (!parse_number<Number>(word))
      damaged("Collada: '" + std::string(word.substr(0, 40)) + "' is no number in <" +
              std::string(element) + ">");
  return count;
}

/// Assimp takes a unit that it cannot read for a metre.
void check_unit(std::string_view tag) {
  const std::string text = attribute(tag, "meter");
  if (text.empty() && tag.find("meter=") == std::string_view::npos) return;
  const auto metres = parse_number<double>(text);
  if (!metres || !(*metres > 0.0 && *metres <= largest_unit))
    throw FormatError("Collada: unit meter=\"" + text.substr(0, 40) +
                      "\" is no length; write how many metres the unit has");
}

/// The numbers of a Collada file: Assimp never ends at a letter in a list of indices, and reads
/// beyond an array that is shorter than its accessor.
class ColladaNumbers {
 public:
  void element(std::string_view name, std::string_view tag, std::string_view text) {
    if (name == "p" || name == "vcount" || name == "h" || name == "v")
      count_numbers<std::int64_t>(name, text);
    for (const char* const transform : {"translate", "rotate", "scale", "matrix", "lookat", "skew"})
      if (name == transform) count_numbers<double>(name, text);
    if (name == "float_array") float_array(tag, text);
    if (name == "accessor") accessors_.push_back(std::string(tag));
    if (name == "input") count_attribute(tag, "offset", 0);
    if (name == "triangles" || name == "polylist" || name == "polygons" || name == "tristrips" ||
        name == "trifans")
      count_attribute(tag, "count", 0);
  }

  void finish() const {
    for (const std::string& tag : accessors_) {
      const auto array = arrays_.find(attribute(tag, "source"));
      if (array == arrays_.end()) continue;  // names and the like, of skins
      const std::uint64_t stride = count_attribute(tag, "stride", 1);
      const std::uint64_t needed =
          count_attribute(tag, "offset", 0) + count_attribute(tag, "count", std::nullopt) * stride;
      if (stride == 0 || needed > array->second)
        damaged("Collada: an accessor reads " + std::to_string(needed) + " of the " +
                std::to_string(array->second) + " numbers of '" + array->first.substr(0, 40) + "'");
    }
  }

 private:
  void float_array(std::string_view tag, std::string_view text) {
    const std::uint64_t promised = count_attribute(tag, "count", std::nullopt);
    const std::uint64_t found = count_numbers<double>("float_array", text);
    if (found != promised)
      damaged("Collada: an array promises " + std::to_string(promised) + " numbers and has " +
              std::to_string(found));
    arrays_["#" + attribute(tag, "id")] = found;
  }

  std::map<std::string, std::uint64_t> arrays_;
  std::vector<std::string> accessors_;
};

/// What a Collada file's nodes hold and refer to. Assimp leaves out what it does not find, and
/// follows nodes that instance each other until the stack ends.
class ColladaCheck {
 public:
  void tag(std::string_view tag, std::string_view text) {
    if (tag.starts_with('?') || tag.starts_with('!')) return;
    std::string_view rest = tag;
    std::string_view name = take_word(rest);
    const bool is_empty = tag.ends_with('/');
    if (name.ends_with('/')) name.remove_suffix(1);
    if (name.starts_with('/')) {
      close(name.substr(1));
      return;
    }
    numbers_.element(name, tag, text);
    open(name, tag, is_empty);
  }

  void finish() {
    numbers_.finish();
    for (const std::string& url : geometries_used_) {
      if (!url.starts_with('#') || geometries_.count(url.substr(1)) == 0) missing(url);
    }
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      if (unfold(i, 0) > most_nodes) damaged("Collada: its nodes unfold to more than a million");
    const auto is_shown = [](const Node& node) { return node.in_scene && node.shows_geometry; };
    if (std::none_of(nodes_.begin(), nodes_.end(), is_shown))
      throw FormatError("Collada: its scene shows no geometry; export the mesh as part of a scene");
  }

 private:
  struct Node {
    std::vector<std::size_t> children;
    std::vector<std::string> instances;
    double unfolded = 0.0;  // how many nodes it stands for; 0: not counted yet
    bool in_scene = false;
    bool shows_geometry = false;  // itself or a node in it
  };

  static constexpr double most_nodes = 1e6;

  [[noreturn]] static void missing(const std::string& url) {
    throw FormatError("Collada: it refers to '" + url.substr(0, 80) +
                      "', which is not in the file; export everything into one file");
  }

  void open(std::string_view name, std::string_view tag, bool is_empty) {
    if (!is_empty && ++depth_ > deepest)
      damaged("Collada: elements are nested more than " + std::to_string(deepest) + " deep");
    if (name == "geometry" || name == "controller") geometries_.insert(attribute(tag, "id"));
    if (name == "unit") check_unit(tag);
    if (name == "visual_scene") in_scene_ = !is_empty;
    if (name == "instance_geometry" || name == "instance_controller") {
      geometries_used_.push_back(attribute(tag, "url"));
      if (!open_nodes_.empty()) nodes_[open_nodes_.back()].shows_geometry = true;
    }
    if (name == "instance_node" && !open_nodes_.empty())
      nodes_[open_nodes_.back()].instances.push_back(attribute(tag, "url"));
    if (name == "node") open_node(attribute(tag, "id"), is_empty);
  }

  void open_node(const std::string& id, bool is_empty) {
    const std::size_t number = nodes_.size();
    nodes_.emplace_back().in_scene = in_scene_;
    if (!id.empty()) node_of_id_.emplace(id, number);
    if (!open_nodes_.empty()) nodes_[open_nodes_.back()].children.push_back(number);
    if (!is_empty) open_nodes_.push_back(number);
  }

  void close(std::string_view name) {
    --depth_;
    if (name == "visual_scene") in_scene_ = false;
    if (name == "node" && !open_nodes_.empty()) open_nodes_.pop_back();
  }

  double unfold(std::size_t number, int depth) {
    if (depth > deepest) damaged("Collada: its nodes contain each other");
    if (nodes_[number].unfolded > 0.0) return nodes_[number].unfolded;
    double sum = 1.0;
    const auto take_in = [&](std::size_t other) {
      sum += unfold(other, depth + 1);
      nodes_[number].shows_geometry |= nodes_[other].shows_geometry;
    };
    for (const std::size_t child : nodes_[number].children) take_in(child);
    for (const std::string& url : nodes_[number].instances) {
      const auto found = url.starts_with('#') ? node_of_id_.find(url.substr(1)) : node_of_id_.end();
      if (found == node_of_id_.end()) missing(url);
      take_in(found->second);
    }
    return nodes_[number].unfolded = sum;
  }

  ColladaNumbers numbers_;
  int depth_ = 0;
  bool in_scene_ = false;
  std::set<std::string> geometries_;
  std::vector<std::string> geometries_used_;
  std::vector<Node> nodes_;
  std::vector<std::size_t> open_nodes_;
  std::map<std::string, std::size_t> node_of_id_;
};

}  // namespace

void check_collada(std::string_view bytes) {
  ColladaCheck check;
  for_each_tag(bytes, [&](std::string_view tag, std::string_view text) { check.tag(tag, text); });
  check.finish();
}

}  // namespace penumbra::mesh_formats
