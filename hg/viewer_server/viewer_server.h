/// Serves the browser page and streams what a running cycle does to it; takes the dragged handle
/// and commands back.
///
/// HTTP and WebSocket, on 127.0.0.1 unless told otherwise. Every request but those for the files of
/// the page needs the token of url(), and all a Host of this server; the WebSocket also an Origin
/// of this server (against DNS rebinding). Protocol: docs/viewer.md, fields:
/// viewer/src/messages.ts.
///
/// One thread of its own does all the work. The functions below may be called from one other thread
/// that is not the control thread (they allocate and lock for the time of a copy).
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "hg/signals/frames.h"
#include "hg/signals/operator_desk.h"
#include "hg/viewer_server/commands.h"
#include "hg/viewer_server/scene.h"
#include "hg/viewer_server/view.h"

namespace hg::viewer_server {

struct Options {
  std::string address = "127.0.0.1";  ///< to listen at; 0.0.0.0 or :: = all of this machine
  std::uint16_t port = 0;             ///< 0 = any free port
  std::filesystem::path page;         ///< folder of the built page, with index.html
  double update_rate_hz = 60.0;       ///< frames per second sent to each client, > 0
  std::string token;                  ///< hexadecimal digits; empty = 128 random bits
  /// What pages do to the run at once, without take_commands(). Outlives the server; nullptr:
  /// nothing does.
  OperatorDesk* desk = nullptr;
};

/// What happened so far; `clients` is the present number.
struct Counters {
  std::uint64_t clients = 0;  ///< connected pages
  std::uint64_t sent = 0;     ///< frames handed to the network
  std::uint64_t dropped = 0;  ///< frames and events that a slow client did not get
  std::uint64_t refused = 0;  ///< requests and messages that were refused
};

class ViewerServer {
 public:
  /// Listens when it returns. Throws SetupError: port taken, page or URDF file missing, scene
  /// inconsistent.
  ViewerServer(const Options& options, const Scene& scene);
  ~ViewerServer();
  ViewerServer(const ViewerServer&) = delete;
  ViewerServer& operator=(const ViewerServer&) = delete;

  /// The link to open: "http://127.0.0.1:PORT/#token=TOKEN", with the address that is listened at.
  std::string url() const;

  /// Another run begins: pages fetch its scene. Events of the one before are forgotten. Throws
  /// SetupError as the constructor does; then nothing has changed.
  void set_scene(const Scene& scene);

  /// False while the next view would be dropped because it comes too soon: no need to make it.
  bool is_due() const;

  /// Shows `view`. Call it at the update rate or faster; calls in between are dropped. Each client
  /// gets the newest frame when it is ready for it; slow clients are never waited for.
  void publish(View view);

  /// Adds a line to the list of events of all pages, also of those that connect later.
  void announce_event(double time_s, std::string_view name, std::string_view text);

  /// Of Scene::settings, whenever one has changed; sent to all pages, also those that connect
  /// later.
  void set_values(const std::vector<double>& values);

  /// The newest hand target since the last call; false and `target` untouched if there is none.
  /// A page that closes or is silent for 0.5 s gives one last, inactive target.
  bool take_hand_target(HandTarget& target);

  /// The commands since the last call, in their order. Each that is not done wants one answer().
  std::vector<Command> take_commands();

  /// `refusal` says why the command was not followed; empty: it was. Later where the cycle decides.
  void answer(const Command& command, std::string_view refusal);

  Counters counters() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hg::viewer_server
