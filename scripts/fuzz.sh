#!/usr/bin/env bash
# Builds the fuzzers of expressions, of their evaluators, of solids and of the readers of meshes with clang and the sanitizers, and runs one after the other.
#
#   scripts/fuzz.sh [SECONDS] [SEED]        (of each; default: 20, and another seed each time)
#
# Starts from tests/fuzz/corpus. An input that fails is left in build/fuzz/found; put it into the corpus, from where
# ctest runs it with every compiler. Exits 1 when one was found.
set -euo pipefail
cd "$(dirname "$0")/.."

seconds=${1:-20}
seed=${2:-0}
. scripts/whole_numbers.sh
need_whole_numbers "$seconds" "$seed"
scripts/install.sh build test ci
cmake --preset clang -B build/fuzz -DBACKLIGHT_FUZZ=ON -DBACKLIGHT_SANITIZE=address >/dev/null
cmake --build build/fuzz --target expression_fuzz evaluator_fuzz solid_fuzz model_fuzz
mkdir -p build/fuzz/found
for fuzzer in expression evaluator solid model; do
  mkdir -p build/fuzz/inputs/$fuzzer
  longest=200
  [[ $fuzzer != model ]] || longest=4000
  program=$(find build/fuzz -name ${fuzzer}_fuzz -type f -perm -u+x -print -quit)
  "$program" -max_total_time="$seconds" -seed="$seed" -max_len="$longest" -artifact_prefix=build/fuzz/found/ -print_final_stats=1 \
    build/fuzz/inputs/$fuzzer tests/fuzz/corpus/$fuzzer || exit 1
done
