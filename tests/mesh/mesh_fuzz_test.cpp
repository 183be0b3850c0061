// SPDX-License-Identifier: Apache-2.0
// Mesh files with damaged bytes and swapped, removed, doubled and renamed words are read or refused
// in one line.
#include "mesh_samples.hpp"

#include <penumbra/mesh/mesh_file.hpp>

namespace penumbra::test {
namespace {

using Random = std::mt19937_64;

bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
         std::string_view("_.-+#").find(c) != std::string_view::npos;
}

/// Returns words and the text between them, alternately.
std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> tokens;
  for (std::size_t i = 0; i < text.size();) {
    const bool word = is_word(text[i]);
    const std::size_t begin = i;
    while (i < text.size() && is_word(text[i]) == word) ++i;
    tokens.push_back(text.substr(begin, i - begin));
  }
  return tokens;
}

std::string foreign_word(Random& random) {
  static const std::vector<std::string> words = split(
      "skew|lookat|matrix|rotate|scale|translate|polylist|polygons|triangles|lines|linestrips|"
      "trifans|tristrips|p|ph|h|vcount|input|source|vertices|float_array|int_array|Name_array|"
      "IDREF_array|accessor|param|technique|node|instance_node|instance_geometry|"
      "instance_controller|controller|skin|morph|joints|vertex_weights|extra|asset|unit|mesh|"
      "geometry|library_nodes|library_lights|library_animations|animation|sampler|channel|"
      "POSITION|NORMAL|TEXCOORD|COLOR|VERTEX|offset|set|sparse|byteStride|byteOffset|"
      "normalized|indices|targets|skins|animations|children|images|textures|cameras|mode|MAT4|"
      "VEC2|VEC4|SCALAR|5120|5121|5122|5125|uri|extensions|max|min|0|-1|1|2|3|4|5|6|7|16|1e30|"
      "nan|inf|99999999999|4294967295|2147483648|18446744073709551615|-0|0.5|x|#|true|null|"
      "KHR_draco_mesh_compression");
  return words[2 * (random() % (words.size() / 2))];
}

void mutate(std::vector<std::string>& tokens, Random& random) {
  const auto pick = [&]() -> std::string& { return tokens[random() % tokens.size()]; };
  std::string& one = pick();
  const std::string before = one;
  const std::string other = random() % 2 == 0 ? pick() : foreign_word(random);
  switch (random() % 7) {
    case 0:
      std::swap(one, pick());
      return;
    case 1:
      one.clear();
      return;
    case 2:
      one += " " + one;
      return;
    case 3:
    case 4:
      one = other;
      return;
    default:  // an element's both tags, an id and what refers to it
      if (is_word(before.empty() ? ' ' : before[0]))
        std::replace(tokens.begin(), tokens.end(), before, other);
  }
}

/// Removes, doubles or moves the text between two marks, mostly whole brackets or tags.
std::string shuffled(std::string text, Random& random) {
  const std::string_view open = text.starts_with('<') ? "<" : "{[,";
  const auto mark = [&] {
    return std::min(text.find_first_of(open, random() % text.size()), text.size());
  };
  const std::size_t begin = mark(), end = std::max(begin, mark());
  const std::string piece = text.substr(begin, end - begin);
  if (random() % 2 == 0) text.erase(begin, piece.size());
  if (random() % 2 == 0) text.insert(mark(), piece);
  return text;
}

std::string with_damaged_bytes(std::string bytes, Random& random) {
  for (std::uint64_t n = 1 + random() % 4; n > 0; --n)
    bytes[random() % bytes.size()] = char(random());
  if (random() % 8 == 0) bytes.erase(random() % bytes.size(), 1 + random() % 16);
  return bytes;
}

std::string mutated(const std::string& text, Random& random) {
  if (random() % 3 == 0) return with_damaged_bytes(text, random);
  std::vector<std::string> tokens = split(text);
  for (std::uint64_t n = 1 + random() % 3; n > 0; --n) mutate(tokens, random);
  std::string result;
  for (const std::string& token : tokens) result += token;
  return random() % 4 == 0 && !result.empty() ? shuffled(std::move(result), random) : result;
}

/// Each format and each of Collada's primitives.
std::vector<Sample> fuzz_samples() {
  std::vector<Sample> all = samples();
  all.push_back({"n.dae", collada("<unit name=\"meter\" meter=\"1\"/>",
                                  "<node id=\"m\"><rotate>0 0 1 90</rotate><scale>1 2 1</scale>"
                                  "<instance_node url=\"#n\"/></node>" +
                                      collada_node("<translate>1 0 0</translate>"))});
  const std::string& input = vertex_input;
  for (const std::string& primitive :
       {"<polylist count=\"2\">" + input + "<vcount>3 4</vcount><p>0 2 1 0 1 3 2</p></polylist>",
        "<polygons count=\"2\">" + input + "<p>0 2 1</p><p>0 1 3 2</p></polygons>",
        "<tristrips count=\"1\">" + input + "<p>0 1 2 3</p></tristrips>",
        "<trifans count=\"1\">" + input + "<p>0 1 2 3</p></trifans>"})
    all.push_back({"p.dae", with_primitive(primitive)});
  all.push_back({"a.gltf", gltf_json(",\"uri\":\"a.bin\"", ",\"scale\":[1,2,1]")});
  return all;
}

void fuzz(int trials, std::uint64_t default_seed) {
  const std::uint64_t seed = seeded_random(default_seed)();
  const TemporaryFolder folder;
  folder.write("a.bin", gltf_buffer());
  const std::vector<Sample> samples = fuzz_samples();
  for (int trial = 0; trial < trials; ++trial) {
    Random random(seed + std::uint64_t(trial));
    const Sample& sample = trial % 3 == 0 ? samples.back() : samples[random() % samples.size()];
    const auto file = folder.write(sample.name, mutated(sample.bytes, random));
    SCOPED_TRACE(testing::Message() << "trial " << trial << " of seed " << default_seed);
    std::size_t triangles = 0;
    const std::string why = test::refusal([&] { triangles = load_mesh(file).triangles.size(); });
    ASSERT_TRUE(triangles > 0 || why.find(';') != std::string::npos) << why;
  }
}

TEST(MeshFuzz, SwappedWordsAreReadOrRefused) {
  fuzz(2500, 11);
  if (is_full_run()) fuzz(100000, 13);
}

}  // namespace
}  // namespace penumbra::test
