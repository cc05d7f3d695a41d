// The commands. Each returns the exit code (exit_codes.h), and says what went wrong on stderr.
#pragma once

#include "options.h"

namespace backlight {

int run(const RenderOptions& options);
int run(const CheckOptions& options);
int run(const CompareOptions& options);
int run(const SchemaOptions& options);
int run(const ViewOptions& options);
int run(const InfoOptions& options);
int run(const ProbeOptions& options);
int run(const AssembleOptions& options);

}  // namespace backlight
