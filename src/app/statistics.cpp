#include "statistics.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string_view>
#include <utility>

#include "backlight/base/interrupted.h"
#include "backlight/base/json_text.h"

namespace backlight {
namespace {

Failure cannot_write(const std::filesystem::path& path) {
  return {"cannot write " + path.string() + ": " + std::strerror(errno)};
}

class JsonObject {
 public:
  JsonObject& number(const char* name, double value) { return member(name, json_number(value)); }
  JsonObject& count(const char* name, std::uint64_t value) { return member(name, std::to_string(value)); }
  JsonObject& json(const char* name, const std::string& value) { return member(name, value); }
  JsonObject& text(const char* name, const std::string& value) { return member(name, json_quoted(value)); }
  [[nodiscard]] std::string str() const { return "{" + members_ + "}"; }

 private:
  JsonObject& member(const char* name, const std::string& value) {
    members_ += (members_.empty() ? "\"" : ",\"") + std::string(name) + "\":" + value;
    return *this;
  }
  std::string members_;
};

std::string roots_json(const std::vector<RootSearch>& roots) {
  std::string list;
  for (const RootSearch& search : roots) {
    JsonObject object;
    object.text("shape", std::string(name(search.shape)))
        .text("finder", std::string(code_of(search.finder)))
        .count("surfaces", search.surfaces);
    list += (list.empty() ? "" : ",") + object.str();
  }
  return "[" + list + "]";
}

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

// The most that the process has had in memory at once, in bytes.
std::uint64_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

}  // namespace

std::string statistics_json(const Scene& scene, const Needs& needs, const RenderSettings& settings,
                            const RenderStatistics& statistics, const ImageFaults& faults,
                            const std::filesystem::path& file) {
  const PixelBox whole{0, 0, scene.film.width, scene.film.height};
  const PixelBox window = settings.crop.value_or(whole);
  JsonObject object;
  object.number("frame", scene.frame).number("time", scene.time).text("file", file.string());
  object.number("width", window.width())
      .number("height", window.height())
      .number("samples", statistics.samples.mean());
  if (scene.film.tolerance > 0.0) object.number("tolerance", scene.film.tolerance);
  if (scene.film.adaptive) {
    object.count("samplesLeast", statistics.samples.least).count("samplesMost", statistics.samples.most);
    object.count("pixelsAtLimit", statistics.samples.at_limit);
  }
  object.text("model", settings.wavelengths > 0 ? "spectral" : "rgb")
      .number("wavelengths", settings.wavelengths)
      .text("modelCode", std::string(code_of(needs.reason)))
      .text("modelWhy", needs.why)
      .text("wavelengthsCode", std::string(code_of(needs.wavelength_reason)))
      .text("wavelengthsWhy", needs.why_so_many);
  object.count("frames", needs.frames).count("movingFrames", needs.moving_frames);
  object.count("extendedFrames", needs.extended_frames).count("surfaces", needs.surfaces);
  object.text("roots", in_words(needs.roots)).json("rootSearches", roots_json(needs.roots));
  object.count("textures", needs.textures);
  object.text("host", host_name()).count("peakMemory", peak_memory());
  object.number("threads", statistics.threads).number("seconds", statistics.seconds);
  object.number("threadSeconds", statistics.thread_seconds);
  object.count("cameraRays", statistics.rays.primary).count("shadowRays", statistics.rays.shadow);
  object.count("dataRays", statistics.rays.data).count("singleRays", statistics.rays.single);
  object.count("mirrorRays", statistics.rays.passed_on).count("endedRays", statistics.rays.ended);
  object.count("nonFinitePixels", faults.non_finite).count("beyondHalfPixels", faults.beyond_half);
  object.count("saturatedPixels", faults.saturated);
  object.count("surfacesMade", scene.counts.surfaces_made)
      .count("surfacesReused", scene.counts.surfaces_reused);
  object.count("materialsMade", scene.counts.materials_made)
      .count("materialsReused", scene.counts.materials_reused);
  object.count("rootsSolved", statistics.rays.roots);
  object.count("unresolvedHits", statistics.rays.unresolved);
  return object.str();
}

std::string statistics_words(const Scene& scene, const RenderSettings& settings,
                             const RenderStatistics& statistics) {
  const std::string colour = settings.wavelengths > 0 ? std::to_string(settings.wavelengths) + " wavelengths"
                                                      : "red, green and blue";
  return "  t = " + json_number(scene.time) + " s, " + json_number(statistics.samples.mean()) +
         " samples a pixel, " + colour + ", " + std::to_string(statistics.rays.primary) + " camera rays, " +
         std::to_string(statistics.rays.shadow) + " shadow rays, " + std::to_string(statistics.threads) +
         " threads";
}

std::string time_json(const TracingTime& time) {
  JsonObject object;
  object.text("event", "end").number("seconds", time.seconds).number("threads", time.threads);
  return object.number("threadSeconds", time.traced).number("lost", time.lost()).str();
}

std::string time_words(const TracingTime& time) {
  char text[160];
  std::snprintf(
      text, sizeof text, "%.2f s from the first tile to the last; %s had no tile for %.1f %% of the time",
      time.seconds,
      time.threads == 1 ? "the thread" : ("each of " + std::to_string(time.threads) + " threads").c_str(),
      100.0 * time.lost());
  return text;
}

// The standard output is written to as it is, and not opened anew under its name: it may be closed, or a file
// to go on in.
Result<StatisticsFile> StatisticsFile::open(const std::filesystem::path& path, bool append) {
  StatisticsFile statistics;
  if (path.empty()) return statistics;
  const bool to_output = path == "-";
  statistics.path_ = to_output ? "standard output" : path;
  const int flags = O_WRONLY | O_CREAT | O_CLOEXEC | (append ? O_APPEND : O_TRUNC);
  statistics.descriptor_ = to_output ? ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0)
                                     : unless_interrupted([&] { return ::open(path.c_str(), flags, 0666); });
  if (statistics.descriptor_ < 0) return cannot_write(statistics.path_);
  return statistics;
}

StatisticsFile::StatisticsFile(StatisticsFile&& other) noexcept
    : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

StatisticsFile& StatisticsFile::operator=(StatisticsFile&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

StatisticsFile::~StatisticsFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Result<void> StatisticsFile::write(const std::string& line) {
  if (descriptor_ < 0) return {};
  const std::string whole = line + '\n';
  for (std::string_view rest = whole; !rest.empty();) {
    const ssize_t written =
        unless_interrupted([&] { return ::write(descriptor_, rest.data(), rest.size()); });
    if (written < 0) return cannot_write(path_);
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
  return {};
}

}  // namespace backlight
