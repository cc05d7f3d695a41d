#include "compare_outcome.h"

#include <algorithm>
#include <cstdio>
#include <set>

#include "backlight/base/json_text.h"

namespace backlight {
namespace {

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string counted(std::uint64_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

std::string not_finite_text(const ChannelDifference& channel) {
  std::string text;
  const auto tell = [&text](std::uint64_t reference, std::uint64_t now, const char* what) {
    if (reference == 0 && now == 0) return;
    text += (text.empty() ? "" : ", ") + std::string(what) + ": " + std::to_string(reference) +
            " in the reference, " + std::to_string(now) + " in the new image";
  };
  tell(channel.nan_reference, channel.nan_new, "NaN");
  tell(channel.inf_reference, channel.inf_new, "Inf");
  if (!text.empty() && channel.not_comparable > 0) {
    text += "; " + std::to_string(channel.not_comparable) + " of them on one side only";
  }
  return text;
}

void add_row(std::string& text, const char* name, const char* mean, const char* rms, const char* maximum,
             const char* where, const char* reference, const char* now, const char* over) {
  char row[256];
  std::snprintf(row, sizeof row, "  %-20s %-11s %-11s %-11s %-11s %-12s %-12s %s\n", name, mean, rms, maximum,
                where, reference, now, over);
  text += row;
}

std::string channel_table(const ImageDifference& difference) {
  std::string text;
  add_row(text, "channel", "mean error", "RMS error", "max error", "at pixel", "reference", "new",
          "over threshold");
  for (const ChannelDifference& c : difference.channels) {
    const std::string where = c.x < 0 ? "-" : std::to_string(c.x) + "," + std::to_string(c.y);
    const std::string over = std::to_string(c.over_fail) + " over " + short_number(c.tolerance);
    // Great whole numbers that are not equal may look it in four digits.
    const bool alike = short_number(c.reference) == short_number(c.now);
    const auto value = [&](double v) {
      if (c.x < 0) return std::string("-");
      return alike ? json_number(v) : short_number(v);
    };
    add_row(text, c.name.c_str(), short_number(c.mean).c_str(), short_number(c.rms).c_str(),
            short_number(c.maximum).c_str(), where.c_str(), value(c.reference).c_str(), value(c.now).c_str(),
            over.c_str());
    if (const std::string odd = not_finite_text(c); !odd.empty()) text += "      " + odd + "\n";
  }
  return text;
}

// `text` as one word for a POSIX shell.
std::string shell_word(const std::string& text) {
  const std::string plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./,:=+@%";
  if (!text.empty() && text.find_first_not_of(plain) == std::string::npos) return text;
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

// The data channels' names as --aov has them.
std::string aov_list(const ImageLayout& layout) {
  std::set<std::string> layers;
  for (const ChannelInfo& channel : layout.channels) {
    if (names_channel("Z", channel.name, layout.views)) layers.insert("Z");
    const std::string layer = channel.name.substr(0, channel.name.find('.'));
    const bool is_view = std::find(layout.views.begin(), layout.views.end(), layer) != layout.views.end();
    if (layer != channel.name && !is_view) layers.insert(layer);
  }
  std::string list;
  for (const std::string& layer : layers) list += (list.empty() ? "" : ",") + layer;
  return list;
}

template <class T>
T attribute(const ExrHeader& header, const char* name, const T& otherwise) {
  const T* found = header.find<T>(name);
  return found != nullptr ? *found : otherwise;
}

}  // namespace

const char* status_name(CompareStatus status) {
  constexpr const char* names[] = {"equal", "warning", "differs", "missing", "extra", "trouble"};
  return names[static_cast<std::size_t>(status)];
}

std::string outcome_text(const CompareOutcome& outcome, bool brief) {
  std::string text = outcome.pair.name + ": " + status_name(outcome.status);
  if (!outcome.difference) return text + ": " + outcome.reason + "\n";
  const ImageDifference& difference = *outcome.difference;
  const ChannelDifference& worst = difference.worst();
  if (difference.over_fail > 0) {
    text += ": " + counted(difference.over_fail, "pixel") + " (" +
            short_number(100.0 * double(difference.over_fail) / double(difference.pixels)) +
            " %) over the threshold";
  }
  if (worst.x >= 0) {
    text += std::string(difference.over_fail > 0 ? ", " : ": ") + "worst " + worst.name + " by " +
            short_number(worst.maximum) + " at " + std::to_string(worst.x) + "," + std::to_string(worst.y);
  }
  text += "\n";
  return brief ? text : text + channel_table(difference);
}

std::string render_again(const ExrPicture& picture, int x, int y, const std::filesystem::path& scenes) {
  const ExrHeader& header = picture.header;
  const ImageLayout& layout = picture.image.layout();
  const auto* scene = header.find<std::string>("backlight/scene");
  if (scene == nullptr) return {};
  std::string command = "backlight render " + shell_word(*scene == "-" ? "-" : (scenes / *scene).string());
  for (const std::string& text : attribute(header, "backlight/overrides", std::vector<std::string>{})) {
    command += " -D " + shell_word(text);
  }
  const auto camera = attribute(header, "backlight/camera", std::string());
  if (!camera.empty()) command += " --camera " + shell_word(camera);
  const double frame = attribute(header, "backlight/frame", 1.0);
  if (frame == double(std::int64_t(frame))) {
    command += " -f " + std::to_string(std::int64_t(frame));
  } else {
    command += " --time " + json_number(attribute(header, "backlight/time", 0.0));
  }
  command += " -r " + std::to_string(layout.display.width()) + "x" + std::to_string(layout.display.height());
  if (const auto* samples = header.find<std::int32_t>("backlight/samples")) {
    command += " -s " + std::to_string(*samples);
  } else {
    command += " --tolerance " + json_number(attribute(header, "backlight/tolerance", 0.0));
  }
  if (const auto* count = header.find<std::int32_t>("backlight/wavelengths");
      count != nullptr && *count > 0) {
    command += " --wavelengths " + std::to_string(*count);
  }
  command += " --seed " + json_number(attribute(header, "backlight/seed", 0.0));
  if (const std::string aovs = aov_list(layout); !aovs.empty()) command += " --aov " + aovs;
  if (x >= 0) {
    command += " --crop " + std::to_string(x) + "," + std::to_string(y) + "," + std::to_string(x + 1) + "," +
               std::to_string(y + 1) + " -o pixel.exr";
  }
  return command;
}

}  // namespace backlight
