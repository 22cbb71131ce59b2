/// A search for hands that bring a device out of its limits.
///
/// Hands are drawn at random: how stiff they are, and strokes of the handle far beyond the reach of
/// the device. Those that come nearest to leaving a limit are varied. Each is a scenario of its own
/// with files, so that what is found can be played again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "hg/experiments/seed_ranges.h"
#include "hg/scenario/options.h"

namespace hg::experiments {

struct HandSearch {
  scenario::ScenarioOptions world;  ///< Device, twin and law; its person is not used
  std::filesystem::path folder;     ///< Existing folder for the files
  int count = 100;                  ///< Number of hands, > 0; half of them are varied ones
  double force = 60.0;              ///< Largest pull of a hand, N
  std::uint64_t seed = 1;
};

/// A hand that was played.
struct TriedHand {
  std::string name;  ///< NAME.yaml and NAME_person.yaml are its files
  config::Scenario scenario;
  SeededRun run;
};

/// How near a run came to leaving a limit: 1 = by 2 mrad or 1 mm; a fault counts 1 more, and a
/// motor at its peak 0.1.
double badness(const SeededRun& run) noexcept;

/// Plays the hands of `search`, worst first, with seed 1 for errors and noise. Throws SetupError
/// where files are wrong or cannot be written.
std::vector<TriedHand> search_hands(const HandSearch& search, const Progress& progress);

/// Removes the files of a hand.
void remove_files(const HandSearch& search, const TriedHand& hand);

}  // namespace hg::experiments
