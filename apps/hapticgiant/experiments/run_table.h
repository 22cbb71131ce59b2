/// Signals of a run as named columns, for figures and experiments.
///
/// Positions of the manipulator are those of the reference, as in the paper; of the gantry as
/// estimated; the wrench is the user's as estimated.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "hg/config/simulation/scenario.h"
#include "hg/signals/state.h"

namespace hg::apps {

/// Whether a joint with one coordinate is in rad, otherwise m.
bool is_angle(const model::Joint& joint) noexcept;

/// Time interval in which a lock held a joint of the twin.
struct LockedPhase {
  std::string joint;
  double from_s = 0.0, to_s = 0.0;
};

/// Rows from the first at or after `from_s` up to, excluding, the first at or after `to_s`.
struct RowRange {
  std::size_t begin = 0, end = 0;
};

class RunTable {
 public:
  /// Keeps the first sample of every `period_s`; 0 = all. `scenario` must outlive the table.
  explicit RunTable(const config::Scenario& scenario, double period_s = 0.0);

  void add(const Sample& sample);

  std::size_t rows() const noexcept { return columns_.front().values.size(); }
  /// A column by its name in the CSV file; throws SetupError with the nearest one.
  const std::vector<double>& operator[](std::string_view name) const;
  RowRange between(double from_s, double to_s) const;
  /// Locked phases; complete once the last sample has been added.
  const std::vector<LockedPhase>& locked() const noexcept { return locked_; }

  /// CSV with one row per `period_s`, six digits; the header holds names with units.
  std::string to_csv(double period_s) const;

 private:
  struct Column {
    std::string name;
    std::function<double(const Sample&)> of;
    std::vector<double> values;
  };
  void add_device_columns(const config::Scenario& scenario);
  void add_twin_columns(const config::Scenario& scenario);
  void add_column(std::string name, std::function<double(const Sample&)> of);
  void note_locks(const CycleRecord& record);

  const config::Scenario& scenario_;
  double period_s_, due_s_ = 0.0;
  std::vector<Column> columns_;
  std::vector<LockedPhase> locked_;
  std::vector<int> open_;  ///< per limit: index in locked_ while a lock holds it; -1 = none
};

}  // namespace hg::apps
