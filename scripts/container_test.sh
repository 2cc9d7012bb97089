#!/bin/sh
# Try `wordarm doctor` in a bare Debian, as in a container: scripts/container_test.sh FOLDER [SUITE]
#
# FOLDER should be empty or missing. Needs root and debootstrap; takes some minutes and 3 GB. Packages come from
# where this machine's pip and apt take them. Without OpenGL the command must end with 1 and say what to
# install; after exactly that it must end with 0.
set -eu

root=${1:?usage: scripts/container_test.sh FOLDER [SUITE]}
suite=${2:-stable}
sources=$(cd "$(dirname "$0")/.." && pwd)
python=${PYTHON:-$sources/.venv/bin/python}

say() { printf '== %s\n' "$*" >&2; }
inside() { chroot "$root/debian" /usr/bin/env -i DEBIAN_FRONTEND=noninteractive PATH=/usr/bin:/bin:/usr/sbin:/sbin HOME=/root "$@"; }
doctor() { inside /venv/bin/wordarm doctor; }

mkdir -p "$root/wheels"
root=$(cd "$root" && pwd)
say "a Debian $suite in $root/debian"
[ -d "$root/debian" ] || debootstrap --variant=minbase --include=python3-venv "$suite" "$root/debian" \
    ${MIRROR:+"$MIRROR"}
cp /etc/resolv.conf "$root/debian/etc/resolv.conf"

say "what wordarm needs, as wheels"
"$python" -m pip wheel --quiet -c "$sources/constraints.txt" -w "$root/wheels" "$sources"
mkdir -p "$root/debian/wheels"
cp "$root"/wheels/*.whl "$root/debian/wheels/"
inside python3 -m venv /venv
inside /venv/bin/python -m pip install --quiet --no-index --find-links /wheels wordarm
inside /venv/bin/python -m pip install --quiet --no-index --find-links /wheels --no-deps --force-reinstall wordarm
mountpoint -q "$root/debian/proc" || mount -t proc proc "$root/debian/proc"
trap 'umount "$root/debian/proc"' EXIT

say "without OpenGL"
if doctor >"$root/without.txt"; then
    say "the doctor was content without OpenGL"
    exit 1
fi
cat "$root/without.txt"
moves=$(sed -n 's/^  [^:]*: apt-get install //p' "$root/without.txt" | tr '\n' ' ')
[ -n "$moves" ] || { say "the doctor did not say what to install"; exit 1; }

say "apt-get install $moves"
inside apt-get update -qq
# shellcheck disable=SC2086 # several words
inside apt-get install -y -qq --no-install-recommends $moves >/dev/null
doctor
say "content"
