#include "apps/ros2/node.h"

#include <fmt/format.h>

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <map>
#include <mutex>
#include <set>
#include <utility>

#include "apps/ros2/type_hashes.h"
#include "hg/core/error.h"
#include "hg/messages/cdr_writer.h"

namespace hg::ros2 {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using eprosima::fastrtps::types::ReturnCode_t;

namespace {

constexpr int kDepth = 10;

// of ros_discovery_info, by which ROS 2 knows nodes: rmw_dds_common/msg/ParticipantEntitiesInfo
struct Gid {
  std::array<std::uint8_t, 16> data{};
};
struct NodeEntitiesInfo {
  std::string node_namespace, node_name;
  std::vector<Gid> reader_gid_seq, writer_gid_seq;
};
struct ParticipantEntitiesInfo {
  Gid gid;
  std::vector<NodeEntitiesInfo> node_entities_info_seq;
};

template <typename Archive, Is<Gid> T>
void fields(Archive& a, T& gid) {
  for (auto& byte : gid.data) a("data", byte);
}

template <typename Archive, Is<NodeEntitiesInfo> T>
void fields(Archive& a, T& node) {
  a("node_namespace", node.node_namespace);
  a("node_name", node.node_name);
  a("reader_gid_seq", node.reader_gid_seq);
  a("writer_gid_seq", node.writer_gid_seq);
}

template <typename Archive, Is<ParticipantEntitiesInfo> T>
void fields(Archive& a, T& info) {
  a("gid", info.gid);
  a("node_entities_info_seq", info.node_entities_info_seq);
}

Gid gid_of(const rtps::GUID_t& guid) {
  Gid gid;
  std::memcpy(gid.data.data(), guid.guidPrefix.value, rtps::GuidPrefix_t::size);
  std::memcpy(gid.data.data() + rtps::GuidPrefix_t::size, guid.entityId.value,
              rtps::EntityId_t::size);
  return gid;
}

rtps::GUID_t guid_of(const std::array<std::uint8_t, 16>& bytes) {
  rtps::GUID_t guid;
  std::memcpy(guid.guidPrefix.value, bytes.data(), rtps::GuidPrefix_t::size);
  std::memcpy(guid.entityId.value, bytes.data() + rtps::GuidPrefix_t::size, rtps::EntityId_t::size);
  return guid;
}

// a type of which this program knows the bytes and the name only
class BytesType final : public dds::TopicDataType {
 public:
  explicit BytesType(const std::string& name) {
    setName(name.c_str());
    m_typeSize = 256;  // a first guess; buffers grow
    auto_fill_type_object(false);
    auto_fill_type_information(false);
  }

  bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
    const Bytes& bytes = *static_cast<const Bytes*>(data);
    if (bytes.size() > payload->max_size) return false;
    std::memcpy(payload->data, bytes.data(), bytes.size());
    payload->length = static_cast<std::uint32_t>(bytes.size());
    payload->encapsulation = CDR_LE;
    return true;
  }

  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    auto& bytes = *static_cast<std::vector<std::byte>*>(data);
    const auto* begin = reinterpret_cast<const std::byte*>(payload->data);
    bytes.assign(begin, begin + payload->length);
    return true;
  }

  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    const auto size = static_cast<std::uint32_t>(static_cast<const Bytes*>(data)->size());
    return [size] { return size; };
  }

  void* createData() override { return new std::vector<std::byte>; }
  void deleteData(void* data) override { delete static_cast<std::vector<std::byte>*>(data); }
  bool getKey(void*, rtps::InstanceHandle_t*, bool) override { return false; }
};

// "sensor_msgs/msg/JointState" -> "sensor_msgs::msg::dds_::JointState_"
std::string dds_type(std::string_view type, std::string_view ending = "") {
  const std::size_t first = type.find('/'), last = type.rfind('/');
  if (first == std::string_view::npos || last == first) {
    throw SetupError(fmt::format("{}: expected the name of a ROS type, PACKAGE/msg/NAME", type));
  }
  return fmt::format("{}::{}::dds_::{}{}_", type.substr(0, first),
                     type.substr(first + 1, last - first - 1), type.substr(last + 1), ending);
}

// who listens to a writer
class Listeners final : public dds::DataWriterListener {
 public:
  void on_publication_matched(dds::DataWriter*,
                              const dds::PublicationMatchedStatus& status) override {
    const std::lock_guard lock(mutex_);
    const auto guid = rtps::iHandle2GUID(status.last_subscription_handle);
    if (status.current_count_change > 0) {
      guids_.insert(guid);
    } else {
      guids_.erase(guid);
    }
  }
  bool has(const rtps::GUID_t& guid) const {
    const std::lock_guard lock(mutex_);
    return guids_.contains(guid);
  }
  int count() const {
    const std::lock_guard lock(mutex_);
    return static_cast<int>(guids_.size());
  }

 private:
  mutable std::mutex mutex_;
  std::set<rtps::GUID_t> guids_;
};

class Arrivals final : public dds::DataReaderListener {
 public:
  explicit Arrivals(std::function<void()> arrived) : arrived_(std::move(arrived)) {}
  void on_data_available(dds::DataReader*) override {
    if (arrived_) arrived_();
  }
  void on_subscription_matched(dds::DataReader*,
                               const dds::SubscriptionMatchedStatus& status) override {
    count_ = status.current_count;
  }
  int count() const { return count_; }

 private:
  std::function<void()> arrived_;
  std::atomic<int> count_ = 0;
};

}  // namespace

class Node::Impl {
 public:
  explicit Impl(const NodeOptions& options) : options_(options) {
    dds::DomainParticipantQos qos = dds::PARTICIPANT_QOS_DEFAULT;
    qos.name("/");
    set_user_data(qos.user_data(), "enclave=/;");
    // sockets only: peers are of other versions, whose shared memory may be arranged differently
    const auto transport = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
    if (options.is_local) {
      transport->interfaceWhiteList.emplace_back("127.0.0.1");
      call_on_local_peers(qos, options.domain);
    }
    qos.transport().use_builtin_transports = false;
    qos.transport().user_transports.push_back(transport);
    participant_ = dds::DomainParticipantFactory::get_instance()->create_participant(
        static_cast<dds::DomainId_t>(options.domain), qos);
    if (participant_ == nullptr) {
      throw SetupError(fmt::format("ROS 2: domain {} cannot be joined", options.domain));
    }
    publisher_ = participant_->create_publisher(dds::PUBLISHER_QOS_DEFAULT);
    subscriber_ = participant_->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
    info_.gid = gid_of(participant_->guid());
    space_ = options.space;
    info_.node_entities_info_seq = {
        {.node_namespace = space_.empty() ? "/" : space_, .node_name = options.name}};
    info_writer_ =
        writer("ros_discovery_info", "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_", "",
               Delivery::kLatched, nullptr);
  }

  ~Impl() {
    participant_->delete_contained_entities();
    dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }

  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  std::string full_name(std::string_view topic) const { return space_ + std::string(topic); }

  dds::DataWriter* writer(const std::string& topic, const std::string& type, std::string_view hash,
                          Delivery how, dds::DataWriterListener* listener) {
    dds::DataWriterQos qos = dds::DATAWRITER_QOS_DEFAULT;
    qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
    qos.history().kind = dds::KEEP_LAST_HISTORY_QOS;
    qos.history().depth = how == Delivery::kLatched ? 1 : kDepth;
    qos.durability().kind = how == Delivery::kLatched ? dds::TRANSIENT_LOCAL_DURABILITY_QOS
                                                      : dds::VOLATILE_DURABILITY_QOS;
    qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    if (how == Delivery::kLatched) qos.publish_mode().kind = dds::ASYNCHRONOUS_PUBLISH_MODE;
    qos.data_sharing().off();
    set_user_data(qos.user_data(), hash);
    dds::DataWriter* made = publisher_->create_datawriter(topic_of(topic, type), qos, listener,
                                                          dds::StatusMask::publication_matched());
    if (made == nullptr) throw SetupError(fmt::format("{}: cannot be published", topic));
    return made;
  }

  dds::DataReader* reader(const std::string& topic, const std::string& type, std::string_view hash,
                          dds::DataReaderListener* listener) {
    dds::DataReaderQos qos = dds::DATAREADER_QOS_DEFAULT;
    qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
    qos.history().kind = dds::KEEP_LAST_HISTORY_QOS;
    qos.history().depth = kDepth;
    qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    qos.data_sharing().off();
    set_user_data(qos.user_data(), hash);
    dds::DataReader* made = subscriber_->create_datareader(
        topic_of(topic, type), qos, listener,
        dds::StatusMask::data_available() << dds::StatusMask::subscription_matched());
    if (made == nullptr) throw SetupError(fmt::format("{}: cannot be subscribed", topic));
    return made;
  }

  void remove(dds::DataWriter* one) {
    show(one->guid(), false, true);
    dds::Topic* topic = one->get_topic();
    publisher_->delete_datawriter(one);
    participant_->delete_topic(topic);  // refused while another end uses it
  }
  void remove(dds::DataReader* one) {
    show(one->guid(), false, false);
    const dds::TopicDescription* topic = one->get_topicdescription();
    subscriber_->delete_datareader(one);
    participant_->delete_topic(const_cast<dds::Topic*>(dynamic_cast<const dds::Topic*>(topic)));
  }

  // informs ROS 2 that this end belongs to the node, or no longer does
  void show(const rtps::GUID_t& guid, bool is_there, bool is_writer) {
    NodeEntitiesInfo& node = info_.node_entities_info_seq.front();
    std::vector<Gid>& gids = is_writer ? node.writer_gid_seq : node.reader_gid_seq;
    const Gid gid = gid_of(guid);
    if (is_there) {
      gids.push_back(gid);
    } else {
      std::erase_if(gids, [&](const Gid& one) { return one.data == gid.data; });
    }
    Bytes bytes = cdr_.encode(info_);
    info_writer_->write(&bytes);
  }

 private:
  template <typename Policy>
  static void set_user_data(Policy& policy, std::string_view text) {
    policy.setValue({text.begin(), text.end()});
  }

  // multicast does not go to 127.0.0.1: asks at the ports of the first 32 programs of the domain
  static void call_on_local_peers(dds::DomainParticipantQos& qos, int domain) {
    for (std::uint32_t i = 0; i < 32; ++i) {
      rtps::Locator_t locator;
      locator.kind = LOCATOR_KIND_UDPv4;
      rtps::IPLocator::setIPv4(locator, "127.0.0.1");
      locator.port = 7400 + 250 * static_cast<std::uint32_t>(domain) + 10 + 2 * i;
      qos.wire_protocol().builtin.initialPeersList.push_back(locator);
    }
  }

  dds::Topic* topic_of(const std::string& name, const std::string& type) {
    if (auto* known = participant_->lookup_topicdescription(name); known != nullptr) {
      return dynamic_cast<dds::Topic*>(known);
    }
    if (participant_->find_type(type).empty()) {
      dds::TypeSupport(new BytesType(type)).register_type(participant_);
    }
    dds::Topic* made = participant_->create_topic(name, type, dds::TOPIC_QOS_DEFAULT);
    if (made == nullptr) throw SetupError(fmt::format("{}: no such topic can be made", name));
    return made;
  }

  NodeOptions options_;
  std::string space_;
  dds::DomainParticipant* participant_ = nullptr;
  dds::Publisher* publisher_ = nullptr;
  dds::Subscriber* subscriber_ = nullptr;
  ParticipantEntitiesInfo info_;
  dds::DataWriter* info_writer_ = nullptr;
  messages::CdrWriter cdr_;
};

namespace {

// an end of the node that is there as long as this object
template <typename End, typename Impl>
class Shown {
 public:
  Shown(Impl& node, End* end, bool is_writer) : node_(node), end_(end) {
    node.show(end->guid(), true, is_writer);
  }
  ~Shown() { node_.remove(end_); }
  Shown(const Shown&) = delete;
  Shown& operator=(const Shown&) = delete;
  End* operator->() const { return end_; }

 private:
  Impl& node_;
  End* end_;
};

template <typename Impl>
class DdsPublisher final : public Publisher {
 public:
  DdsPublisher(Impl& node, const std::string& topic, std::string_view type, Delivery how)
      : writer_(node, node.writer(topic, dds_type(type), type_hash(type), how, &listeners_), true) {
  }
  bool publish(Bytes message) override { return writer_->write(&message); }
  int subscribers() const override { return listeners_.count(); }

 private:
  Listeners listeners_;  // outlives the writer
  Shown<dds::DataWriter, Impl> writer_;
};

template <typename Impl>
class DdsSubscription final : public Subscription {
 public:
  DdsSubscription(Impl& node, const std::string& topic, std::string_view type,
                  std::function<void()> arrived)
      : arrivals_(std::move(arrived)),
        reader_(node, node.reader(topic, dds_type(type), type_hash(type), &arrivals_), false) {}

  bool take(std::vector<std::byte>& message) override {
    dds::SampleInfo info;
    while (reader_->take_next_sample(&message, &info) == ReturnCode_t::RETCODE_OK) {
      if (info.valid_data) return true;  // else: a publisher has left
    }
    return false;
  }
  int publishers() const override { return arrivals_.count(); }

 private:
  Arrivals arrivals_;
  Shown<dds::DataReader, Impl> reader_;
};

template <typename Impl>
class DdsService final : public Service {
 public:
  DdsService(Impl& node, const std::string& name, std::string_view type,
             std::function<void()> arrived)
      : arrivals_(std::move(arrived)),
        writer_(node,
                node.writer("rr" + name + "Reply", dds_type(type, "_Response"), type_hash(type),
                            Delivery::kStream, &listeners_),
                true),
        reader_(node,
                node.reader("rq" + name + "Request", dds_type(type, "_Request"), type_hash(type),
                            &arrivals_),
                false) {}

  bool take(Request& request) override {
    dds::SampleInfo info;
    while (reader_->take_next_sample(&request.message, &info) == ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) continue;
      // a client names the reader that waits for the answer; older ones, nothing
      const rtps::GUID_t& reader = info.related_sample_identity.writer_guid();
      const bool is_named = reader != rtps::GUID_t::unknown();
      request.client = gid_of(is_named ? reader : info.sample_identity.writer_guid()).data;
      request.number = info.sample_identity.sequence_number().to64long();
      return true;
    }
    return false;
  }

  bool answer(const Request& request, Bytes message) override {
    const rtps::GUID_t client = guid_of(request.client);
    const bool is_reader = (client.entityId.value[3] & 0x04) != 0;  // kinds 04, 07: readers
    if (is_reader && !listeners_.has(client)) return false;
    rtps::WriteParams to;
    to.related_sample_identity().writer_guid() = client;
    to.related_sample_identity().sequence_number() =
        rtps::SequenceNumber_t(static_cast<std::uint64_t>(request.number));
    return writer_->write(&message, to);
  }

 private:
  Listeners listeners_;
  Arrivals arrivals_;
  Shown<dds::DataWriter, Impl> writer_;
  Shown<dds::DataReader, Impl> reader_;
};

}  // namespace

bool is_name(std::string_view text) noexcept {
  const auto is_letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
  };
  char before = '/';
  for (const char c : text) {
    const bool is_digit = c >= '0' && c <= '9';
    if (c == '/' || is_digit ? before == '/' : !is_letter(c)) return false;
    if (c == '_' && before == '_') return false;
    before = c;
  }
  return before != '/';
}

Node::Node(const NodeOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Node::~Node() = default;

std::string Node::full_name(std::string_view topic) const { return impl_->full_name(topic); }

std::unique_ptr<Publisher> Node::publish(std::string_view topic, std::string_view type,
                                         Delivery how) {
  return std::make_unique<DdsPublisher<Impl>>(*impl_, "rt" + full_name(topic), type, how);
}

std::unique_ptr<Subscription> Node::subscribe(std::string_view topic, std::string_view type,
                                              std::function<void()> arrived) {
  return std::make_unique<DdsSubscription<Impl>>(*impl_, "rt" + full_name(topic), type,
                                                 std::move(arrived));
}

std::unique_ptr<Service> Node::serve(std::string_view name, std::string_view type,
                                     std::function<void()> arrived) {
  return std::make_unique<DdsService<Impl>>(*impl_, full_name(name), type, std::move(arrived));
}

}  // namespace hg::ros2
