/// What ROS 2 compares to see whether two programs mean the same type by a name.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>

namespace hg::ros2 {

/// The types that are bridged, with the hashes (RIHS01) of Jazzy and Kilted, which are the same.
inline constexpr std::array<std::pair<std::string_view, std::string_view>, 17> kTypeHashes = {{
    {"sensor_msgs/msg/JointState",
     "a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e"},
    {"geometry_msgs/msg/WrenchStamped",
     "8dc3deaf06b2ab281f9f9a742a8961c328ca7cec16e3fd6586d3a5c83fa78f77"},
    {"geometry_msgs/msg/TwistStamped",
     "5f0fcd4f81d5d06ad9b4c4c63e3ea51b82d6ae4d0558f1d475229b1121db6f64"},
    {"geometry_msgs/msg/PoseStamped",
     "10f3786d7d40fd2b54367835614bff85d4ad3b5dab62bf8bca0cc232d73b4cd8"},
    {"diagnostic_msgs/msg/DiagnosticArray",
     "5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e"},
    {"std_msgs/msg/String", "df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"},
    {"std_msgs/msg/Bool", "feb91e995ff9ebd09c0cb3d2aed18b11077585839fb5db80193b62d74528f6c9"},
    {"std_msgs/msg/Float64MultiArray",
     "1025ddc6b9552d191f89ef1a8d2f60f3d373e28b283d8891ddcc974e8c55397f"},
    {"std_srvs/srv/Trigger", "eeff2cd6fa5ad9d27cdf4dec64818317839b62f212a91e6b5304b634b2062c5f"},
    {"rcl_interfaces/srv/GetParameters",
     "bf9803d5c74cf989a5de3e0c2e99444599a627c7ff75f97b8c05b01003675cbc"},
    {"rcl_interfaces/srv/SetParameters",
     "56eed9a67e169f9cb6c1f987bc88f868c14a8fc9f743a263bc734c154015d7e0"},
    {"rcl_interfaces/srv/ListParameters",
     "3e6062bfbb27bfb8730d4cef2558221f51a11646d78e7bb30a1e83afac3aad9d"},
    {"rcl_interfaces/srv/DescribeParameters",
     "845b484d71eb0673dae682f2e3ba3c4851a65a3dcfb97bddd82c5b57e91e4cff"},
    {"rcl_interfaces/srv/GetParameterTypes",
     "da199c878688b3e530bdfe3ca8f74cb9fa0c303101e980a9e8f260e25e1c80ca"},
    {"rcl_interfaces/srv/SetParametersAtomically",
     "0e192ef259c07fc3c07a13191d27002222e65e00ccec653ca05e856f79285fcd"},
    {"rcl_interfaces/msg/ParameterEvent",
     "043e627780fcad87a22d225bc2a037361dba713fca6a6b9f4b869a5aa0393204"},
    {"tf2_msgs/msg/TFMessage", "e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087"},
}};

/// Whether a type, "sensor_msgs/msg/JointState", is bridged.
constexpr bool is_known_type(std::string_view type) {
  return std::ranges::any_of(kTypeHashes, [&](const auto& one) { return one.first == type; });
}

/// "typehash=RIHS01_...;", as an end of a topic carries it; empty for an unknown type.
inline std::string type_hash(std::string_view type) {
  for (const auto& [name, hash] : kTypeHashes) {
    if (name == type) return "typehash=RIHS01_" + std::string(hash) + ";";
  }
  return {};
}

}  // namespace hg::ros2
