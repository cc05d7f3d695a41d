#!/usr/bin/env bash
# Tries the Debian package as someone who has nothing else would.
#
#   tests/package/run.sh [--clean-root FOLDER] [PACKAGE.deb]
#
#   (neither)            makes the package, unpacks it into a folder of its own, and tries it there as an ordinary user: links of
#                        the documents, manual pages, completion, every scene, a video, the Python module. No network
#   --clean-root FOLDER  the same after installing it into the Debian in FOLDER, which is made by debootstrap if it is not there;
#                        and that removing it leaves nothing. Needs root, and the package source that this machine has
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
top=$(cd "$here/../.." && pwd)
root='' package=''
while (($#)); do
  case $1 in
    --clean-root) root=$(realpath -m "$2") && shift 2 ;;
    *) package=$(realpath "$1") && shift ;;
  esac
done
work=$(mktemp -d "${TMPDIR:-/tmp}/backlight-package-XXXXXX")
mounted=no
clean_up() {
  [[ $mounted == no ]] || umount "$root/proc"
  rm -rf "$work"
}
trap clean_up EXIT
chmod 755 "$work"
fail() { echo "tests/package/run.sh: $*" >&2 && exit 1; }

if [[ -z $package ]]; then
  "$top/scripts/package.sh" --without-course "$work/made"
  package=$(echo "$work"/made/backlight_*.deb)
fi

# What cmake installs is what is in the package, but for its files of control.
built=$top/build/release
if [[ -d $built ]]; then
  DESTDIR=$work/installed cmake --install "$built" --prefix /usr >/dev/null
  diff <(cd "$work/installed" && find . -mindepth 1 \( -type f -o -type l \) | sort) \
    <(dpkg-deb --fsys-tarfile "$package" | tar -t | grep -v '/$' | sort) || fail "cmake --install and the package differ"
fi

# ---- where it is: PREFIX, as the user who tries it sees it
if [[ -n $root ]]; then
  ((EUID == 0)) || fail "--clean-root needs root"
  if [[ ! -e $root/etc/debian_version ]]; then
    mirror=$(apt-get indextargets --format '$(SITE)' 'Created-By: Packages' 'Codename: bookworm' | head -n 1)
    [[ -n $mirror ]] || fail "apt knows no source of bookworm"
    debootstrap --variant=minbase bookworm "$root" "$mirror" >"$work/debootstrap.log" || fail "$(tail -n 3 "$work/debootstrap.log")"
    rm -rf "$root"/etc/apt/{sources.list,sources.list.d,apt.conf.d}
    cp -a /etc/apt/{sources.list,sources.list.d,apt.conf.d} "$root/etc/apt/" 2>/dev/null || true
    cp -aL /usr/share/keyrings/. "$root/usr/share/keyrings/"
  fi
  cp -L /etc/resolv.conf /etc/hosts "$root/etc/"
  mountpoint -q "$root/proc" || { mount -t proc proc "$root/proc" && mounted=yes; }
  in_root() { env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive HOME=/root chroot "$root" "$@"; }
  # Caches, logs and the lists of packages are not of the package.
  contents() {
    (cd "$root" && find . -xdev \( -path ./proc -o -path ./var/log -o -path ./var/cache -o -path ./var/lib/apt -o -path ./var/lib/dpkg \
      -o -path ./tmp -o -path ./srv \) -prune -o -print | sort)
  }
  in_root apt-get update -q >/dev/null 2>&1
  # First what it depends on, so that what is left is told apart from it.
  mapfile -t depends < <(dpkg-deb -f "$package" Depends | tr ',' '\n' | sed 's/ *(.*//; s/^ *//')
  in_root apt-get install -q -y --no-install-recommends "${depends[@]}" python3-numpy python3-openimageio ffmpeg >/dev/null
  in_root sh -c 'id tester >/dev/null 2>&1 || useradd -m -d /srv/tester tester'
  in_root dpkg --purge backlight >/dev/null 2>&1 || true  # of a run before that failed
  contents >"$work/before"
  cp "$package" "$root/srv/backlight.deb"
  in_root apt-get install -q -y /srv/backlight.deb >/dev/null
  [[ -z $(in_root dpkg --verify backlight) ]] || fail "dpkg --verify finds changes"
  in_root python3 -c 'import backlight'  # root's Python may keep what it compiled
  prefix=/usr files=$root
  as_user() { in_root setpriv --reuid=tester --regid=tester --init-groups env HOME=/srv/tester "$@"; }
  home=$root/srv/tester/tried
else
  dpkg-deb -x "$package" "$work/unpacked"
  mv "$work/unpacked/usr" "$work/moved here"  # anywhere will do
  prefix="$work/moved here" files=''
  user=()
  ((EUID != 0)) || user=(setpriv --reuid=nobody --regid=nogroup --clear-groups)
  as_user() { env -i PATH="$prefix/bin:/usr/bin:/bin" HOME="$work" PYTHONPATH="$prefix/lib/python3/dist-packages" PYTHONDONTWRITEBYTECODE=1 "${user[@]}" "$@"; }
  home=$work/tried
fi
share=$files$prefix/share
rm -rf "$home" && mkdir -p "$home" && chmod 777 "$home"
inside=${home#"$root"}

# ---- documents, pages, completion, schema
python3 "$here/check_links.py" "$share/doc/backlight/html"
for page in backlight backlight-render backlight-video backlight-farm; do
  gzip -dc "$share/man/man1/$page.1.gz" | mandoc -T lint -W warning || fail "$page.1 has faults"
done
bash -n "$share/bash-completion/completions/backlight"
[[ -s $share/zsh/vendor-completions/_backlight && -s $share/backlight/backlight.schema.json ]] || fail "completion or schema is missing"
[[ $(as_user backlight --version) == "Backlight $(dpkg-deb -f "$package" Version | sed 's/-1$//')" ]] || fail "another version"

# ---- the course, where the package has it: moved and clicked in a browser (with the packages of scripts/install.sh test), and its lessons' commands as they stand
if [[ -e $share/doc/backlight/html/course.html ]]; then
  python3 "$top/tests/course/page_test.py" "$files$prefix/bin/backlight" "$work/page" --page "$share/doc/backlight/html/course.html"
fi
cat >"$home/lessons.sh" <<'LESSONS'
cd "$1" && mkdir -p lessons && cd lessons && ln -s "$2/share/backlight/scenes" . && ran=0
for lesson in "$2"/share/doc/backlight/html/course/[0-9][0-9]-*.html; do
  commands=$(python3 -c 'import html, re, sys; print("\n".join(html.unescape(re.sub("<[^>]*>", "", b)) for b in re.findall(r"<pre[^>]*>(.*?)</pre>", open(sys.argv[1]).read(), re.S) if "backlight " in b))' "$lesson")
  printf '%s\n' "$commands" | sh -eu >told.txt 2>&1 || { cat told.txt; echo "the commands of $lesson failed" >&2; exit 1; }
  ran=$((ran + 1))
done
[ "$ran" -eq 10 ] && echo "$ran lessons"
LESSONS
as_user sh "$inside/lessons.sh" "$inside" "$prefix"

# ---- every scene, as an ordinary user, small
cat >"$home/scenes.sh" <<'SCENES'
cd "$1" && made=0
for scene in "$2"/share/backlight/scenes/*.toml; do
  name=$(basename "$scene" .toml)
  backlight "$scene" -q -f 1 -r 64x48 -s 1 -o "$name.exr" || { echo "$name failed" >&2; exit 1; }
  made=$((made + 1))
done
backlight view -q ./*.exr -o sheet.png
[ "$made" -ge 30 ] && [ -s sheet.png ] && echo "$made scenes"
backlight "$2/share/backlight/scenes/street-lamp-flicker.toml" -q -r 64x48 -s 1 -f 1-3 -o film/lamp.####.exr
backlight-video film/lamp.*.exr -o lamp.mp4 && [ -s lamp.mp4 ]
backlight-farm --help | grep -q "array job"
SCENES
as_user sh "$inside/scenes.sh" "$inside" "$prefix"
cat >"$home/module.py" <<'MODULE'
import backlight, os, sys
prefix = sys.argv[1]
assert backlight._program() == os.path.realpath(prefix + "/bin/backlight"), backlight._program()
image = backlight.render(prefix + "/share/backlight/scenes/fig3-earth.toml", resolution=(64, 48), samples=1)
assert image["rgb"].shape == (48, 64, 3) and image._repr_png_().startswith(b"\x89PNG")
print("module:", image)
MODULE
as_user /usr/bin/python3 "$inside/module.py" "$prefix"

# ---- and away
if [[ -n $root ]]; then
  in_root apt-get purge -q -y backlight >/dev/null
  contents >"$work/after"
  diff "$work/before" "$work/after" || fail "removed, it leaves something behind"
  echo "Removed, it leaves nothing."
fi
echo "The package works."
