// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include <dds/dds.h>

#include <io/dds/cdr_type.hpp>
#include <io/dds/graph_endpoints.hpp>
#include <io/dds/graph_log.hpp>
#include <io/dds/graph_names.hpp>
#include <io/dds/graph_session.hpp>
#include <io/dds/participant.hpp>
#include <io/dds/qos.hpp>

namespace penumbra::io {
namespace {

/// A topic entity. Each subscription and publication has one, because each has a type of its own.
class DdsTopic {
 public:
  DdsTopic(std::shared_ptr<GraphSession> session, const std::string& topic, const std::string& type,
           std::shared_ptr<ArrivalCounts> counts)
      : session_(std::move(session)) {
    const std::string name = dds_topic(topic);  // may throw, so it precedes the type
    type_ = make_cdr_type(dds_type(type), std::move(counts));
    entity_ = dds_create_topic_sertype(session_->participant(), name.c_str(), &type_, nullptr,
                                       nullptr, nullptr);
    if (entity_ < 0) ddsi_sertype_unref(type_);
    checked(entity_, "topic " + topic + " of type " + type);
  }
  ~DdsTopic() { dds_delete(entity_); }
  DdsTopic(const DdsTopic&) = delete;
  DdsTopic& operator=(const DdsTopic&) = delete;

  [[nodiscard]] const GraphSession& session() const { return *session_; }
  [[nodiscard]] const ddsi_sertype* type() const { return type_; }
  [[nodiscard]] dds_entity_t entity() const { return entity_; }

 private:
  std::shared_ptr<GraphSession> session_;
  ddsi_sertype* type_ = nullptr;  // owned by the entity after that is made
  dds_entity_t entity_ = 0;
};

class DdsSubscription final : public Subscription {
 public:
  DdsSubscription(std::shared_ptr<GraphSession> session, const std::string& topic,
                  const std::string& type, const TopicQos& qos)
      : topic_(std::move(session), topic, type, counts_) {
    const GraphSession& here = topic_.session();
    reader_ = checked(
        dds_create_reader(here.participant(), topic_.entity(), make_qos(qos, type).get(), nullptr),
        "subscription to " + topic);
    const dds_entity_t condition = dds_create_readcondition(reader_, DDS_ANY_STATE);
    checked(dds_waitset_attach(here.waitset(), condition, condition), "subscription to " + topic);
  }
  ~DdsSubscription() override { dds_delete(reader_); }

  bool take(SerializedMessage& message) override {
    for (;;) {
      ddsi_serdata* data = nullptr;
      dds_sample_info_t info;
      if (dds_takecdr(reader_, &data, 1, &info, DDS_ANY_STATE) != 1) return false;
      std::shared_ptr<const void> owner = own_taken(data);
      if (!info.valid_data) continue;  // the end of a publisher, not a message
      ++taken_;
      message = {cdr_bytes(data), std::move(owner), info.publication_handle, info.source_timestamp};
      return true;
    }
  }

  [[nodiscard]] SubscriptionStatus status() const override {
    SubscriptionStatus status;
    dds_subscription_matched_status_t matched{};
    if (dds_get_subscription_matched_status(reader_, &matched) == DDS_RETCODE_OK)
      status.publishers = static_cast<int>(matched.current_count);
    dds_requested_incompatible_qos_status_t refused{};
    if (dds_get_requested_incompatible_qos_status(reader_, &refused) == DDS_RETCODE_OK &&
        refused.total_count > 0) {
      status.refused = refused.total_count;
      status.refused_because = policy_name(refused.last_policy_id);
    }
    status.taken = taken_;
    status.overwritten = counts_->overwritten;
    status.received = counts_->received;
    status.lost = counts_->lost;
    return status;
  }

 private:
  std::shared_ptr<ArrivalCounts> counts_ = std::make_shared<ArrivalCounts>();
  DdsTopic topic_;
  dds_entity_t reader_ = 0;
  std::atomic<std::uint64_t> taken_ = 0;
};

// Much longer than graph_session.cpp lets subscribers acknowledge.
constexpr std::chrono::milliseconds longest_acknowledgement{300};

class DdsPublication final : public Publication {
 public:
  DdsPublication(std::shared_ptr<GraphSession> session, const std::string& topic,
                 const std::string& type, const TopicQos& qos, std::string_view definition)
      : topic_(std::move(session), topic, type, nullptr),
        writer_(checked(dds_create_writer(topic_.session().participant(), topic_.entity(),
                                          make_qos(qos, type, definition).get(), nullptr),
                        "publication of " + topic)),
        depth_(static_cast<std::uint64_t>(qos.depth)) {}
  ~DdsPublication() override { dds_delete(writer_); }

  bool write(std::span<const std::byte> data) override {
    const auto now = std::chrono::steady_clock::now();
    if (dds_wait_for_acks(writer_, 0) == DDS_RETCODE_OK) {
      waiting_ = 0;
      acknowledged_ = now;
    }
    if (++waiting_ > depth_ && now - acknowledged_ > longest_acknowledgement) ++unacknowledged_;
    return dds_writecdr(writer_, make_cdr_sample(topic_.type(), data)) == DDS_RETCODE_OK;
  }

  bool flush(std::chrono::nanoseconds at_most) override {
    return dds_wait_for_acks(writer_, at_most.count()) == DDS_RETCODE_OK;
  }

  [[nodiscard]] int subscribers() const override {
    dds_publication_matched_status_t matched{};
    dds_get_publication_matched_status(writer_, &matched);
    return static_cast<int>(matched.current_count);
  }

  [[nodiscard]] std::uint64_t unacknowledged() const override { return unacknowledged_; }

 private:
  DdsTopic topic_;
  dds_entity_t writer_ = 0;
  std::uint64_t depth_;
  std::uint64_t waiting_ = 0;  // messages since all earlier ones were acknowledged, at that time
  std::chrono::steady_clock::time_point acknowledged_;
  std::uint64_t unacknowledged_ = 0;
};

class DdsParticipant final : public Participant {
 public:
  explicit DdsParticipant(int domain)
      : domain_(domain),
        session_(std::make_shared<GraphSession>(domain)),
        endpoints_(session_->participant()) {}

  std::unique_ptr<Subscription> subscribe(const std::string& topic, const std::string& type,
                                          const TopicQos& qos) override {
    return std::make_unique<DdsSubscription>(session_, topic, type, qos);
  }

  std::unique_ptr<Publication> advertise(const std::string& topic, const std::string& type,
                                         const TopicQos& qos,
                                         std::string_view definition) override {
    return std::make_unique<DdsPublication>(session_, topic, type, qos, definition);
  }

  bool wait(std::chrono::nanoseconds at_most) override {
    const dds_duration_t longest = std::max<dds_duration_t>(at_most.count(), 0);
    const dds_return_t triggered = dds_waitset_wait(session_->waitset(), nullptr, 0, longest);
    bool woken = false;
    dds_take_guardcondition(session_->waker(), &woken);
    return triggered > 0;
  }

  void wake() override { dds_set_guardcondition(session_->waker(), true); }

  [[nodiscard]] std::vector<GraphTopic> graph() const override { return endpoints_.topics(); }

  [[nodiscard]] int domain() const override { return domain_; }

  std::vector<std::string> take_warnings() override { return take_logged_lines(); }

 private:
  int domain_;
  std::shared_ptr<GraphSession> session_;
  GraphEndpoints endpoints_;
};

}  // namespace

std::unique_ptr<Participant> join_graph(const ParticipantOptions& options) {
  return std::make_unique<DdsParticipant>(graph_domain(options));
}

}  // namespace penumbra::io
