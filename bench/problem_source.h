/// Where the problems of the solver benchmarks come from: the cycles of a scenario, or a file.
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

/// Problems in their order, block by block. Of a scenario never more than kBlockBytes are kept.
class ProblemSource {
 public:
  static constexpr std::size_t kBlockBytes = std::size_t{64} << 20;
  static constexpr std::size_t kBlockProblems = 1000;

  /// The problem of each cycle that renders. `scenario` must outlive the source.
  ProblemSource(std::string name, const config::Scenario& scenario, std::size_t most);
  /// NAME.hqp or NAME.hqp.gz, with the optimal slack norms in NAME.sol.gz and what cannot be
  /// compared in NAME.skip, where these files are. A line of NAME.skip begins with the index of a
  /// problem; what follows says why. Throws SetupError.
  ProblemSource(const std::filesystem::path& file, std::size_t most);

  const std::string& name() const { return name_; }
  /// Neighbours are alike, so that a warm start means something.
  bool is_sequence() const { return is_sequence_; }
  /// Whether reference() knows anything.
  bool has_reference() const { return !norms_.empty(); }
  /// Optimal slack norm of each level of problem `index`, counted from 0 over all blocks; empty
  /// where there is nothing to compare with.
  std::span<const double> reference(std::size_t index) const;

  /// What a warm start of problem `index` begins with, counted as in reference(); null: with what
  /// the solve before it has left.
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
  std::unique_ptr<Player> player_;  ///< null: from a file, all in block_
  std::vector<hqp::Problem> block_;
  std::vector<std::optional<hqp::ActiveSet>> guesses_;  ///< of a file
  std::vector<std::vector<double>> norms_;
};

/// Files of the folder HG_REFERENCE_DATA, else of tests/reference under `root`, sorted by name.
/// Throws SetupError when the folder that is asked for holds none.
std::vector<std::filesystem::path> reference_files(const std::filesystem::path& root);

}  // namespace hg::bench
