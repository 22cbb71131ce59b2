#include "apps/hapticgiant/status_line.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cmath>
#include <cstddef>

#include "hg/viewer_server/limit_text.h"

namespace hg::apps {
namespace {

constexpr int kMostJoints = 4;  // more do not fit on a line

// without the sign of a zero
double rounded(double value) { return std::round(100.0 * value) / 100.0 + 0.0; }

// Whether bearings of the twin carry more than half of what the hand pushes and turns with.
bool pushes_on_bearings(const CycleRecord& record) {
  constexpr double kHand = 0.1;  // m; a torque presses on the hand with its force at this distance
  Vector6 scale;
  scale << Eigen::Vector3d::Ones(), Eigen::Vector3d::Constant(1.0 / kHand);
  const Vector6 user = record.robot.w_H.cwiseProduct(scale);
  const Vector6 carried = record.budget.structure.cwiseProduct(scale);
  return carried.dot(user) > 0.5 * user.squaredNorm();
}

std::size_t terminal_width() {
  winsize size{};
  const bool is_known = ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return is_known ? size.ws_col : 80;
}

}  // namespace

std::string status_text(const Sample& sample, const LimitCatalogue& limits,
                        const rendering::TwinModel& twin) {
  const CycleRecord& record = sample.record;
  std::string text = fmt::format("{:6.1f} s  {:<8} F {:4.1f} N", record.time_s,
                                 to_string(record.mode), record.robot.w_H.head<3>().norm());
  int shown = 0;
  for (const auto& dof : twin.dofs) {
    if (dof.q_index < 0 || shown++ == kMostJoints || record.twin.q_a.size() == 0) break;
    text += fmt::format("  {} {:.2f}", dof.name, rounded(record.twin.q_a[dof.q_index]));
  }
  if (pushes_on_bearings(record)) {
    text += "  on the twin's bearings: it cannot move that way";
  } else if (record.felt_limit >= 0) {
    const std::size_t felt = record.felt_limit;
    text += "  " + viewer_server::limit_text(limits[felt], record.limits[felt]);
  } else {
    text += "  free";
  }
  return text + fmt::format("  {:.0f} us", sample.cycle_time_us);
}

void StatusLine::show(const std::string& text) {
  if (!is_terminal_ || output_->is_behind()) return;
  draw_out(text.substr(0, terminal_width() - 1));  // a full line would wrap
  is_drawn_ = true;
}

void StatusLine::print(const std::string& text) {
  clear();
  print_out(text + "\n");
}

void StatusLine::clear() {
  if (is_drawn_) draw_out("");
  is_drawn_ = false;
}

}  // namespace hg::apps
