#!/usr/bin/env bash
# Formats every C++ file of the tree with clang-format 14, whose output .clang-format is written for.
#
#   scripts/format.sh            rewrites the files
#   scripts/format.sh --check    changes nothing; names what differs and exits 1
set -euo pipefail
cd "$(dirname "$0")/.."

mapfile -t files < <(find include src tests bench -name '*.h' -o -name '*.cpp' | LC_ALL=C sort)
case ${1:-} in
  --check) clang-format-14 --dry-run -Werror "${files[@]}" && echo "${#files[@]} files are formatted" ;;
  "") clang-format-14 -i "${files[@]}" ;;
  *) echo "usage: scripts/format.sh [--check]" >&2; exit 2 ;;
esac
