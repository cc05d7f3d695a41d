#include "compare_report.h"

#include <cmath>
#include <cstdio>
#include <string_view>

#include "backlight/base/files.h"
#include "backlight/base/json_text.h"
#include "compare_page.h"
#include "compare_pictures.h"

namespace backlight {
namespace {

// A JSON object that grows member by member.
class Members {
 public:
  void text(const char* name, std::string_view value) { raw(name, json_quoted(value)); }
  void number(const char* name, double value) { raw(name, json_number(value)); }
  void raw(const char* name, const std::string& json) {
    members_ += (members_.empty() ? "" : ",") + json_quoted(name) + ":" + json;
  }
  [[nodiscard]] const std::string& members() const { return members_; }
  [[nodiscard]] std::string object() const { return "{" + members_ + "}"; }

 private:
  std::string members_;
};

std::string threshold_text(const CompareLimits& limits) {
  std::string text = "fails above " + json_number(limits.fail);
  if (limits.fail_relative > 0.0) text += " and a relative " + json_number(limits.fail_relative);
  for (const auto& [name, tolerance] : limits.tolerances)
    text += ", " + name + " above " + json_number(tolerance);
  if (limits.fail_percent > 0.0)
    text += ", if more than " + json_number(limits.fail_percent) + " % of the pixels do";
  if (limits.allow_failures > 0) text += ", " + std::to_string(limits.allow_failures) + " pixels spared";
  if (std::isfinite(limits.hard_fail)) text += "; no value by more than " + json_number(limits.hard_fail);
  return text;
}

std::string two_counts(std::uint64_t reference, std::uint64_t now) {
  return std::to_string(reference) + " / " + std::to_string(now);
}

// JSON has no NaN and no infinity: the page shows values as texts.
std::string value_text(const ChannelDifference& channel, double value) {
  if (channel.x < 0) return "–";
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value < 0.0 ? "-Inf" : "Inf";
  char text[32];
  std::snprintf(text, sizeof text, "%.10g", value);
  return text;
}

std::string channel_json(const ChannelDifference& channel) {
  Members members;
  members.text("name", channel.name);
  members.number("tolerance", channel.tolerance);
  members.number("mean", channel.mean);
  members.number("rms", channel.rms);
  members.number("psnr", channel.psnr);
  members.number("max", channel.maximum);
  members.number("x", channel.x);
  members.number("y", channel.y);
  members.text("ref", value_text(channel, channel.reference));
  members.text("now", value_text(channel, channel.now));
  members.number("over", double(channel.over_fail));
  members.text("nan", two_counts(channel.nan_reference, channel.nan_new));
  members.text("inf", two_counts(channel.inf_reference, channel.inf_new));
  return members.object();
}

std::string picture_json(const ReportPicture& picture) {
  Members members;
  members.text("label", picture.label);
  if (!picture.reference.empty()) members.text("reference", picture.reference);
  if (!picture.now.empty()) members.text("now", picture.now);
  if (!picture.heat.empty()) {
    members.text("heat", picture.heat);
    members.number("heatMax", picture.heat_max);
    members.raw("strange", picture.strange ? "true" : "false");
    members.number("worstX", picture.worst_x);
    members.number("worstY", picture.worst_y);
  }
  members.number("width", picture.width);
  members.number("height", picture.height);
  return members.object();
}

template <class List, class Write>
std::string array_json(const List& list, const Write& write) {
  std::string json;
  for (const auto& one : list) json += (json.empty() ? "" : ",") + write(one);
  return "[" + json + "]";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t i = text.find(from); i != std::string::npos; i = text.find(from, i + to.size())) {
    text.replace(i, from.size(), to);
  }
  return text;
}

}  // namespace

CompareReport::CompareReport(const CompareOptions& options) : scenes_(options.scenes) {
  Members members;
  members.text("program", "Backlight " BACKLIGHT_VERSION);
  members.text("reference", options.reference.string());
  members.text("now", options.now.string());
  members.text("limits", threshold_text(options.limits));
  head_ = members.members();
}

Result<void> CompareReport::add(const CompareOutcome& outcome) {
  const auto pictures = report_pictures(outcome);
  if (!pictures.ok()) return pictures.failure();
  Members members;
  members.text("name", outcome.pair.name);
  members.text("status", status_name(outcome.status));
  if (!outcome.reason.empty()) members.text("reason", outcome.reason);
  const std::optional<ExrPicture>& shown = outcome.now ? outcome.now : outcome.reference;
  if (shown) {
    const PixelBox& data = shown->image.layout().data;
    members.number("x0", data.x0);
    members.number("y0", data.y0);
    members.number("width", data.width());
    members.number("height", data.height());
    if (const auto* frame = shown->header.find<double>("backlight/frame")) members.number("frame", *frame);
    if (const std::string again = render_again(*shown, -1, -1, scenes_); !again.empty())
      members.text("again", again);
  }
  if (outcome.difference) {
    const ImageDifference& difference = *outcome.difference;
    members.number("pixels", double(difference.pixels));
    members.number("over", double(difference.over_fail));
    members.number("worst", double(&difference.worst() - difference.channels.data()));
    members.raw("channels", array_json(difference.channels, channel_json));
  }
  members.raw("pictures", array_json(pictures.value(), picture_json));
  images_ += (images_.empty() ? "" : ",\n") + members.object();
  return {};
}

Result<void> CompareReport::write(const std::filesystem::path& path) const {
  // Within a script element nothing may look like the end of it.
  const std::string data = replaced("{" + head_ + ",\"images\":[\n" + images_ + "]}", "<", "\\u003c");
  const std::string page = compare_page;
  const std::string mark = "@DATA@";
  const std::size_t place = page.find(mark);
  return write_file(path, page.substr(0, place) + data + page.substr(place + mark.size()));
}

}  // namespace backlight
