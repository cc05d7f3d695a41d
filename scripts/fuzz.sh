#!/usr/bin/env bash
# Builds the expression fuzzer with clang and the sanitizers, and runs it.
#
#   scripts/fuzz.sh [SECONDS]        (default: 20)
#
# Starts from tests/fuzz/corpus. An input that fails is left in build/fuzz/found; put it into the corpus, from where
# ctest runs it with every compiler. Exits 1 when one was found.
set -euo pipefail
cd "$(dirname "$0")/.."

seconds=${1:-20}
[[ $seconds =~ ^[0-9]+$ ]] || { echo "scripts/fuzz.sh: '$seconds' is not a number of seconds" >&2; exit 2; }
scripts/install.sh build test ci
cmake --preset clang -B build/fuzz -DBACKLIGHT_FUZZ=ON -DBACKLIGHT_SANITIZE=address >/dev/null
cmake --build build/fuzz --target expression_fuzz
mkdir -p build/fuzz/inputs build/fuzz/found
find build/fuzz -name expression_fuzz -type f -perm -u+x -print -quit | {
  read -r fuzzer
  "$fuzzer" -max_total_time="$seconds" -max_len=200 -artifact_prefix=build/fuzz/found/ build/fuzz/inputs \
    tests/fuzz/corpus/expression || exit 1
}
