#include "bench/solver_table.h"

#include <memory>

#include "bench/comparison.h"
#include "hg/hqp/solver.h"
#include "hg/hqp/text.h"

namespace hg::bench {
namespace {

using hqp::Problem;
using Points = std::vector<std::vector<double>>;

// Measures one set, block by block.
class SetTimer {
 public:
  SetTimer(ProblemSource& source, BaselineSolve baseline, int passes)
      : source_(source), baseline_(source.is_sequence() ? baseline : nullptr), passes_(passes) {
    set_.name = source.name();
    if (source.is_sequence()) warm_.solver = "warm";
    cold_.solver = "cold";
    cascade_.solver = "cascade";
  }

  SolverSet measure() {
    for (auto block = source_.next(); !block.empty(); block = source_.next()) {
      if (!solver_) prepare(block);
      const Points cold = solve(block, cold_, false);
      const Points warm = source_.is_sequence() ? solve(block, warm_, true) : cold;
      const Points theirs = baseline_ != nullptr ? solve_with_baseline(block) : Points();
      compare_block(block, cold, warm, theirs);
      first_ += block.size();
    }
    set_.problems = first_;
    if (source_.is_sequence()) set_.runs.push_back(std::move(warm_));
    set_.runs.push_back(std::move(cold_));
    if (baseline_ != nullptr) set_.runs.push_back(std::move(cascade_));
    return std::move(set_);
  }

 private:
  void prepare(std::span<const Problem> block) {
    const hqp::Capacity capacity = hqp::capacity_for(block);
    set_.variables = capacity.variables;
    set_.levels = capacity.levels;
    solver_ = std::make_unique<hqp::Solver>(capacity);
    solution_ = std::make_unique<hqp::Solution>(capacity);
    placed_ = std::make_unique<Problem>(capacity);
  }

  Points solve(std::span<const Problem> block, SolverRun& run, bool is_warm) {
    Points points;
    const hqp::ActiveSet before = active_;
    for (int pass = 0; pass < passes_; ++pass) {
      active_ = before;
      for (std::size_t i = 0; i < block.size(); ++i) {
        *placed_ = block[i];
        if (!is_warm) active_ = {};
        const hqp::ActiveSet* const guess = is_warm ? source_.guess(first_ + i) : nullptr;
        if (guess != nullptr) active_ = *guess;
        const Clock::time_point begin = Clock::now();
        const hqp::Status status = solver_->solve(*placed_, {}, active_, *solution_);
        const double us = microseconds_since(begin);

        // the first of all may have nothing to start from
        const std::size_t skipped = is_warm && source_.guess(0) == nullptr ? 1 : 0;
        if (first_ + i >= skipped) run.times.add(first_ + i - skipped, us);
        if (pass > 0) continue;
        run.failures += status != hqp::Status::kSolved;
        run.iterations += solution_->iterations;
        points.push_back(solution_->x);
      }
    }
    if (!is_warm) active_ = before;
    return points;
  }

  Points solve_with_baseline(std::span<const Problem> block) {
    Points points;
    std::vector<double> x;
    for (int pass = 0; pass < passes_; ++pass) {
      for (std::size_t i = 0; i < block.size(); ++i) {
        *placed_ = block[i];
        x.resize(placed_->variables());
        const Clock::time_point begin = Clock::now();
        const bool is_solved = baseline_(*placed_, x.data());
        cascade_.times.add(first_ + i, microseconds_since(begin));
        if (pass > 0) continue;
        cascade_.failures += !is_solved;
        points.push_back(x);
      }
    }
    return points;
  }

  void compare_block(std::span<const Problem> block, const Points& cold, const Points& warm,
                     const Points& theirs) {
    const auto count = [&](SolverRun& run, bool is_wrong) {
      run.wrong = run.wrong.value_or(0) + (is_wrong ? 1 : 0);
    };
    for (std::size_t i = 0; i < block.size(); ++i) {
      const std::span<const double> reference = source_.reference(first_ + i);
      const auto differs = [&](const std::vector<double>& x) {
        return compare(slack_norms(block[i], x), reference) != ComparisonVerdict::kSame;
      };
      if (source_.has_reference()) {
        const bool is_comparable = !reference.empty();
        count(warm_, is_comparable && differs(warm[i]));
        count(cold_, is_comparable && differs(cold[i]));
        if (!theirs.empty()) count(cascade_, is_comparable && differs(theirs[i]));
      } else if (!theirs.empty()) {
        const std::vector<double> norms = slack_norms(block[i], theirs[i]);
        const ComparisonVerdict verdict = compare(norms, slack_norms(block[i], warm[i]));
        count(cascade_, verdict == ComparisonVerdict::kWorse);
        count(warm_, verdict == ComparisonVerdict::kBetter);
        count(cold_, compare(norms, slack_norms(block[i], cold[i])) == ComparisonVerdict::kBetter);
      }
    }
  }

  ProblemSource& source_;
  BaselineSolve baseline_;
  int passes_;
  std::size_t first_ = 0;  ///< problems before the block
  hqp::ActiveSet active_;  ///< of the last warm solve
  std::unique_ptr<hqp::Solver> solver_;
  std::unique_ptr<hqp::Solution> solution_;
  std::unique_ptr<Problem> placed_;
  SolverSet set_;
  SolverRun warm_, cold_, cascade_;
};

}  // namespace

SolverSet measure_solvers(ProblemSource& source, BaselineSolve baseline, int passes) {
  return SetTimer(source, baseline, passes).measure();
}

}  // namespace hg::bench
