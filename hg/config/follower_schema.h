/// Description of all joints of twin.yaml that follow others.
#pragma once

#include "hg/config/cam_schema.h"
#include "hg/config/coupling_schema.h"
#include "hg/config/twin_draft.h"

namespace hg::config {

/// Joints that follow others.
template <class V>
void describe_followers(V& v, TwinDraft& d, const UrdfParts& urdf) {
  describe_couplings(v, d.couplings, urdf);
  describe_loops(v, d.loops, urdf);
  v.list(
      "cams", [&](auto& child) { describe_cam(child, d, urdf); },
      "joints that follow others by a curve, as on a cam: valves, presses, feeders");
}

}  // namespace hg::config
