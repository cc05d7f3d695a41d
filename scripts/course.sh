#!/usr/bin/env bash
# Makes the course of docs/course into one page that needs nothing else: out/course.html, with its pictures in it and sliders over them. Some
# minutes on two CPUs.
#
#   scripts/course.sh [-o PAGE.html] [--resolution WxH] [--samples N] [--refresh-docs] [SLIDER ...]
#
#   -o               the page (default: out/course.html); its images are kept beside it in a folder of its name without .html, and used again
#   --resolution     of the pictures (default: 641x361)
#   --samples        in each pixel (default: 4)
#   --refresh-docs   write docs/course/images as well: the pictures that the lessons show
#   SLIDER           only these of docs/course/sliders.toml get sliders; the others show their picture
#
# Needs pandoc, oiiotool and python3 (scripts/install.sh docs). BACKLIGHT=/path/to/backlight uses another program.
set -euo pipefail
# shellcheck source=scripts/find_program.sh
source "$(dirname "$0")/find_program.sh"
program=$(find_program) || exit 2
exec python3 "$(dirname "$0")/course/make_page.py" "$program" "$@"
