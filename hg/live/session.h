/// The live protocol from the side of the server, for one client: frames in, frames and orders out.
/// No sockets, no clock.
///
/// Source: Foxglove WebSocket protocol, version 1 (subprotocols foxglove.websocket.v1 and
/// foxglove.sdk.v1). Frames that make no sense are answered by a status message and change nothing.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "hg/core/types.h"
#include "hg/live/board.h"
#include "hg/live/channels.h"
#include "hg/live/frame.h"
#include "hg/signals/frames.h"

namespace hg::live {

/// Names of the protocol in a Sec-WebSocket-Protocol header.
inline constexpr std::array<std::string_view, 2> kProtocols = {"foxglove.sdk.v1",
                                                               "foxglove.websocket.v1"};

/// The first of the names in a Sec-WebSocket-Protocol header that the server speaks; empty = none.
std::string_view chosen_protocol(std::string_view offered) noexcept;

/// Largest frame from a client, bytes: an advertisement carries the text of a schema.
inline constexpr std::size_t kLargestFrame = 64 * 1024;

/// Something that the program has to do; each one gets one Session::answer().
struct Order {
  enum class Kind : std::uint8_t { kService, kSet };
  double id = 0.0;  ///< a whole number, unique in its session
  Kind kind = Kind::kService;
  std::string name;  ///< of kServices, or of a parameter
  double value = 0.0;
};

/// What a frame of a client leads to.
struct Reaction {
  std::vector<Frame> frames;  ///< to this client
  std::vector<Order> orders;
  std::optional<HandTarget> hand;  ///< a hand target, or one that is not active: it has let go
  std::optional<Vector6> wrench;   ///< a reference wrench, resolved in B; zero: it has ended
  bool is_refused = false;         ///< something in the frame was refused
  std::size_t refusals = 0;        ///< things that were refused; the first ten are reported
};

class Session {
 public:
  /// `board` must outlive the session.
  explicit Session(const Board& board) : board_(board) {}

  /// The first frames: what the server offers.
  std::vector<Frame> greeting() const;

  /// Takes a frame of the client.
  Reaction take(std::string_view frame, bool is_text);

  /// Answers an order; `refusal` is empty when it was followed.
  Reaction answer(double order, std::string_view refusal);

  /// Channels that the client has subscribed to.
  bool wants(std::size_t channel) const { return subscriptions_[channel].has_value(); }
  /// The frame that carries `message`, which the client wants().
  Frame frame_of(const Message& message) const;

  /// After a change of values: the frame with those that the client subscribed to, if any.
  std::vector<Frame> changed_parameters(const std::vector<std::string>& names) const;

  /// Frame with the time of the run.
  static Frame time_frame(std::uint64_t time_ns);
  /// Frame with a message for the user.
  static Frame status(int level, std::string_view text, std::string_view id = {});
  static constexpr int kInfo = 0, kWarning = 1, kError = 2;

 private:
  using Json = nlohmann::json;

  /// A setParameters, until all its values were answered.
  struct Setting {
    std::optional<std::string> id;
    std::vector<std::string> names;
    std::vector<double> values;  ///< asked for; NaN: refused
    std::size_t waiting = 0;
  };
  struct Call {
    std::uint32_t service = 0, call = 0;
  };
  /// The place of a value in a setParameters.
  struct Place {
    std::uint64_t setting = 0;
    std::size_t index = 0;
  };

  void take_text(const Json& json, Reaction& reaction);
  void take_binary(std::string_view frame, Reaction& reaction);
  void subscribe(const Json& json, Reaction& reaction);
  void unsubscribe(const Json& json, Reaction& reaction);
  void advertise(const Json& json, Reaction& reaction);
  void unadvertise(const Json& json, Reaction& reaction);
  void get_parameters(const Json& json, Reaction& reaction) const;
  void set_parameters(const Json& json, Reaction& reaction);
  void subscribe_parameters(const Json& json, Reaction& reaction, bool is_on);
  void fetch_asset(const Json& json, Reaction& reaction) const;
  void call_service(std::string_view bytes, Reaction& reaction);
  void take_message(std::string_view bytes, Reaction& reaction);
  template <typename Stamped>
  static bool decode(std::string_view payload, std::string_view topic, std::string_view type,
                     Stamped& message, Reaction& reaction);
  void take_hand(std::string_view payload, Reaction& reaction);
  void take_wrench(std::string_view payload, Reaction& reaction);
  void let_go(std::string_view topic, Reaction& reaction);
  void end_setting(const Setting& setting, Reaction& reaction) const;
  static void refuse(std::string_view why, Reaction& reaction);

  const Board& board_;
  std::array<std::optional<std::uint32_t>, kTopicCount> subscriptions_;  ///< id, by channel
  std::map<std::uint32_t, std::string_view> published_;  ///< the client's channels: topic
  std::set<std::string, std::less<>> watched_;           ///< parameters
  bool watches_all_ = false;
  std::map<double, Call> calls_;
  std::map<double, Place> places_;
  std::map<std::uint64_t, Setting> settings_;
  double next_order_ = 1.0;
  std::uint64_t next_setting_ = 1;
};

}  // namespace hg::live
