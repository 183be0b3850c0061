// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::io {

/// What one value of a field is on the wire. `octet` is ROS's uint8, byte and char: unsigned.
enum class WireType {
  boolean,
  octet,
  int8,
  int16,
  uint16,
  int32,
  uint32,
  int64,
  uint64,
  float32,
  float64,
  string,
  wstring,
  message
};

enum class Arity { one, array, sequence };

struct FieldDefinition {
  std::string name = {};
  std::string type_name = {};  ///< "float64", "std_msgs/Header"
  WireType type = WireType::octet;
  Arity arity = Arity::one;
  std::size_t count = 0;          ///< of an array; the most of a sequence, 0: any number
  std::size_t string_bound = 0;   ///< the most bytes of a string, 0: any number
  std::size_t nested = 0;         ///< of a message: index of its type
  std::string default_text = {};  ///< as it is written; empty: none
};

struct ConstantDefinition {
  std::string name = {};
  std::string type_name = {};
  std::string value_text = {};  ///< as it is written
};

/// One message type. Such without fields have one byte on the wire.
struct TypeDefinition {
  std::string name = {};  ///< "sensor_msgs/Image"
  std::vector<FieldDefinition> fields = {};
  std::vector<ConstantDefinition> constants = {};
  std::size_t min_bytes = 1;  ///< at least so many on the wire
};

/// A message's definition with those of all messages in it: ROS 2's "ros2msg" text, a .msg file
/// followed by its dependencies', each behind a line of "=" and a line "MSG: package/Type".
class MessageDefinition {
 public:
  static constexpr std::size_t max_text = std::size_t{1} << 20;  ///< bytes
  static constexpr std::size_t max_types = 256;

  /// `type`: "sensor_msgs/msg/Image" or "sensor_msgs/Image". builtin_interfaces/Time and Duration,
  /// also as `time` and `duration`, are known without their texts. Throws InputError, which names
  /// type and line, for a text that is none, types that are missing or doubled, and such that hold
  /// themselves.
  MessageDefinition(std::string_view type, std::string_view text);

  [[nodiscard]] const std::vector<TypeDefinition>& types() const { return types_; }
  [[nodiscard]] const TypeDefinition& root() const { return types_.front(); }

 private:
  std::vector<TypeDefinition> types_;
};

/// A field's type as a definition writes it: "string<=10[<=3]".
[[nodiscard]] std::string type_text(const FieldDefinition& field);

/// "sensor_msgs/Image" of "sensor_msgs/msg/Image"; other names as they are.
[[nodiscard]] std::string short_type(std::string_view type);

/// At least so many bytes that each value of the field takes.
[[nodiscard]] std::size_t min_bytes_each(const FieldDefinition& field,
                                         const std::vector<TypeDefinition>& types);

/// The built-in text of a type, "sensor_msgs/msg/Image" or "sensor_msgs/Image", as ROS 2 Humble has
/// it; empty for one that is not built in. Every message that is read or written is.
[[nodiscard]] std::string_view definition_of(std::string_view type);

}  // namespace penumbra::io
