// What tests need that stop a run and go on with it.
#pragma once

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <map>
#include <optional>
#include <thread>

#include "backlight/film/exr.h"
#include "program.h"

namespace backlight::test {

using Arguments = std::vector<std::string>;
using Files = std::vector<std::string>;

inline Arguments operator+(Arguments left, const Arguments& right) {
  left.insert(left.end(), right.begin(), right.end());
  return left;
}

class Again : public ProgramTest {
 protected:
  void expect_success(const Arguments& arguments) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
  }

  // A file that is written anew is another file: it was renamed into its place.
  [[nodiscard]] ino_t number_of(const std::string& name) const {
    struct stat status {};
    EXPECT_EQ(stat((folder / "work" / name).c_str(), &status), 0) << name;
    return status.st_ino;
  }

  // Whether this command writes scene.exr, where a file is already. The old one is kept under another name
  // meanwhile, since its number might be given to the new one.
  bool writes_again(const Arguments& arguments) {
    const auto path = folder / "work" / "scene.exr";
    std::filesystem::create_hard_link(path, folder / "work" / "old");
    const ino_t before = number_of("scene.exr");
    expect_success(arguments);
    const bool anew = number_of("scene.exr") != before;
    std::filesystem::remove(folder / "work" / "old");
    return anew;
  }

  [[nodiscard]] ExrPicture picture(const std::string& name) const {
    auto picture = read_exr(folder / "work" / name);
    if (!picture.ok()) ADD_FAILURE() << picture.error();
    return std::move(picture).value();
  }

  // Waits for a file, or for a minute.
  void wait_for(const std::string& name) const {
    for (int i = 0; i < 6000 && !exists(name); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_TRUE(exists(name)) << name;
  }

  // Whether a process that start() began has come to its end; finish() tells how.
  [[nodiscard]] static bool has_ended(int process) {
    siginfo_t info{};
    return waitid(P_PID, static_cast<id_t>(process), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
           info.si_pid == process;
  }

  // Waits until the program catches a signal, which would end it before.
  static void wait_until_caught(int process, int signal) {
    while (!has_ended(process)) {
      std::ifstream status("/proc/" + std::to_string(process) + "/status");
      for (std::string line; std::getline(status, line);) {
        if (!line.starts_with("SigCgt:")) continue;
        if ((std::stoull(line.substr(7), nullptr, 16) >> (signal - 1) & 1U) != 0) return;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  // Asks for snapshots of a.exr until one shows some pixels; nothing if the image is done before. A tile that
  // is not about to be done begins anew after a snapshot: the pauses get longer until one is long enough.
  [[nodiscard]] std::optional<Image> snapshot_in_the_middle(int process) const {
    wait_until_caught(process, SIGUSR1);
    for (int pause = 10; !has_ended(process); pause += 1 + pause / 4) {
      std::this_thread::sleep_for(std::chrono::milliseconds(pause));
      kill(process, SIGUSR1);
      auto read = read_exr(folder / "work" / "a.partial.exr");
      if (!read.ok()) continue;
      Image& image = read.value().image;
      const int mask = std::max(image.find_channel("rendered.V"), image.find_channel("rendered.left.V"));
      if (std::ranges::count(image.plane(static_cast<std::size_t>(mask)), 1.0F) > 0) return std::move(image);
    }
    return std::nullopt;
  }

  // How often each file was made, by the lines of --stats.
  [[nodiscard]] std::map<std::string, int> made(const std::string& statistics) const {
    std::map<std::string, int> counts;
    std::ifstream file(folder / "work" / statistics);
    for (std::string line; std::getline(file, line);) {
      const std::size_t begin = line.find("\"file\":\"") + 8;
      ++counts[line.substr(begin, line.find('"', begin) - begin)];
    }
    return counts;
  }
};

}  // namespace backlight::test
