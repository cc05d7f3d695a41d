#!/usr/bin/env bash
# Makes the Debian package: out/backlight_VERSION-1_ARCHITECTURE.deb. Says how it fares with lintian.
#
#   scripts/package.sh [--without-course] [FOLDER]        puts the package into FOLDER instead of out/
#
# The page of the course is in it too, whose pictures take some minutes the first time (scripts/course.sh).
# Its dates are those of the last commit, so that the same sources give the same package.
set -euo pipefail
course=yes
[[ ${1:-} != --without-course ]] || { course=no && shift; }
folder=$(realpath -m "${1:-$(dirname "$0")/../out}")
cd "$(dirname "$0")/.."
scripts/install.sh build docs package
if [[ -z ${SOURCE_DATE_EPOCH:-} ]]; then
  SOURCE_DATE_EPOCH=$(git log -1 --format=%ct 2>/dev/null || date +%s)
fi
export SOURCE_DATE_EPOCH
# The tests are left out, unless this build folder has them already.
tests=OFF
grep -qs '^BACKLIGHT_TESTS:BOOL=ON' build/release/CMakeCache.txt && tests=ON
cmake --preset release -DBACKLIGHT_TESTS=$tests
rm -f build/release/manual/made  # those of an ordinary build have no date
cmake --build --preset release --target backlight backlight_oiio backlight_models manual documents
if [[ $course == yes ]]; then
  BACKLIGHT=build/release/bin/backlight scripts/course.sh -o build/release/course.html
  cp build/release/course.html build/release/html/
fi
mkdir -p "$folder"
(cd build/release && cpack -B "$folder")
rm -rf "$folder/_CPack_Packages"
for package in "$folder"/backlight_*.deb; do
  lintian --fail-on error --suppress-tags bogus-mail-host "$package"
  echo "$package"
done
