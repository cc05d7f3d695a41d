#!/usr/bin/env bash
# Installs the Debian packages that a group of tasks needs, and only those that are missing.
#
#   scripts/install.sh [build] [test] [ci] [bench] [charts] [docs] [oracle] [farm] [blender] [package]      (default: build)
#
#   build    compiler, CMake and libraries: what scripts/render.sh needs
#   test     what the tests need besides
#   ci       the second compiler and the formatter of .ci/run
#   bench    what scripts/bench.sh measures beside: POV-Ray, Embree; and kernel benchmarks
#   charts   what scripts/gallery.sh and the charts of docs/ need besides
#   docs     what scripts/course.sh needs besides
#   farm     a Slurm for this machine alone, GNU parallel and ffmpeg: what tests/farm/run.sh needs
#   blender  Blender, on which the test of its exporter is skipped otherwise: 600 MB
#   package  what scripts/package.sh needs besides, and its test: pandoc, lintian, debootstrap
#   oracle   mpmath, to recompute the reference values that the tests hold as literals
#
# Made for Debian 12. With everything present it needs neither root nor network.
set -euo pipefail

declare -A packages=(
  [build]="g++ cmake ninja-build pkgconf libopenexr-dev libopenimageio-dev libfontconfig-dev libfreetype-dev fonts-dejavu-core libtinyobjloader-dev nlohmann-json3-dev libglm-dev libtomlplusplus-dev libcli11-dev"
  [test]="libgtest-dev chromium ffmpeg openimageio-tools libmpfr-dev libgmp-dev pandoc python3 python3-jsonschema python3-fastjsonschema python3-numpy python3-openimageio mandoc man-db bsdextrautils zsh parallel"
  [ci]="clang-14 libclang-rt-14-dev clang-format-14"
  [bench]="libbenchmark-dev libembree-dev libmpfr-dev povray python3 util-linux"
  [docs]="pandoc openimageio-tools python3"
  [charts]="gnuplot-nox openimageio-tools python3 fonts-dejavu-core"
  [farm]="slurmctld slurmd slurm-client munge parallel ffmpeg"
  [package]="pandoc python3 dpkg-dev file lintian debootstrap"
  [oracle]="python3 python3-mpmath"
  [blender]="blender"
)

wanted=()
for group in "${@:-build}"; do
  if [[ -z ${packages[$group]:-} ]]; then
    echo "scripts/install.sh: no group '$group'; there are: build test ci bench charts docs farm oracle blender package" >&2
    exit 2
  fi
  read -ra names <<<"${packages[$group]}"
  wanted+=("${names[@]}")
done

if ! command -v dpkg-query >/dev/null; then
  echo "Not a Debian system: going on in the hope that the equivalents of these are installed: ${wanted[*]}" >&2
  exit 0
fi

missing=()
for name in "${wanted[@]}"; do
  [[ $(dpkg-query -W -f='${db:Status-Status}' "$name" 2>/dev/null) == installed* ]] || missing+=("$name")
done
((${#missing[@]})) || exit 0

as_root=()
if ((EUID != 0)); then
  if ! command -v sudo >/dev/null; then
    echo "These packages are missing, and installing them needs root. As root, run:" >&2
    echo "  apt-get update && apt-get install --no-install-recommends ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi
echo "Installing: ${missing[*]}"
"${as_root[@]}" apt-get update -q
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}"
