#include <algorithm>
#include <set>
#include <string_view>
#include <vector>

#include "assembly_cover.h"
#include "backlight/film/assemble.h"

namespace backlight {
namespace {

constexpr std::string_view complete_attribute = "backlight/complete";

std::string box_text(const PixelBox& box) {
  return std::to_string(box.x0) + "," + std::to_string(box.y0) + "," + std::to_string(box.x1) + "," +
         std::to_string(box.y1);
}

std::string size_text(const PixelBox& box) {
  return std::to_string(box.width()) + "x" + std::to_string(box.height());
}

std::string channels_text(const ImageLayout& layout) {
  std::string text;
  for (const ChannelInfo& channel : layout.channels) text += (text.empty() ? "" : " ") + channel.name;
  return text;
}

std::string value_text(const ExrHeader& header, std::string_view name) {
  const auto attribute = std::ranges::find(header.attributes, name, &ExrAttribute::name);
  if (attribute == header.attributes.end()) return "absent";
  return text_of(attribute->value);
}

/// The identity, which differs when anything does, comes last: any other difference tells more.
std::vector<std::string> attribute_names(const ExrHeader& a, const ExrHeader& b) {
  const std::string identity = "backlight/identity";
  std::set<std::string> names;
  for (const ExrHeader* header : {&a, &b}) {
    for (const ExrAttribute& attribute : header->attributes) names.insert(attribute.name);
  }
  std::vector<std::string> ordered(names.begin(), names.end());
  std::stable_partition(ordered.begin(), ordered.end(),
                        [&](const std::string& name) { return name != identity; });
  return ordered;
}

/// "NAME is X, and Y in FIRST", or nothing when both are the same.
std::string contrast(const std::string& name, const std::string& here, const std::string& there,
                     const ImagePart& first) {
  if (here == there) return {};
  return name + " is " + here + ", and " + there + " in " + first.file.string();
}

std::string precision_fault(const ImagePart& part, const ImagePart& first) {
  const auto wide = [](const ChannelInfo& channel) { return channel.precision == ChannelPrecision::single; };
  const auto count = [&](const ImagePart& of) {
    return std::ranges::count_if(of.info.layout.channels, wide);
  };
  if (count(part) == count(first)) return {};
  const ImagePart& wider = count(part) > count(first) ? part : first;
  const ImagePart& narrower = count(part) > count(first) ? first : part;
  return wider.file.string() + " has 32-bit colour and " + narrower.file.string() +
         " 16-bit: a value of one was too large for 16 bits, and the other is rounded already. Render all "
         "parts "
         "with --float; assemble them with --half to have 16 bits wherever the whole image would";
}

std::string difference(const ImagePart& part, const ImagePart& first) {
  const ImageLayout& here = part.info.layout;
  const ImageLayout& there = first.info.layout;
  const ExrHeader& a = part.info.header;
  const ExrHeader& b = first.info.header;
  for (std::string text :
       {contrast("the program", a.software, b.software, first),
        contrast("the size of the whole image", size_text(here.display), size_text(there.display), first),
        contrast("the list of channels", channels_text(here), channels_text(there), first)}) {
    if (!text.empty()) return text;
  }
  for (const std::string& name : attribute_names(a, b)) {
    std::string text = contrast(name, value_text(a, name), value_text(b, name), first);
    if (!text.empty()) return text;
  }
  if (a.world_to_camera != b.world_to_camera) return "the camera is elsewhere than in " + first.file.string();
  if (here.views != there.views || a.comments != b.comments) {
    return "the header is not that of " + first.file.string();
  }
  return {};
}

std::string fault_of(const ImagePart& part, const ImagePart& first) {
  const ImageLayout& layout = part.info.layout;
  const auto* complete = part.info.header.find<std::int32_t>(complete_attribute);
  if (complete == nullptr) return part.file.string() + " was not made by 'backlight render'";
  if (*complete != 1) {
    return part.file.string() + " is not complete: let 'backlight render --resume' finish it first";
  }
  if (part.info.parts > 1) {
    return part.file.string() + " has " + std::to_string(part.info.parts) +
           " parts: images are put together from files of one part";
  }
  const PixelBox& data = layout.data;
  const PixelBox& whole = layout.display;
  if (data.x0 < whole.x0 || data.y0 < whole.y0 || data.x1 > whole.x1 || data.y1 > whole.y1) {
    return part.file.string() + " has pixels outside the image";
  }
  if (const std::string text = difference(part, first); !text.empty()) {
    return part.file.string() + " is a part of another image: " + text;
  }
  return precision_fault(part, first);
}

std::string cover_fault(const std::vector<ImagePart>& parts) {
  std::vector<PixelBox> boxes;
  for (const ImagePart& part : parts) boxes.push_back(part.info.layout.data);
  const std::vector<PixelBox> gaps = uncovered(parts.front().info.layout.display, boxes);
  if (gaps.empty()) return {};
  constexpr std::size_t most_shown = 8;
  std::string text = "parts are missing; render them with";
  for (std::size_t i = 0; i < std::min(gaps.size(), most_shown); ++i)
    text += "\n  --crop " + box_text(gaps[i]);
  if (gaps.size() > most_shown) text += "\n  and " + std::to_string(gaps.size() - most_shown) + " more";
  return text;
}

}  // namespace

std::vector<PixelBox> uncovered(const PixelBox& window, const std::vector<PixelBox>& boxes) {
  std::set<int> edges{window.y0, window.y1};
  for (const PixelBox& box : boxes) {
    for (const int y : {box.y0, box.y1}) {
      if (y > window.y0 && y < window.y1) edges.insert(y);
    }
  }
  std::vector<PixelBox> gaps;
  for (auto top = edges.begin(); std::next(top) != edges.end(); ++top) {
    const int y0 = *top;
    const int y1 = *std::next(top);
    std::vector<std::pair<int, int>> spans;
    for (const PixelBox& box : boxes) {
      if (box.y0 <= y0 && box.y1 >= y1) spans.emplace_back(box.x0, box.x1);
    }
    std::ranges::sort(spans);
    spans.emplace_back(window.x1, window.x1);
    int x = window.x0;
    for (const auto& [begin, end] : spans) {
      if (begin > x) {
        const PixelBox gap{x, y0, std::min(begin, window.x1), y1};
        const auto above = std::ranges::find_if(gaps, [&gap](const PixelBox& other) {
          return other.y1 == gap.y0 && other.x0 == gap.x0 && other.x1 == gap.x1;
        });
        if (above != gaps.end()) {
          above->y1 = gap.y1;
        } else {
          gaps.push_back(gap);
        }
      }
      x = std::max(x, end);
    }
  }
  return gaps;
}

std::string misfit_of(const std::vector<ImagePart>& parts) {
  if (parts.empty()) return "there are no parts";
  for (const ImagePart& part : parts) {
    if (std::string fault = fault_of(part, parts.front()); !fault.empty()) return fault;
  }
  return cover_fault(parts);
}

}  // namespace backlight
