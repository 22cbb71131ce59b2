#include "hg/live/channels.h"

#include "hg/messages/diagnostics.h"
#include "hg/messages/event.h"
#include "hg/messages/ros_messages.h"
#include "hg/messages/schema.h"
#include "hg/messages/tool_messages.h"

namespace hg::live {
namespace {

template <HasFields Message>
void add(std::vector<Channel>& channels, const char* topic, bool is_latched = false) {
  channels.push_back(
      {topic, messages::schema_name<Message>(), messages::schema_text<Message>(), is_latched});
}

}  // namespace

const std::vector<Channel>& channels() {
  static const std::vector<Channel> kChannels = [] {
    std::vector<Channel> channels;
    messages::ToolMessages({}).pass_recorded(
        [&]<typename Message>(const char* topic, const Message&) {
          add<Message>(channels, topic);
        });
    add<messages::JointState>(channels, "/limits");
    add<messages::DiagnosticArray>(channels, "/diagnostics");
    add<messages::Event>(channels, "/hapticgiant/events");
    add<Sample>(channels, "/hapticgiant/sample");
    add<messages::TextMessage>(channels, "/robot_description", true);
    add<messages::TextMessage>(channels, "/twin/robot_description", true);
    return channels;
  }();
  return kChannels;
}

}  // namespace hg::live
