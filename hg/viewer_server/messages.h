/// The JSON messages between program and page; the fields are those of viewer/src/messages.ts.
///
/// Numbers are rounded to 1e-5 of their unit; what is not finite becomes null.
#pragma once

#include <string>
#include <string_view>

#include "hg/signals/frames.h"
#include "hg/signals/state.h"
#include "hg/viewer_server/scene.h"

namespace hg::viewer_server {

/// Addresses under which the server hands out the URDF files.
inline constexpr std::string_view kDeviceAddress = "/models/device.urdf";
inline constexpr std::string_view kTwinAddress = "/models/twin.urdf";

std::string encode_scene(const Scene& scene, double update_rate_hz);

std::string encode_frame(const CycleRecord& record, const HandTarget& hand, double cycle_time_us,
                         std::string_view status_text, const LimitCatalogue& limits);

std::string encode_event(double time_s, std::string_view name, std::string_view text);

enum class DecodeStatus { kOk, kMalformed, kOutOfRange };

/// Reads a message Hand. Refuses anything but exactly its fields (kMalformed), and numbers that
/// are not finite, positions beyond 100 m and press outside 0..1 (kOutOfRange).
[[nodiscard]] DecodeStatus decode_hand(std::string_view text, HandTarget& target);

}  // namespace hg::viewer_server
