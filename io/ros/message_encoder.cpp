// SPDX-License-Identifier: Apache-2.0
#include <type_traits>

#include <io/ros/cdr_writer.hpp>
#include <io/ros/message_encoder.hpp>
#include <io/ros/wire_types-inl.hpp>

namespace penumbra::io {
namespace {

template <typename M>
void write_message(CdrWriter& writer, const M& message);

template <typename T>
void write_value(CdrWriter& writer, const T& value) {
  if constexpr (WireMessage<T>)
    write_message(writer, value);
  else if constexpr (std::is_same_v<T, bool>)
    writer.write_bool(value);
  else if constexpr (std::is_same_v<T, std::string>)
    writer.write_string(value);
  else
    writer.write(value);
}

template <typename T>
void write_member(CdrWriter& writer, const T& member) {
  if constexpr (Shape<T>::arity == Arity::one) {
    write_value(writer, member);
  } else {
    if constexpr (Shape<T>::arity == Arity::sequence) writer.write_count(member.size());
    if constexpr (std::is_class_v<typename Shape<T>::Value>)
      for (const auto& value : member) write_value(writer, value);
    else
      writer.write_array(member.data(), member.size());
  }
}

template <typename M, typename T>
void write_from(CdrWriter& writer, const M& message, const Member<M, T>& member) {
  write_member(writer, message.*member.at);
}

template <typename W, typename M, typename T>
void write_from(CdrWriter& writer, const M& message, const Converted<W, M, T>& member) {
  W wire;
  to_wire(message.*member.at, wire);
  write_member(writer, wire);
}

template <typename M>
void write_message(CdrWriter& writer, const M& message) {
  std::apply([&](const auto&... members) { (write_from(writer, message, members), ...); },
             Fields<M>::members);
}

}  // namespace

template <typename M>
void encode(const M& message, std::vector<std::byte>& payload, std::endian order) {
  CdrWriter writer(payload, order);
  write_message(writer, message);
}

template void encode(const ImageMessage&, std::vector<std::byte>&, std::endian);
template void encode(const CompressedImageMessage&, std::vector<std::byte>&, std::endian);
template void encode(const CameraInfoMessage&, std::vector<std::byte>&, std::endian);
template void encode(const JointStateMessage&, std::vector<std::byte>&, std::endian);
template void encode(const TfMessage&, std::vector<std::byte>&, std::endian);
template void encode(const StringMessage&, std::vector<std::byte>&, std::endian);
template void encode(const PoseStampedMessage&, std::vector<std::byte>&, std::endian);
template void encode(const PointCloud2Message&, std::vector<std::byte>&, std::endian);
template void encode(const DiagnosticArrayMessage&, std::vector<std::byte>&, std::endian);
template void encode(const KeypointsMessage&, std::vector<std::byte>&, std::endian);
template void encode(const TargetsMessage&, std::vector<std::byte>&, std::endian);

}  // namespace penumbra::io
