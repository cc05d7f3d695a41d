#!/usr/bin/env bash
# Installs what is missing, builds the release preset and runs every test.
#
#   scripts/test.sh [ctest options]        e.g. scripts/test.sh -R laws
#
# Exits with ctest's code: 0 when every test passed.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/install.sh build test
cmake --preset release -DBACKLIGHT_TESTS=ON
cmake --build --preset release
ctest --preset release --no-tests=error -j "$(nproc)" "$@"
