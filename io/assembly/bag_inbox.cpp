// SPDX-License-Identifier: Apache-2.0
#include <penumbra/base/error.hpp>

#include <io/assembly/bag_inbox.hpp>
#include <io/files/printable.hpp>

namespace penumbra::io {

std::vector<std::string> BagInbox::notes() const {
  const auto damages = bag_->faults();
  std::vector<std::string> lines(damages.begin(), damages.end());
  for (const auto& [topic, faults] : faults_.all())
    lines.push_back(name_ + ": " + std::to_string(faults.messages) +
                    (faults.messages == 1 ? " message of " : " messages of ") + printable(topic) +
                    " cannot be used, the first recorded at " + std::to_string(faults.first) +
                    " ns: " + faults.what);
  return lines;
}

template <typename M>
Decoder<M> BagInbox::make_decoder(const BagTopic& topic) const {
  try {
    return {topic.type, topic.definition};
  } catch (const InputError& error) {
    throw InputError(name_ + ": " + printable(topic.name) + ": " + error.what());
  }
}

template Decoder<ImageMessage> BagInbox::make_decoder(const BagTopic&) const;
template Decoder<CompressedImageMessage> BagInbox::make_decoder(const BagTopic&) const;
template Decoder<CameraInfoMessage> BagInbox::make_decoder(const BagTopic&) const;
template Decoder<JointStateMessage> BagInbox::make_decoder(const BagTopic&) const;
template Decoder<TfMessage> BagInbox::make_decoder(const BagTopic&) const;
template Decoder<StringMessage> BagInbox::make_decoder(const BagTopic&) const;
template Decoder<Detection2DArrayMessage> BagInbox::make_decoder(const BagTopic&) const;
template Decoder<Detection3DArrayMessage> BagInbox::make_decoder(const BagTopic&) const;
template Decoder<KeypointsMessage> BagInbox::make_decoder(const BagTopic&) const;
template Decoder<PoseStampedMessage> BagInbox::make_decoder(const BagTopic&) const;

}  // namespace penumbra::io
