// One JSON object an image, for --stats.
#pragma once

#include <filesystem>
#include <string>

#include "backlight/base/result.h"
#include "backlight/render/image_faults.h"
#include "backlight/render/render.h"
#include "backlight/render/tracing_threads.h"
#include "backlight/scene/needs.h"

namespace backlight {

/// {"frame":3,"time":0.08,"file":"a.0003.exr",...}; docs/command-line.md lists the members.
std::string statistics_json(const Scene& scene, const Needs& needs, const RenderSettings& settings,
                            const RenderStatistics& statistics, const ImageFaults& faults,
                            const std::filesystem::path& file);

/// For --verbose: the same in a line of words, indented.
std::string statistics_words(const Scene& scene, const RenderSettings& settings,
                             const RenderStatistics& statistics);

/// How well the tracing threads were kept busy: {"event":"end",...}, and a line of words.
std::string time_json(const TracingTime& time);
std::string time_words(const TracingTime& time);

/// The file of --stats: each line is whole on the disk before the next image begins.
class StatisticsFile {
 public:
  /// Begins an empty file, or goes on at the end of one. With an empty path nothing is written, ever; "-" is
  /// the standard output. Several processes may append to one file: each line is written at once.
  static Result<StatisticsFile> open(const std::filesystem::path& path, bool append);

  /// Writes nothing, ever.
  StatisticsFile() = default;
  StatisticsFile(StatisticsFile&& other) noexcept;
  StatisticsFile& operator=(StatisticsFile&& other) noexcept;
  ~StatisticsFile();

  Result<void> write(const std::string& line);

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
};

}  // namespace backlight
