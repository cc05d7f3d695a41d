// What stands in the file of a claim.
#pragma once

#include <string>

namespace backlight {

/// Machine, process and time, a `name value` a line. No two claims have the same contents.
std::string new_claim_contents();

/// "process 4711 on host", or "another process" where the contents do not tell.
std::string claim_holder(const std::string& contents);

/// Whether these are the contents of a claim of a process of this machine, which is gone. False where that
/// cannot be known.
bool is_claim_of_a_dead_process(const std::string& contents);

/// The name of this machine.
std::string host_name();

}  // namespace backlight
