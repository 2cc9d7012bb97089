#!/bin/sh
# Make the environment that `make demo`, `make test` and CI run in: scripts/setup.sh VENV
#
# What the system lacks is found first, all of it, and installed at once as root on Debian or Ubuntu; otherwise it
# is named in one line that can be copied. `scripts/setup.sh --missing` only names it. Every Python package is
# pinned by constraints.txt.
set -eu

venv=${1:?usage: scripts/setup.sh VENV, or scripts/setup.sh --missing}
cd "$(dirname "$0")/.."

say() { printf 'wordarm: %s\n' "$*" >&2; }

may_install() { [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; }

find_python() {
    for candidate in python3 python3.14 python3.13 python3.12 python3.11; do
        if command -v "$candidate" >/dev/null &&
            "$candidate" -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; then
            echo "$candidate"
            return
        fi
    done
}

loads() { [ -n "$python" ] && "$python" -c 'import ctypes, sys; ctypes.CDLL(sys.argv[1])' "$1" 2>/dev/null; }

# A loader of EGL, and a driver for it: Mesa's draws in software.
has_gl() {
    loads libEGL.so.1 &&
        for file in /usr/share/glvnd/egl_vendor.d/*.json /etc/glvnd/egl_vendor.d/*.json; do
            [ -e "$file" ] && return 0
        done
    return 1
}

# Packages without which nothing can be done (needed), and without which something is left out (wanted).
look() {
    python=$(find_python)
    needed= wanted=
    if [ -z "$python" ]; then
        needed="python3 python3-venv"
    elif ! "$python" -c 'import ensurepip, venv' 2>/dev/null; then
        needed=$("$python" -c 'import sys; print("python%d.%d-venv" % sys.version_info[:2])')
    fi
    command -v git >/dev/null || wanted="git"
    loads libgomp.so.1 || wanted="$wanted libgomp1"
    has_gl || wanted="$wanted libegl1 libgl1 libgl1-mesa-dri"
    missing=$(echo $needed $wanted)
}

# What every package is for, one a line.
explain() {
    for package in $missing; do
        case $package in
            python*-venv) what="an environment of its own for it" ;;
            python*) what="the Python (3.11 or later) that everything runs in" ;;
            git) what="notes in every run which revision made it" ;;
            libgomp1) what="the robot's kinematics" ;;
            libegl1) what="films of the robot, drawn without a screen, as are the next two" ;;
            *) continue ;;
        esac
        say "  $package: $what"
    done
}

look
if [ -n "$missing" ]; then
    if [ "$venv" != --missing ] && may_install; then
        say "installing $missing"
        apt-get update -qq
        # Nothing but films needs what is wanted, so a machine that cannot get it goes on without.
        # shellcheck disable=SC2086 # several words
        DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing >/dev/null ||
            say "not all of it could be installed"
        look
    fi
fi
if [ -n "$missing" ]; then
    say "this system lacks $(echo $missing | wc -w | tr -d ' ') packages; on Debian or Ubuntu: sudo apt-get install $missing"
    explain
fi
if [ "$venv" = --missing ]; then
    [ -z "$missing" ] && say "this system lacks nothing"
    exit 0
fi
if [ -n "$needed" ]; then
    say "without Python nothing can be set up; install the above, then repeat the command"
    exit 2
fi

[ -x "$venv/bin/python" ] || "$python" -m venv "$venv"
say "installing Python packages into $venv"
"$venv/bin/python" -m pip install --quiet --disable-pip-version-check -c constraints.txt -e '.[dev]'

# Now rather than after the first evolution: can the robot be drawn?
picture=
if "$venv/bin/python" -m mujoco_port.doctor.drawing; then
    picture=--picture
else
    say "without it there are no films; all else works"
fi
# Once, for all clones of these sources; otherwise the first command would.
say "compiling"
"$venv/bin/python" -m scripts.warm_up $picture || say "that failed; wordarm doctor says more"
