#include "hg/analysis/run_news.h"

#include <utility>

#include "hg/controller/safety/rules.h"

namespace hg::analysis {

std::vector<News> RunNews::observe(const Sample& sample) {
  const CycleRecord& record = sample.record;
  std::vector<News> news;
  const bool has_ended = record.tare != TareStatus::kNone && record.tare != TareStatus::kUnderWay;
  if (has_ended && std::exchange(tare_, record.tare) != record.tare) {
    news.push_back({"tare", std::string(to_string(record.tare))});
  }
  if (record.refusal != Refusal::kNone) {
    news.push_back({"request", std::string(to_string(record.refusal))});
  }
  if (!std::exchange(is_touched_, record.touch.is_reported) && record.touch.is_reported) {
    const int joint = record.touch.joint;
    const std::string where =
        joint < 0 ? "" : " beyond joint " + name_in(names_.joints, joint, "number");
    news.push_back({"contact", "something touches the arm" + where + ": it gives way"});
  }
  const FaultCode code = record.fault.code;
  if (std::exchange(fault_, code) != code && code != FaultCode::kNone) {
    news.push_back({safety::is_fault(code) ? "fault" : "stopped",
                    std::to_string(static_cast<int>(code)) + " " + std::string(to_string(code))});
  }
  return news;
}

}  // namespace hg::analysis
