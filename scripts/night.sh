#!/usr/bin/env bash
# What takes a night: renders under every misfortune that the tests know, and thousands of played farms.
#
#   scripts/night.sh [SECONDS]
#
#   1. every single request for memory of a small animation is refused in turn (CI tries some; tests/cli)
#   2. tests/farm/play.py for half of SECONDS (default: 8 hours), with seeds that follow from the date
#   3. scripts/soak.sh for the other half
#   4. the Debian package in a clean root (as root alone)
#
# Exits 0 only if all of it held. Needs the release build with its tests.
set -uo pipefail
cd "$(dirname "$0")/.."
half=$((${1:-28800} / 2))
status=0
BACKLIGHT_EVERY_MISFORTUNE=1 build/release/tests/cli/cli --gtest_filter='Misfortune.*' || status=1
tests/farm/play.py --seeds "$(date +%y%m%d)0000" --seconds $half || status=1
scripts/soak.sh $half || status=1
((EUID != 0)) || { scripts/package.sh && tests/package/run.sh --clean-root out/clean-root out/backlight_*.deb; } || status=1
exit $status
