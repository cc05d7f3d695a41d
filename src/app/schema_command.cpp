#include <iostream>

#include "backlight/scene/schema.h"
#include "commands.h"
#include "exit_codes.h"

namespace backlight {

int run(const SchemaOptions& options) {
  std::cout << (options.markdown ? reference_markdown() : json_schema());
  return exit_success;
}

}  // namespace backlight
