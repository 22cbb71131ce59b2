/// Topics that the program publishes, services that it offers, and topics that it takes; the same
/// in every run.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace hg::live {

/// Number of a channel, its index in channels().
enum class Topic : std::size_t {
  kDevice = 0,
  kTwin,
  kUserWrench,
  kHandleTwist,
  kTransforms,
  kLimits,
  kDiagnostics,
  kEvents,
  kSample,
  kDeviceDescription,
  kTwinDescription,
};
inline constexpr std::size_t kTopicCount = 11;

struct Channel {
  std::string topic, schema_name, schema;
  bool is_latched = false;  ///< its last message is sent to each new subscriber
};

/// In the order of Topic. Messages are CDR, schemas ros2msg.
const std::vector<Channel>& channels();

inline constexpr std::string_view kHandTargetTopic = "/hand_target";
inline constexpr std::string_view kReferenceWrenchTopic = "/reference_wrench";
/// Topics that a client may publish.
inline constexpr std::array kClientTopics = {kHandTargetTopic, kReferenceWrenchTopic};

/// Services, all of type std_srvs/srv/Trigger; their names begin with kServicePrefix.
inline constexpr std::array<std::string_view, 6> kServices = {"tare", "arm",   "run",
                                                              "stop", "reset", "mark"};
inline constexpr std::string_view kServicePrefix = "/hapticgiant/";

}  // namespace hg::live
