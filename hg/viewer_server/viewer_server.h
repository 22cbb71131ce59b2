/// Serves the browser page and streams the state of a running cycle to it; receives the dragged
/// handle and commands.
///
/// HTTP and WebSocket, on 127.0.0.1 by default. Every request but those for the files of the page
/// needs the token of url(), and every request a Host of this server; the WebSocket also an Origin
/// of this server (against DNS rebinding). Protocol: docs/start/viewer.md, fields:
/// viewer/src/messages.ts.
///
/// One thread of its own does all the work. The functions below may be called from one other
/// thread, but not from the control thread (calls allocate and lock for the time of a copy).
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "hg/live/publisher.h"
#include "hg/signals/frames.h"
#include "hg/signals/operator_desk.h"
#include "hg/viewer_server/commands.h"
#include "hg/viewer_server/scene.h"
#include "hg/viewer_server/view.h"

namespace hg::viewer_server {

struct ServerOptions {
  /// Listening address; 0.0.0.0 or :: = all addresses of this machine
  std::string address = "127.0.0.1";
  std::uint16_t port = 0;        ///< 0 = any free port
  std::filesystem::path page;    ///< folder of the built page, with index.html
  double update_rate_hz = 60.0;  ///< frames per second sent to each client, > 0
  std::string token;             ///< hexadecimal digits; empty = 128 random bits
  /// Web origins whose pages may show this page inside themselves; empty: none may
  std::vector<std::string> embedders;
  /// Operator's desk that pages affect directly, without take_commands(). Must outlive the server;
  /// nullptr: no direct effect.
  OperatorDesk* desk = nullptr;
};

/// Counts since the start; `clients` is the present number.
struct Counters {
  std::uint64_t clients = 0;  ///< connected pages
  std::uint64_t live = 0;     ///< connected clients of the live interface
  std::uint64_t sent = 0;     ///< frames handed to the network
  std::uint64_t dropped = 0;  ///< frames and events not sent to a slow client
  std::uint64_t refused = 0;  ///< requests and messages that were refused
  double round_trip_s = 0.0;  ///< to the slowest page and back; NaN = not known
};

class ViewerServer {
 public:
  /// Starts listening before it returns. Throws SetupError: port taken, page or URDF file missing,
  /// scene inconsistent.
  ViewerServer(const ServerOptions& options, const Scene& scene);
  ~ViewerServer();
  ViewerServer(const ViewerServer&) = delete;
  ViewerServer& operator=(const ViewerServer&) = delete;

  /// Link to open: "http://127.0.0.1:PORT/#token=TOKEN", with the listening address.
  std::string url() const;

  /// Starts another run: pages fetch its scene. Events of the previous run are dropped. Throws
  /// SetupError as the constructor does; then the previous scene stays.
  void set_scene(const Scene& scene);

  /// Whether a view is due; false while publish() would drop it for coming too soon.
  bool is_due() const;

  /// Shows `view`. Call it at the update rate or faster; calls in between are dropped. Each client
  /// gets the newest frame when it is ready for it; slow clients cause no delay.
  void publish(View view);

  /// Whether a client of the live interface is connected.
  bool has_live_clients() const;
  /// Live channels that some client has subscribed to.
  live::Wanted live_wanted() const;
  /// Sends messages to the live clients; dropped for those that are too slow, which get a warning.
  void publish_live(live::Batch batch);
  /// Keeps a message that each new subscriber gets.
  void latch_live(live::Message message);

  /// Adds a line to the list of events of all pages, also of those that connect later.
  void announce_event(double time_s, std::string_view name, std::string_view text);

  /// Sets the values of Scene::settings, whenever one has changed; sent to all pages, also those
  /// that connect later.
  void set_values(const std::vector<double>& values);

  /// Gets the newest hand target since the last call; false and `target` untouched if there is
  /// none. A page that closes or is silent for 0.5 s causes one last, inactive target.
  bool take_hand_target(HandTarget& target);

  /// Gets the newest reference wrench of a live client, resolved in B, and the number of the
  /// client, 0 when it has ended: then it is zero. False and nothing changed if there is none.
  bool take_reference_wrench(Vector6& w, std::uint64_t& client);
  /// Sends a warning to a live client.
  void warn(std::uint64_t client, std::string_view text);

  /// Commands since the last call, in order. Each that is not done needs one answer().
  std::vector<Command> take_commands();

  /// Answers a command; `refusal` gives the reason, empty: accepted. Later where the cycle decides.
  void answer(const Command& command, std::string_view refusal);

  Counters counters() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hg::viewer_server
