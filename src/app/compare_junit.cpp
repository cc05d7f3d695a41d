#include "compare_junit.h"

#include "backlight/base/files.h"
#include "backlight/base/json_text.h"

namespace backlight {
namespace {

std::string counts_text(std::size_t tests, std::size_t failures, std::size_t errors) {
  return " tests=\"" + std::to_string(tests) + "\" failures=\"" + std::to_string(failures) + "\" errors=\"" +
         std::to_string(errors) + "\"";
}

std::string element(const std::string& name, const std::string& attributes, const std::string& text) {
  return "      <" + name + attributes + ">" + xml_escaped(text) + "</" + name + ">\n";
}

// Its message: the first line, without the image's name.
std::string message_of(const CompareOutcome& outcome) {
  const std::string text = outcome_text(outcome, true);
  const std::size_t begin = outcome.pair.name.size() + 2;
  return text.substr(begin, text.find('\n', begin) - begin);
}

}  // namespace

void JunitReport::add(const CompareOutcome& outcome, bool updated) {
  const CompareStatus status = outcome.status;
  const bool passed = status == CompareStatus::equal || status == CompareStatus::warning || updated;
  std::string told;
  if (passed && status != CompareStatus::equal) {
    told = element("system-out", "", outcome_text(outcome, false) + (updated ? "updated\n" : ""));
  } else if (!passed) {
    const bool is_error = status == CompareStatus::trouble;
    ++(is_error ? errors_ : failures_);
    told = element(is_error ? "error" : "failure",
                   std::string(" type=\"") + status_name(status) + "\" message=\"" +
                       xml_escaped(message_of(outcome)) + "\"",
                   outcome_text(outcome, false));
  }
  ++tests_;
  cases_ += "    <testcase classname=\"backlight.compare\" name=\"" + xml_escaped(outcome.pair.name) + "\"" +
            (told.empty() ? "/>\n" : ">\n" + told + "    </testcase>\n");
}

Result<void> JunitReport::write(const std::filesystem::path& path) const {
  const std::string counts = counts_text(tests_, failures_, errors_);
  return write_file(path, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites" + counts +
                              ">\n  <testsuite name=\"backlight compare\"" + counts + ">\n" + cases_ +
                              "  </testsuite>\n</testsuites>\n");
}

}  // namespace backlight
