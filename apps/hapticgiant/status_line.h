/// Status line on the terminal with the forces on the hand; events scroll above it.
#pragma once

#include <string>

#include "apps/command_line/output.h"
#include "hg/controller/rendering/twin_model.h"
#include "hg/signals/state.h"

namespace hg::apps {

/// Text of the status line, for example "12.3 s running F 23 N hinge 0.42 lever 0.61 hinge: upper
/// limit, 4 Nm 21 us".
std::string status_text(const Sample& sample, const LimitCatalogue& limits,
                        const rendering::TwinModel& twin);

class StatusLine {
 public:
  /// Redraws on terminals only, and when `output` is read; elsewhere only events are printed.
  StatusLine(bool is_terminal, const BackgroundOutput& output)
      : is_terminal_(is_terminal), output_(&output) {}
  ~StatusLine() { clear(); }

  /// Shows the status text, cut to the width of the terminal.
  void show(const std::string& text);
  /// Prints a permanent line.
  void print(const std::string& text);
  void clear();

 private:
  bool is_terminal_;
  const BackgroundOutput* output_;
  bool is_drawn_ = false;
};

}  // namespace hg::apps
