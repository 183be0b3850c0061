// SPDX-License-Identifier: Apache-2.0
// Each reader on its seeds and on changed ones: they are read or refused in one line, without large
// memory.
#include "../support/allocations.hpp"
#include "../support/run_length.hpp"
#include "../support/test.hpp"
#include "readers.hpp"

namespace penumbra::fuzz {

void PrintTo(const Reader& reader, std::ostream* out) { *out << reader.name; }

namespace {

using Random = std::mt19937_64;

const std::filesystem::path here = PENUMBRA_SOURCE_DIR "/tests/fuzz";

std::vector<std::string> seeds_of(const std::string& name) {
  std::set<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(here / "seeds" / name))
    files.insert(entry.path());
  std::vector<std::string> seeds;
  for (const auto& file : files) seeds.push_back(test::read_bytes(file));
  return seeds;
}

/// The words of a dictionary, of those without escape sequences, and some that suit any format.
std::vector<std::string> words_of(const std::string& name) {
  std::vector<std::string> words{"",
                                 "0",
                                 "-1",
                                 "1e30",
                                 "nan",
                                 "4294967295",
                                 "18446744073709551615",
                                 std::string(4, '\0'),
                                 "\xff\xff\xff\xff",
                                 "\xff\xff\xff\x7f"};
  std::ifstream lines(here / "dictionaries" / (name + ".dict"));
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with('"') && line.find('\\') == std::string::npos)
      words.push_back(line.substr(1, line.size() - 2));
  return words;
}

bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
         std::string_view("_.-+#").find(c) != std::string_view::npos;
}

/// The piece of like characters about a place: a word, or what is between two.
std::pair<std::size_t, std::size_t> word_at(const std::string& text, std::size_t place) {
  const bool is = is_word(text[place]);
  std::size_t begin = place, end = place;
  while (begin > 0 && is_word(text[begin - 1]) == is) --begin;
  while (end < text.size() && is_word(text[end]) == is) ++end;
  return {begin, end - begin};
}

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos;
       at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

void change(std::string& bytes, const std::vector<std::string>& words, Random& random) {
  const std::size_t at = test::below(random, bytes.size());
  const std::size_t other = test::below(random, bytes.size());
  const std::size_t length = 1 + test::below(random, random() % 2 == 0 ? 4 : 64);
  const auto [begin, size] = word_at(bytes, at);
  const auto [other_begin, other_size] = word_at(bytes, other);
  const std::string word = random() % 2 == 0 ? words[test::below(random, words.size())]
                                             : bytes.substr(other_begin, other_size);
  switch (random() % 9) {
    case 0:
      bytes[at] = static_cast<char>(random());
      return;
    case 1:
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << random() % 8));
      return;
    case 2:
      bytes[at] = "<>\"'/=&-.0123456789 \n,:[]{}"[test::below(random, 27)];
      return;
    case 3:
      bytes.erase(at, length);
      return;
    case 4:
      bytes.insert(at, bytes.substr(other, length));
      return;
    case 5:
      bytes.replace(begin, size, word);
      return;
    case 6:  // both tags of an element, an id and what refers to it
      replace_all(bytes, bytes.substr(begin, size), word.substr(0, 100));
      return;
    case 7:
      bytes.replace(at, std::min(word.size(), bytes.size() - at), word);
      return;
    default:
      if (random() % 4 == 0) bytes.resize(at);
  }
}

class Corpus : public testing::TestWithParam<Reader> {
 protected:
  /// Returns whether the bytes are read. They end where their memory ends, so that sanitizers see
  /// each byte read past it.
  bool reads(const std::string& bytes) {
    const std::vector<char> exact(bytes.begin(), bytes.end());
    const test::MemoryShortage shortage(GetParam().large_memory, 0);
    fault_.clear();
    try {
      fault_ = test::refusal([&] { GetParam().read({exact.data(), exact.size()}); });
    } catch (const std::exception& error) {
      ADD_FAILURE() << error.what();
    }
    EXPECT_EQ(shortage.asked(), 0U) << "of " << GetParam().large_memory << " bytes or more";
    if (HasFailure()) {
      const auto kept = std::filesystem::temp_directory_path() / ("bad_" + GetParam().name);
      std::ofstream(kept, std::ios::binary) << bytes;
      ADD_FAILURE() << "kept in " << kept;
    }
    return fault_.empty();
  }

  std::string fault_;
};

TEST_P(Corpus, IsReadOrRefused) {
  const std::vector<std::string> seeds = seeds_of(GetParam().name);
  const std::vector<std::string> words = words_of(GetParam().name);
  const bool any = std::count_if(seeds.begin(), seeds.end(), [&](auto& s) { return reads(s); }) > 0;
  EXPECT_TRUE(any) << fault_;
  Random random = test::seeded_random(17);
  const int trials = GetParam().trials / (test::sanitized ? 2 : 1);
  for (int trial = 0; trial < trials && !HasFailure(); ++trial) {
    SCOPED_TRACE(testing::Message() << "trial " << trial);
    std::string bytes = seeds[test::below(random, seeds.size())];
    for (std::size_t n = 1 + test::below(random, 4); n > 0 && !bytes.empty(); --n)
      change(bytes, words, random);
    reads(bytes);
  }
}

INSTANTIATE_TEST_SUITE_P(Readers, Corpus, testing::ValuesIn(readers()),
                         [](const auto& of) { return of.param.name; });

}  // namespace
}  // namespace penumbra::fuzz
