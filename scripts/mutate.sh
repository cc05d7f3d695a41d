#!/usr/bin/env bash
# Tries mutated scenes, images, textures, tables of numbers and meshes, with the address and undefined-behaviour
# sanitizers: none may crash, take over 10 s or over 2 GB.
#
#   scripts/mutate.sh [COUNT] [SEED] [KIND...]        (of each; default: 100000 1 scene image texture table mesh)
#
# The same seed makes the same inputs. One that fails is left in build/asan/found; put it into
# tests/fuzz/corpus/KIND, from where ctest runs it for ever. Exits 1 when one was found.
set -euo pipefail
cd "$(dirname "$0")/.."

count=${1:-100000}
seed=${2:-1}
. scripts/whole_numbers.sh
need_whole_numbers "$count" "$seed"
shift $(($# < 2 ? $# : 2))
kinds=("$@")
((${#kinds[@]})) || kinds=(scene image texture table mesh)

scripts/install.sh build test
cmake --preset asan >/dev/null
cmake --build --preset asan --target mutation_campaign backlight_oiio backlight_models
program=$(find build/asan -name mutation_campaign -type f -perm -u+x -print -quit)
export BACKLIGHT_MODULE_PATH=$PWD/build/asan/lib/backlight
seeds=tests/fuzz/corpus/seeds
result=0
for kind in "${kinds[@]}"; do
  case $kind in
    scene) files=(scenes/*.toml tests/golden/scenes/*.toml) ;;
    image) files=("$seeds"/*.exr) ;;
    texture) files=("$seeds"/texture.*) ;;
    table) files=("$seeds"/*.csv) ;;
    mesh) files=("$seeds"/mesh*) ;;
    *) echo "scripts/mutate.sh: '$kind' is none of scene, image, texture, table and mesh" >&2; exit 2 ;;
  esac
  echo "=== $kind"
  "$program" "$kind" "$count" "$seed" "build/asan/found/$kind" "${files[@]}" || result=1
done
exit $result
