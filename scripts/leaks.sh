#!/usr/bin/env bash
# Aims rays at the edges and corners of closed meshes from inside, and counts those that get out: there must be none.
#
#   scripts/leaks.sh [TIMES]      as many times a million rays (100: a few minutes on one CPU)
set -euo pipefail
cd "$(dirname "$0")/.."

times=${1:-100}
. scripts/whole_numbers.sh
need_whole_numbers "$times"
scripts/install.sh build test
cmake --preset release >/dev/null
cmake --build --preset release --target unit_surface
BACKLIGHT_LEAK_TIMES=$times build/release/tests/unit_surface --gtest_filter='Mesh.HasNoLeaksAtEdgesAndCorners'
