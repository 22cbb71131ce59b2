/// Source of problems for the solver benchmarks: the cycles of a scenario, or a file.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/player.h"
#include "hg/hqp/problem.h"
#include "hg/hqp/solution.h"

namespace hg::bench {

/// Supplies problems in their order, block by block. At most kBlockBytes of a scenario are kept.
class ProblemSource {
 public:
  static constexpr std::size_t kBlockBytes = std::size_t{64} << 20;
  static constexpr std::size_t kBlockProblems = 1000;

  /// Uses the problem of each rendering cycle. `scenario` must outlive the source.
  ProblemSource(std::string name, const config::Scenario& scenario, std::size_t most);
  /// Uses NAME.hqp or NAME.hqp.gz, with the optimal slack norms in NAME.sol.gz and problems that
  /// cannot be compared in NAME.skip, if these files exist. A line of NAME.skip begins with the
  /// index of a problem, followed by the reason. Throws SetupError.
  ProblemSource(const std::filesystem::path& file, std::size_t most);

  const std::string& name() const { return name_; }
  /// Whether successive problems are similar, so that a warm start makes sense.
  bool is_sequence() const { return is_sequence_; }
  /// Whether reference() has any norms.
  bool has_reference() const { return !norms_.empty(); }
  /// Optimal slack norm of each level of problem `index`, counted from 0 over all blocks; empty
  /// without a reference.
  std::span<const double> reference(std::size_t index) const;

  /// Initial active set for a warm start of problem `index`, counted as in reference(); null = that
  /// of the solve before.
  const hqp::ActiveSet* guess(std::size_t index) const;

  /// The next problems, valid until the next call; empty at the end.
  std::span<const hqp::Problem> next();

 private:
  void read_reference(const std::string& stem);
  void read_skipped(const std::string& file);
  std::span<const hqp::Problem> next_of_scenario();

  std::string name_;
  bool is_sequence_ = true;
  std::size_t remaining_;
  /// Player of the scenario; null = from a file, all problems in block_
  std::unique_ptr<Player> player_;
  std::vector<hqp::Problem> block_;
  std::vector<std::optional<hqp::ActiveSet>> guesses_;  ///< guesses of a file
  std::vector<std::vector<double>> norms_;
};

/// Files of the folder HG_REFERENCE_DATA, else of tests/reference under `root`, sorted by name.
/// Throws SetupError when a requested folder holds none.
std::vector<std::filesystem::path> reference_files(const std::filesystem::path& root);

}  // namespace hg::bench
