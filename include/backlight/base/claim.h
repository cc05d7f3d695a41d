// Claims: which of several processes, on one machine or many, works on a file. Nothing but the folder that
// they share is needed.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "backlight/base/result.h"

namespace backlight {

/// A lock that is a file. It holds the name of the machine, the process and the time, and exists while its
/// process works.
///
/// - It is made whole under another name and then linked to its own: of several processes one succeeds, on
/// NFS
///   too, where a link counts as made when the file has two names, whatever the server's answer was.
/// - A thread touches it every quarter of the expiry time. A claim that was not touched for the expiry time
/// is
///   stale: its machine has crashed or is cut off. "Now" is the time that the file server gives to a new file
///   in the same folder, so that the machines' clocks need not agree.
/// - A claim of this machine (the same boot, the same process namespace) is stale as soon as its process is
///   gone: nobody waits for a process that was killed.
/// - A stale claim is renamed away, by one of those who see it, and that one goes on.
/// - A process that slept for longer than the expiry time has lost its claim without knowing: it asks
///   is_held() before it puts the file in its place, and drops its work if another took over.
class Claim {
 public:
  struct Attempt {
    std::unique_ptr<Claim> claim;  ///< null: another process has it
    std::string holder;            ///< then: "process 4711 on host"
  };

  /// Tries once. Fails when the folder cannot be written. Makes missing parent folders.
  static Result<Attempt> attempt(const std::filesystem::path& file, std::chrono::seconds expiry);

  /// Gives the claim up: removes the file if it is still this claim's.
  ~Claim();
  Claim(const Claim&) = delete;
  Claim& operator=(const Claim&) = delete;

  /// Whether the file is there and is this claim's.
  [[nodiscard]] bool is_held() const;

 private:
  Claim(std::filesystem::path file, std::string contents, std::chrono::milliseconds interval);
  void touch_until_stopped(std::stop_token stop);

  std::filesystem::path file_;
  std::string contents_;
  std::chrono::milliseconds interval_;
  std::mutex guard_;
  std::condition_variable_any wake_;
  std::jthread thread_;  // last: it uses all the others
};

}  // namespace backlight
