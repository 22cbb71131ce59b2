/// Conversion between the JSON messages of program and page and the program's own types.
///
/// Each has one list of fields (hg/core/fields.h), from which viewer/src/messages.ts is generated,
/// too.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "hg/signals/frames.h"
#include "hg/viewer_server/commands.h"
#include "hg/viewer_server/hand_target_box.h"
#include "hg/viewer_server/scene.h"
#include "hg/viewer_server/view.h"

namespace hg::viewer_server {

/// Addresses of the URDF files on the server.
inline constexpr std::string_view kDeviceAddress = "/models/device.urdf";
inline constexpr std::string_view kTwinAddress = "/models/twin.urdf";

std::string encode_scene(Scene scene, double update_rate_hz);

/// Encodes a view; `clients` is the number of pages connected.
std::string encode_frame(const View& view, const LimitCatalogue& limits, std::uint64_t clients,
                         const HandHolder& holder = {});

std::string encode_event(std::uint64_t run, double time_s, std::string_view name,
                         std::string_view text);

/// Encodes the values of Scene::settings; infinite values stand for "unlimited".
std::string encode_values(const std::vector<double>& values);

/// Encodes the answer to a command; `reason` is empty when the command was accepted.
std::string encode_answer(double id, std::string_view reason);

/// Encodes the first message of a connection: the number of its page.
std::string encode_welcome(std::uint64_t page);

enum class DecodeStatus { kHand, kHold, kCommand, kMalformed, kOutOfRange };

/// Message received from a page; the status says which member is valid.
struct PageMessage {
  HandTarget hand;
  double hold = 0.0;  ///< sequence number of a Hold
  Command command;
};

/// Decodes a message. Refuses anything but exactly the fields of Hand, Hold or Command and numbers
/// that are not finite (kMalformed); positions beyond 100 m, press outside 0..1, quaternions that
/// are not of length 1, names of more than 200 bytes, and ids or sequence numbers that are not
/// whole numbers of 0..2^53 (kOutOfRange).
[[nodiscard]] DecodeStatus decode(std::string_view text, PageMessage& message);

/// Reason sent to the page for a refused message.
std::string_view refusal_text(DecodeStatus status) noexcept;

}  // namespace hg::viewer_server
