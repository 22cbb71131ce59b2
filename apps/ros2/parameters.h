/// The live settings of a run as parameters of a ROS 2 node: its six services, answered with what
/// the run says. Nothing is kept here, so nothing can be out of date.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "apps/ros2/messages.h"
#include "apps/ros2/node.h"
#include "hg/messages/cdr_writer.h"

namespace hg::ros2 {

/// A value of the live interface as one of ROS; `kNotSet` for what ROS has no type for.
ParameterValue to_value(const nlohmann::json& json);
/// The other way round. ROS writes whole numbers as integers; to a run all numbers are the same.
nlohmann::json to_json(const ParameterValue& value);

class Parameters {
 public:
  using Clock = std::chrono::steady_clock;
  using Send = std::function<void(const nlohmann::json&)>;

  /// `name` is that of the node. `arrived` is called by a thread of the DDS.
  Parameters(Node& node, const std::string& name, const std::function<void()>& arrived);

  /// Passes waiting requests on by `send`; null: no run is connected, they are refused.
  void pass_on(const Send& send);
  void take(const nlohmann::json& values, const std::string& id);
  /// A reason of the run, which belongs to the oldest change that waits.
  void on_status(const std::string& status);
  /// Answers what waits for longer than 2 s, or all of it, with `why`.
  void give_up(const std::string& why, bool all);
  /// Sends answers for which the client was not connected yet.
  void retry();

 private:
  enum class Kind { kGet, kTypes, kDescribe, kList, kSet, kSetAtomically };
  struct Waiting {
    Kind kind = Kind::kGet;
    Request request;
    Clock::time_point since;
    std::vector<std::string> names;  // asked for
    std::vector<Parameter> changes;  // of kSet
    std::string reason;              // from the run
  };
  struct Answer {
    Kind kind;
    Request request;
    std::vector<std::byte> message;
    Clock::time_point since;
  };
  static bool is_change(Kind kind) { return kind == Kind::kSet || kind == Kind::kSetAtomically; }
  bool decode(Waiting& waiting) const;
  nlohmann::json question(const Waiting& waiting, const std::string& id) const;
  void answer(Waiting& waiting, const nlohmann::json& values, const std::string& failure);
  void send(const Waiting& waiting, Bytes message);

  std::map<Kind, std::unique_ptr<Service>> services_;
  std::map<std::uint64_t, Waiting> waiting_;  // by number, the oldest first
  std::vector<Answer> unsent_;
  std::uint64_t asked_ = 0;
  messages::CdrWriter cdr_;
};

}  // namespace hg::ros2
