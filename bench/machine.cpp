#include "bench/machine.h"

#include <chrono>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "bench/build_facts.h"
#include "bench/commit.h"

namespace hg::bench {
namespace {

std::string date() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%d %H:%M UTC", &utc);
  return text;
}

std::string cpu() {
  const std::string key = "model name";
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with(key) && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

}  // namespace

nlohmann::ordered_json describe_machine() {
  return {
      {"date", date()},        {"cpu", cpu()},    {"cores", std::thread::hardware_concurrency()},
      {"compiler", kCompiler}, {"flags", kFlags}, {"commit", kCommit}};
}

}  // namespace hg::bench
