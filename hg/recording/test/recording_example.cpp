// Writes the recording that read_recording.py reads: recording_example FOLDER [SECONDS [RATE_Hz]].
// With "crash" in place of the duration the program dies in the middle of the third second.
// Prints file, counts and the processor time of the recorder's thread.
#include <sys/resource.h>

#include <cstdlib>
#include <iostream>
#include <string>

#include "hg/core/error.h"
#include "hg/recording/test/example_run.h"

namespace {

double processor_time_s(int who) {
  rusage usage{};
  getrusage(who, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
         1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

int record(const std::string& folder, const std::string& duration, double rate_Hz) {
  const bool is_crash = duration == "crash";
  const double seconds = is_crash ? 2.5 : std::stod(duration);

  hg::recording::RecordingInfo info = hg::recording::example_info(folder);
  info.rate_Hz = rate_Hz;
  info.start = std::chrono::system_clock::time_point(std::chrono::seconds(1'800'000'000));
  hg::recording::Recorder recorder(info);
  recorder.event(0.0, "start", "the door is closed");
  const auto samples = static_cast<std::uint64_t>(seconds * rate_Hz);
  for (std::uint64_t cycle = 0; cycle < samples; ++cycle) {
    recorder.push_waiting(hg::recording::example_sample(cycle, rate_Hz));
  }
  if (is_crash) std::_Exit(0);
  recorder.lab_clock({.time_s = 0.5 * seconds, .offset_s = 12345.678901234567});
  recorder.event(seconds, "end", "");
  const hg::recording::RecordingSummary summary = recorder.close();

  // what the process used besides this thread
  const double writer_s = processor_time_s(RUSAGE_SELF) - processor_time_s(RUSAGE_THREAD);
  std::cout << summary.file.string() << "\nsamples " << summary.samples << ", dropped "
            << summary.dropped << ", bytes " << summary.bytes << ", recorder thread " << writer_s
            << " s\n";
  return summary.error.empty() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 4) {
    std::cerr << "usage: recording_example FOLDER [SECONDS|crash [RATE_Hz]]\n";
    return 2;
  }
  try {
    return record(argv[1], argc > 2 ? argv[2] : "2", argc > 3 ? std::stod(argv[3]) : 1000.0);
  } catch (const hg::SetupError& error) {
    std::cerr << error.what() << "\n";
    return 2;
  }
}
