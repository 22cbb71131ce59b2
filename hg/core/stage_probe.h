/// Callback per stage of a control cycle, for example to measure durations.
///
/// The cycle itself has no clock: it only reports which stage has ended. Without a callback the
/// cost is one comparison per stage. A probe is not part of any state and changes no result.
#pragma once

#include <array>
#include <cstdint>

#include "hg/core/index.h"

namespace hg {

/// Parts of Cycle::step in the order of the data flow. They cover the whole time of a step that
/// renders.
enum class Stage : std::uint8_t {
  kSupervision,     ///< sensor check, operating state, changes of parameters
  kEstimation,      ///< sensors to states
  kPrepositioning,  ///< look ahead for collisions, check of the reference, target of the gantry
  kRenderingSetUp,  ///< device and twin models, torques, rows of the problem
  kSolver,          ///< the lexicographic solver
  kReactions,       ///< constraint torque split, report of the rendering
  kIntegration,     ///< energy, check of the solution, reference and twin advance by one period
  kControl,         ///< monitor, commands of the drives, contacts of the arm
  kSafety,          ///< sanitiser
  kStateHash,       ///< the record, with the hash of the state
};
inline constexpr int kStageCount = 10;

constexpr const char* to_string(Stage stage) noexcept {
  constexpr std::array<const char*, kStageCount> kNames = {
      "supervision", "estimation",  "prepositioning", "rendering set-up", "solver",
      "reactions",   "integration", "control",        "safety",           "hash"};
  return kNames[index(stage)];
}

/// Callback with its context.
struct StageProbe {
  /// Callback at the end of each stage, several times per step for repeated stages; null: none.
  void (*ended)(void* listener, Stage stage) noexcept = nullptr;
  void* listener = nullptr;  ///< Argument passed to `ended`; must outlive the probe

  void operator()(Stage stage) const noexcept {
    if (ended != nullptr) ended(listener, stage);
  }
};

}  // namespace hg
