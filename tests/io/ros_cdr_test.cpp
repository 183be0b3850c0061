// SPDX-License-Identifier: Apache-2.0
// CDR against Fast CDR, with which Fast DDS, ROS 2's default middleware, writes its messages.
#include "../support/random.hpp"
#include "ros_samples.hpp"

#include <functional>
#include <variant>

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>
#include <gtest/gtest.h>

#include <io/ros/cdr_writer.hpp>

namespace penumbra::io {
namespace {

using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;

using Value = std::variant<bool, std::uint8_t, std::int8_t, std::int16_t, std::uint16_t,
                           std::int32_t, std::uint32_t, std::int64_t, std::uint64_t, float, double,
                           std::string, std::vector<std::uint8_t>, std::vector<std::uint16_t>,
                           std::vector<float>, std::vector<double>, std::vector<std::string>,
                           std::array<std::int16_t, 3>, std::array<double, 2>>;

template <typename T>
struct IsArray : std::false_type {};
template <typename T, std::size_t N>
struct IsArray<std::array<T, N>> : std::true_type {};

// A random value of the kind `index`.
class AnyValue {
 public:
  explicit AnyValue(std::mt19937_64& random) : random_(random) {}

  Value of(std::size_t index) { return make<0>(index); }

 private:
  template <std::size_t i>
  Value make(std::size_t index) {
    if constexpr (i < std::variant_size_v<Value>) {
      if (index != i) return make<i + 1>(index);
      std::variant_alternative_t<i, Value> value{};
      fill(value);
      return value;
    }
    return {};
  }

  void fill(bool& value) { value = random_() % 2 == 0; }
  void fill(std::string& value) { value.assign(random_() % 9, 'x'); }
  template <typename T>
  void fill(std::vector<T>& values) {
    values.resize(random_() % 4);  // empty ones too
    for (T& value : values) fill(value);
  }
  template <typename T, std::size_t N>
  void fill(std::array<T, N>& values) {
    for (T& value : values) fill(value);
  }
  template <typename T>
  requires std::is_arithmetic_v<T>
  void fill(T& value) { value = static_cast<T>(random_() % 100'000'007); }

  std::mt19937_64& random_;
};

// What `call` writes. Fast CDR leaves padding as its memory was: 0.
std::vector<std::byte> by_fast_cdr(const std::function<void(Cdr&)>& call) {
  constexpr std::size_t enough = 8192;
  std::vector<char> memory(enough);
  FastBuffer buffer(memory.data(), memory.size());
  Cdr cdr(buffer, Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR);
  cdr.serialize_encapsulation();
  call(cdr);
  const auto* first = reinterpret_cast<const std::byte*>(buffer.getBuffer());
  return {first, first + cdr.getSerializedDataLength()};
}

std::vector<std::byte> by_fast_cdr(const std::vector<Value>& values) {
  return by_fast_cdr([&](Cdr& cdr) {
    for (const Value& value : values) std::visit([&](const auto& v) { cdr << v; }, value);
  });
}

void put(CdrWriter& writer, const Value& any) {
  std::visit(
      [&](const auto& value) {
        using T = std::decay_t<decltype(value)>;
        if constexpr (std::is_same_v<T, bool>) {
          writer.write_bool(value);
        } else if constexpr (std::is_same_v<T, std::string>) {
          writer.write_string(value);
        } else if constexpr (std::is_arithmetic_v<T>) {
          writer.write(value);
        } else {
          if constexpr (!IsArray<T>::value) writer.write_count(value.size());
          if constexpr (std::is_same_v<T, std::vector<std::string>>)
            for (const auto& text : value) writer.write_string(text);
          else
            writer.write_array(value.data(), value.size());
        }
      },
      any);
}

Value get(CdrReader& reader, Value like) {
  std::visit(
      [&](auto& value) {
        using T = std::decay_t<decltype(value)>;
        if constexpr (std::is_same_v<T, bool>) {
          value = reader.read_bool();
        } else if constexpr (std::is_same_v<T, std::string>) {
          value = reader.read_string();
        } else if constexpr (std::is_arithmetic_v<T>) {
          value = reader.read<T>();
        } else if constexpr (std::is_same_v<T, std::vector<std::string>>) {
          value.resize(reader.read_count(4));
          for (auto& text : value) text = reader.read_string();
        } else {
          if constexpr (!IsArray<T>::value) value.resize(reader.read_count(1));
          reader.read_array(value.data(), value.size());
        }
      },
      like);
  return like;
}

TEST(RosCdr, IsFastCdrs) {
  std::mt19937_64 random = test::seeded_random(3);
  constexpr int rounds = 3000;
  AnyValue any(random);
  for (int round = 0; round < rounds; ++round) {
    std::vector<Value> values;
    for (std::size_t n = random() % 12; n > 0; --n)
      values.push_back(any.of(random() % std::variant_size_v<Value>));
    const std::vector<std::byte> theirs = by_fast_cdr(values);
    std::vector<std::byte> ours;
    CdrWriter writer(ours);
    for (const Value& value : values) put(writer, value);
    ASSERT_EQ(ours, theirs) << "round " << round;

    const test::ExactCopy copy(theirs);
    CdrReader reader(copy.bytes());
    for (const Value& value : values) ASSERT_EQ(get(reader, value), value) << "round " << round;
    EXPECT_TRUE(reader.ok()) << reader.fault();
    EXPECT_EQ(reader.remaining(), 0U);
  }
}

}  // namespace
}  // namespace penumbra::io
