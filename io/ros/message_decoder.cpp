// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <type_traits>
#include <utility>

#include <penumbra/base/error.hpp>

#include <io/ros/cdr_fields.hpp>
#include <io/ros/cdr_reader.hpp>
#include <io/ros/message_decoder.hpp>
#include <io/ros/message_definition.hpp>
#include <io/ros/message_plan-inl.hpp>

namespace penumbra::io {
namespace {

// DDS fills payloads up to a multiple of four bytes.
constexpr std::size_t most_padding = 3;

template <typename M>
void read_message(CdrReader& reader, const MessagePlan& plan, M& message);

template <typename T>
void read_value(CdrReader& reader, const MessagePlan& plan, T& value) {
  if constexpr (WireMessage<T>)
    read_message(reader, plan, value);
  else if constexpr (std::is_same_v<T, bool>)
    value = reader.read_bool();
  else if constexpr (std::is_same_v<T, std::string>)
    value = reader.read_string();
  else
    value = reader.read<T>();
}

template <typename T>
void read_values(CdrReader& reader, const PlanStep& step, std::vector<T>& values) {
  const std::size_t count = count_values(reader, *step.field, step.min_bytes);
  if constexpr (std::is_arithmetic_v<T>) {
    values.resize(count);
    reader.read_array(values.data(), count);
  } else {
    for (std::size_t i = 0; i < count && reader.ok(); ++i) {
      if (i == values.size()) values.emplace_back();
      read_value(reader, step.nested, values[i]);
    }
    values.resize(reader.ok() ? count : 0);
  }
}

template <typename T>
void read_member(CdrReader& reader, const PlanStep& step, T& member) {
  if constexpr (std::is_same_v<T, std::span<const std::byte>>)
    member = reader.read_octets(count_values(reader, *step.field, step.min_bytes));
  else if constexpr (Shape<T>::arity == Arity::sequence)
    read_values(reader, step, member);
  else if constexpr (Shape<T>::arity == Arity::array)
    reader.read_array(member.data(), member.size());
  else
    read_value(reader, step.nested, member);
}

template <typename M, typename T>
void read_into(CdrReader& reader, const PlanStep& step, M& message, const Member<M, T>& member) {
  read_member(reader, step, message.*member.at);
}

template <typename W, typename M, typename T>
void read_into(CdrReader& reader, const PlanStep& step, M& message,
               const Converted<W, M, T>& member) {
  W wire;
  read_member(reader, step, wire);
  if (const char* fault = from_wire(wire, message.*member.at); fault != nullptr) reader.fail(fault);
}

template <typename M>
using ReadStep = void (*)(CdrReader&, const PlanStep&, M&);

template <typename M, std::size_t index>
void read_step(CdrReader& reader, const PlanStep& step, M& message) {
  read_into(reader, step, message, std::get<index>(Fields<M>::members));
}

template <typename M, std::size_t... indices>
constexpr std::array<ReadStep<M>, sizeof...(indices)> make_steps(std::index_sequence<indices...>) {
  return {read_step<M, indices>...};
}

template <typename M>
void read_message(CdrReader& reader, const MessagePlan& plan, M& message) {
  static constexpr auto steps =
      make_steps<M>(std::make_index_sequence<std::tuple_size_v<decltype(Fields<M>::members)>>());
  for (const PlanStep& step : plan.steps) {
    if (step.member < 0) {
      skip_field(reader, *step.field, *plan.types);
      if (!reader.ok()) return;
      continue;
    }
    steps[static_cast<std::size_t>(step.member)](reader, step, message);
    if (!reader.ok()) return reader.locate(step.field->name);
  }
}

std::string fault_list(const std::vector<std::string>& faults) {
  std::string text;
  for (const std::string& fault : faults) text += (text.empty() ? "" : ", ") + fault;
  return text;
}

// Fast DDS writes four bytes for each of its characters, others two.
std::string_view checked_type(std::string_view type, std::string_view wanted) {
  if (short_type(type) != wanted)
    throw InputError("messages of type '" + std::string(type) + "' cannot be read as " +
                     std::string(wanted));
  return type;
}

}  // namespace

template <typename M>
struct Decoder<M>::State {
  State(std::string_view type, std::string_view text)
      : definition(checked_type(type, Fields<M>::type), text) {
    refuse_wstrings(definition);
    PlanMaker maker(definition.types());
    plan = maker.plan<M>(0, "");
    if (!maker.faults().empty())
      throw InputError("message definition of '" + definition.root().name +
                       "': " + fault_list(maker.faults()));
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  MessageDefinition definition;
  MessagePlan plan;  // refers to the definition
};

template <typename M>
Decoder<M>::Decoder(std::string_view type, std::string_view definition)
    : state_(std::make_shared<const State>(type, definition)) {}

template <typename M>
Decoder<M>::Decoder() : Decoder(Fields<M>::type, definition_of(Fields<M>::type)) {}

template <typename M>
std::optional<std::string> Decoder<M>::decode(std::span<const std::byte> payload,
                                              M& message) const {
  CdrReader reader(payload);
  if (reader.ok()) read_message(reader, state_->plan, message);
  if (reader.remaining() > most_padding)
    reader.fail(std::to_string(reader.remaining()) +
                " bytes are left over: the definition is not this message's");
  if (reader.ok()) return std::nullopt;
  return std::string(Fields<M>::type) + ": " + reader.fault();
}

template <typename M>
std::string message_type() {
  std::string type(Fields<M>::type);
  return type.replace(type.find('/'), 1, "/msg/");
}

template class Decoder<ImageMessage>;
template class Decoder<CompressedImageMessage>;
template class Decoder<CameraInfoMessage>;
template class Decoder<JointStateMessage>;
template class Decoder<TfMessage>;
template class Decoder<StringMessage>;
template class Decoder<PoseStampedMessage>;
template class Decoder<Detection2DArrayMessage>;
template class Decoder<Detection3DArrayMessage>;
template class Decoder<PointCloud2Message>;
template class Decoder<DiagnosticArrayMessage>;
template class Decoder<KeypointsMessage>;
template class Decoder<TargetsMessage>;

template std::string message_type<ImageMessage>();
template std::string message_type<CompressedImageMessage>();
template std::string message_type<CameraInfoMessage>();
template std::string message_type<JointStateMessage>();
template std::string message_type<TfMessage>();
template std::string message_type<StringMessage>();
template std::string message_type<PoseStampedMessage>();
template std::string message_type<Detection2DArrayMessage>();
template std::string message_type<Detection3DArrayMessage>();
template std::string message_type<PointCloud2Message>();
template std::string message_type<DiagnosticArrayMessage>();
template std::string message_type<KeypointsMessage>();
template std::string message_type<TargetsMessage>();

}  // namespace penumbra::io
