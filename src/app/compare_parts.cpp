// The two files of a pair, part by part.
#include <algorithm>
#include <utility>

#include "compare_outcome.h"

namespace backlight {
namespace {

using Parts = std::vector<ExrInfo>;

// A part's number on both sides.
struct PartPair {
  std::optional<std::size_t> reference;
  std::optional<std::size_t> now;
};

// Where among `parts` that one is which is number `i` of its own file and called `name`. The only part of a
// file may be without a name: it is the other file's first.
std::optional<std::size_t> find_part(const Parts& parts, std::size_t i, const std::string& name) {
  if (name.empty() || (i == 0 && parts.size() == 1 && parts.front().part.empty())) return 0;
  const auto found = std::ranges::find(parts, name, &ExrInfo::part);
  if (found == parts.end()) return std::nullopt;
  return static_cast<std::size_t>(found - parts.begin());
}

// In the order of the reference, then what only the new file has.
std::vector<PartPair> matched(const Parts& reference, const Parts& now) {
  if (reference.size() == 1 && now.size() == 1) return {{0, 0}};  // whatever they are called
  std::vector<PartPair> pairs;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    pairs.push_back({i, find_part(now, i, reference[i].part)});
  }
  for (std::size_t i = 0; i < now.size(); ++i) {
    const auto same = [i](const PartPair& pair) { return pair.now == i; };
    if (std::ranges::none_of(pairs, same)) pairs.push_back({std::nullopt, i});
  }
  return pairs;
}

bool fits(const std::string& name, const ExrInfo& part) {
  return std::ranges::any_of(part.layout.channels, [&](const ChannelInfo& channel) {
    return names_channel(name, channel.name, part.layout.views);
  });
}

bool fits_any(const std::string& name, const Parts& parts) {
  return std::ranges::any_of(parts, [&](const ExrInfo& part) { return fits(name, part); });
}

// The limits as far as they are about this part; what fits none at all stays, for compare_images to refuse.
CompareLimits limits_of(CompareLimits limits, const ExrInfo& part, const Parts& all) {
  const auto is_of_others = [&](const std::string& name) { return fits_any(name, all) && !fits(name, part); };
  std::erase_if(limits.channels, is_of_others);
  std::erase_if(limits.tolerances, [&](const auto& tolerance) { return is_of_others(tolerance.first); });
  return limits;
}

// Why two parts that can be read are no pictures of one kind, or nothing.
std::string contrast(const ExrInfo& reference, const ExrInfo& now) {
  if (reference.has_levels || now.has_levels) {
    return std::string(reference.has_levels ? "the reference" : "the new picture") +
           " is mip-mapped: its smaller levels are not looked at";
  }
  if (reference.pixel_aspect != now.pixel_aspect) {
    return "the pixels' aspect ratios differ: " + text_of(reference.pixel_aspect) + " and " +
           text_of(now.pixel_aspect);
  }
  if (reference.chromaticities != now.chromaticities) {
    return "the chromaticities differ: red, green and blue are not of the same colours";
  }
  return {};
}

void read_part(const std::filesystem::path& path, std::size_t part, std::optional<ExrPicture>& picture,
               std::string& reason) {
  auto result = read_exr(path, part);
  if (result.ok()) {
    picture = std::move(result).value();
  } else {
    reason += (reason.empty() ? "" : "; ") + result.error();
  }
}

CompareStatus status_of(Verdict verdict) {
  if (verdict == Verdict::failure) return CompareStatus::differs;
  return verdict == Verdict::warning ? CompareStatus::warning : CompareStatus::equal;
}

// Reads what there is of the part and judges it.
class Judge {
 public:
  Judge(const Parts& reference, const Parts& now) : reference_(reference), now_(now) {}

  void operator()(CompareOutcome& outcome, const PartPair& part, const CompareLimits& limits) const {
    if (part.reference) {
      read_part(outcome.pair.reference, *part.reference, outcome.reference, outcome.reason);
    }
    if (part.now) read_part(outcome.pair.now, *part.now, outcome.now, outcome.reason);
    if (!outcome.reason.empty()) return;
    if (!part.reference || !part.now) {
      outcome.status = part.now ? CompareStatus::extra : CompareStatus::missing;
      const std::string what = reference_.empty() || now_.empty() ? "image" : "part";
      outcome.reason = part.now ? "it has no reference" : "there is a reference, but no new " + what;
      return;
    }
    outcome.reason = contrast(reference_[*part.reference], now_[*part.now]);
    if (!outcome.reason.empty()) return;
    auto compared = compare_images(outcome.reference->image, outcome.now->image, limits);
    if (!compared.ok()) {
      outcome.reason = compared.error();
      return;
    }
    outcome.difference = std::move(compared).value();
    outcome.status = status_of(outcome.difference->verdict);
  }

 private:
  const Parts& reference_;
  const Parts& now_;
};

CompareOutcome outcome_of(const ImagePair& pair) {
  return {pair, CompareStatus::trouble, {}, {}, {}, {}};
}

// The headers of all parts of `path`, none where there is no file; what is wrong goes to `reason`.
Parts headers_of(const std::filesystem::path& path, std::string& reason) {
  if (path.empty()) return {};
  auto result = read_exr_parts(path);
  if (result.ok()) return std::move(result).value();
  reason += (reason.empty() ? "" : "; ") + result.error();
  return {};
}

std::optional<std::size_t> first_of(const Parts& parts) {
  return parts.empty() ? std::nullopt : std::optional<std::size_t>(0);
}

}  // namespace

std::vector<CompareOutcome> compare_pair(const ImagePair& pair, const CompareLimits& limits) {
  CompareOutcome whole = outcome_of(pair);
  const Parts reference = headers_of(pair.reference, whole.reason);
  const Parts now = headers_of(pair.now, whole.reason);
  const Judge judge(reference, now);
  if (reference.empty() || now.empty()) {
    judge(whole, {first_of(reference), first_of(now)}, limits);
    return {std::move(whole)};
  }
  std::vector<CompareOutcome> outcomes;
  for (const PartPair& part : matched(reference, now)) {
    const ExrInfo& info = part.reference ? reference[*part.reference] : now[*part.now];
    const CompareLimits of_part = limits_of(limits, info, part.reference ? reference : now);
    if (!limits.channels.empty() && of_part.channels.empty()) continue;
    CompareOutcome outcome = outcome_of(pair);
    if (reference.size() > 1 || now.size() > 1) outcome.pair.name += ", part '" + info.part + "'";
    judge(outcome, part, of_part);
    outcomes.push_back(std::move(outcome));
  }
  return outcomes;
}

}  // namespace backlight
