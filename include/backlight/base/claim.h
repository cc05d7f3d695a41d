// Claims: which of several processes, on one machine or many, works on a file. Nothing but the folder that
// they share is needed.
#pragma once

#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "backlight/base/result.h"

namespace backlight {

class Claimant;

/// A lock that is a file, held by this process. The file has the names of the machine and the process and the
/// time in it, and exists while its process works.
class Claim {
 public:
  /// Gives the claim up: removes the file if it is still this claim's.
  ~Claim();
  Claim(const Claim&) = delete;
  Claim& operator=(const Claim&) = delete;

  /// Whether the file is gone or another's: a process that slept for longer than the expiry time has lost its
  /// claim without knowing. It asks before it puts its work in its place, and drops it if another took over.
  /// Where the file cannot be looked at, the claim counts as held.
  [[nodiscard]] bool is_lost() const;

 private:
  friend class Claimant;
  /// Not a claim before hold().
  Claim(Claimant& owner, std::filesystem::path file, std::string contents);
  void hold(int descriptor);
  void renew() const;
  [[nodiscard]] bool has_no_name() const;

  Claimant& owner_;
  std::filesystem::path file_;
  std::string contents_;
  int descriptor_ = -1;  // of the file, whatever name it has by now
};

/// Takes claims and renews them, and watches those of other processes. For use by one thread; its claims may
/// be given up by any, before it is gone.
///
/// - A claim is made whole under another name and then linked to its own: of several processes one succeeds,
///   on NFS too, where a link counts as made when the file has two names, whatever the server's answer was.
/// - A thread touches the claims that are held every quarter of the expiry time.
/// - A claim is stale when this process has seen it unchanged for the expiry time, by its own monotonic
///   clock: its process or its machine has crashed, hangs or is cut off. No time that a file or another
///   machine tells counts for anything, and an empty file, as a power cut may leave, is a claim like others.
/// - A claim of this machine (the same boot, the same process namespace) is stale as soon as its process is
///   gone: nobody waits for a process that was killed.
/// - A stale claim is renamed away, by one of those who see it, and that one goes on.
class Claimant {
 public:
  struct Attempt {
    std::unique_ptr<Claim> claim;  ///< null: another process has it
    std::string holder;            ///< then: "process 4711 on host"
    std::string taken_from;        ///< with a claim: the same of whose stale one it has the place, if any
  };

  /// Throws std::system_error where no thread is to be had.
  explicit Claimant(std::chrono::milliseconds expiry);
  ~Claimant() = default;
  Claimant(const Claimant&) = delete;
  Claimant& operator=(const Claimant&) = delete;

  /// Tries once. Fails when the folder cannot be written, and when what has the claim's name is no regular
  /// file or cannot be read or taken away: waiting would not help. Makes missing parent folders.
  Result<Attempt> attempt(const std::filesystem::path& file);

  /// Takes away a claim that a process has left behind, as far as that is known and possible.
  void clear(const std::filesystem::path& file);

  /// How long to wait before a claim of another is looked at again.
  [[nodiscard]] std::chrono::milliseconds pause() const;

 private:
  using Clock = std::chrono::steady_clock;
  friend class Claim;

  /// A claim of another process, as it was first seen to be what it is now.
  struct Sight {
    std::string seen;
    Clock::time_point since;
  };

  bool is_stale(const std::filesystem::path& file, const std::string& contents, const std::string& seen);
  void renew_until_stopped(std::stop_token stop);

  std::chrono::milliseconds expiry_;
  std::map<std::filesystem::path, Sight> sights_;
  std::mutex guard_;  // of held_, and of the descriptors
  std::vector<const Claim*> held_;
  std::condition_variable_any wake_;
  std::jthread thread_;  // last: it uses all the others
};

}  // namespace backlight
