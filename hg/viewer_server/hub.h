/// State shared by all connections of the server, and the names used from Beast.
///
/// hub.h, page.h, live_client.h and visitor.h include Boost.Beast and are included by
/// viewer_server.cpp only.
#pragma once

#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hg/core/monotonic_clock.h"
#include "hg/live/board.h"
#include "hg/live/publisher.h"
#include "hg/signals/operator_desk.h"
#include "hg/viewer_server/access.h"
#include "hg/viewer_server/commands.h"
#include "hg/viewer_server/hand_target_box.h"
#include "hg/viewer_server/message_rate.h"
#include "hg/viewer_server/reference_wrench_box.h"

namespace hg::viewer_server {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;
using Text = std::shared_ptr<const std::string>;
using Request = http::request<http::empty_body>;

constexpr auto kRequestTimeout = std::chrono::seconds(15);
constexpr auto kStrangerTimeout = std::chrono::seconds(5);  // time limit for a complete request
constexpr std::size_t kMostStrangers = 32;     // connections that have not shown the token
constexpr long kMostKnown = 64;                // connections that have shown the token
constexpr long kMostLive = 16;                 // clients of the live interface
constexpr std::size_t kMaxEvents = 200;        // kept for pages that connect later, and per page
constexpr std::size_t kMaxCommands = 64;       // waiting for the program
constexpr std::size_t kMaxDone = 256;          // including those for information only
constexpr std::size_t kLargestMessage = 4096;  // bytes; a hand target has about 80
constexpr double kMessageRate_Hz = 200.0;      // a page sends 60 hand targets per second
constexpr double kCommandRate_Hz = 30.0;       // rate of a dragged slider

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

inline std::string_view view(beast::string_view text) { return {text.data(), text.size()}; }

/// Clock of all times of the server, s.
inline double now_s() { return 1e-9 * static_cast<double>(now_ns()); }

inline Text to_text(std::string text) {
  return std::make_shared<const std::string>(std::move(text));
}

class LiveClient;
class Page;
class Visitor;

/// Shared state. All but the counters, the hand target and the commands belongs to the server's
/// thread.
struct Hub {
  explicit Hub(const Eigen::AlignedBox3d& limits);

  bool has_token(const Request& request) const;
  /// Adds a connection that has not shown the token; the oldest is dropped when there are too many.
  /// Not by address: behind a router, or on this machine, all have the same.
  void admit_stranger(const std::shared_ptr<Visitor>& visitor);
  /// Marks a visitor as having shown the token. Returns its connection share; null: too many.
  std::shared_ptr<int> make_known(const Visitor* visitor);
  void join(const std::shared_ptr<Page>& page);
  void leave(const std::shared_ptr<Page>& page);
  /// Finds the slowest page.
  void note_round_trip();
  void join(const std::shared_ptr<LiveClient>& client);
  void leave(const std::shared_ptr<LiveClient>& client);
  /// Ends what the page or client of this number holds.
  void let_go(std::uint64_t number);
  void put_hand(std::uint64_t page, const HandTarget& target);
  /// Returns why not; empty: the dragging page is asked.
  std::string ask_for_hand(std::uint64_t page);
  HandHolder holder();
  void put_wrench(std::uint64_t client, const Vector6& w);
  bool follows(CommandName name) const;
  /// Queues a command for the program; false when too many are waiting.
  bool put_command(Command command);
  /// Executes a command at the desk, or queues it for the program as far as `rate` allows; a stop
  /// is never limited. Returns the answer: empty = executed, text = refused; no value: the program
  /// answers.
  std::optional<std::string> take(Command command, MessageRate& rate);
  void show(Text frame);
  void announce(const Text& event);
  /// Answers a command; `refusal` is empty when it was accepted.
  void answer(std::uint64_t page, double id, std::string_view refusal);
  void warn(std::uint64_t client, std::string_view text);
  /// Sends the messages of one moment to all live clients that want them.
  void show(const live::Batch& batch);
  /// Keeps a latched message and sends it to its subscribers.
  void latch(const live::Message& message);
  /// Updates the values of the parameters, in the order of Scene::settings.
  void set_parameters(const std::vector<double>& values);
  /// Collects what live clients want.
  void note_wanted();

  Listener listener;
  std::string token;
  std::string content_policy;  ///< header of every answer
  AssetTable assets;
  OperatorDesk* desk = nullptr;       ///< nullptr: no operator
  std::vector<CommandName> followed;  ///< commands accepted by the scene
  std::set<std::shared_ptr<Page>> pages;
  std::set<std::shared_ptr<LiveClient>> live_clients;
  live::Board board;
  std::map<std::string, std::string, std::less<>> live_assets;  ///< by name: address in `assets`
  std::deque<Text> events;
  Text newest_frame;
  Text values;  ///< encoded values of the settings
  std::uint64_t next_page = 1;
  std::deque<std::weak_ptr<Visitor>> strangers;                ///< oldest first
  std::shared_ptr<int> known = std::make_shared<int>();        ///< one more owner per connection
  std::shared_ptr<int> live_places = std::make_shared<int>();  ///< likewise, of live clients

  std::atomic<std::uint64_t> clients{0};
  std::atomic<std::uint64_t> live_count{0};
  std::atomic<unsigned long> wanted{0};  ///< channels that live clients want, live::Wanted
  std::atomic<std::uint64_t> sent{0};
  std::atomic<std::uint64_t> dropped{0};
  std::atomic<std::uint64_t> refused{0};
  std::atomic<double> round_trip_s{kUnknown};
  std::mutex input_mutex;
  HandTargetBox hand;
  ReferenceWrenchBox wrench;
  std::vector<Command> commands;  ///< not yet taken by the program
};

}  // namespace hg::viewer_server
