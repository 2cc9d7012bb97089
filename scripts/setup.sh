#!/bin/sh
# Make the environment that `make demo`, `make test` and CI run in: scripts/setup.sh VENV
#
# Installs what the system lacks when it runs as root on Debian or Ubuntu, and says what to install
# otherwise. Every Python package is pinned by constraints.txt.
set -eu

venv=${1:?usage: scripts/setup.sh VENV}
cd "$(dirname "$0")/.."

say() { printf 'wordarm: %s\n' "$*" >&2; }

may_install() { [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; }

install() {
    say "installing $*"
    [ -n "${updated:-}" ] || apt-get update -qq
    updated=yes
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "$@" >/dev/null
}

find_python() {
    for candidate in python3 python3.14 python3.13 python3.12 python3.11; do
        if command -v "$candidate" >/dev/null &&
            "$candidate" -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; then
            echo "$candidate"
            return
        fi
    done
}

# A loader of EGL, and a driver for it: Mesa's draws in software.
has_gl() {
    "$python" -c 'import ctypes; ctypes.CDLL("libEGL.so.1")' 2>/dev/null &&
        ls /usr/share/glvnd/egl_vendor.d/*.json /etc/glvnd/egl_vendor.d/*.json 2>/dev/null | grep -q .
}

python=$(find_python)
if [ -z "$python" ] && may_install; then
    install python3 python3-venv
    python=$(find_python)
fi
if [ -z "$python" ]; then
    say "found no Python of version 3.11 or later; install one (Debian: apt-get install python3 python3-venv)"
    exit 2
fi
if ! "$python" -c 'import ensurepip, venv' 2>/dev/null; then
    package=$("$python" -c 'import sys; print("python%d.%d-venv" % sys.version_info[:2])')
    if ! may_install; then
        say "$python cannot make virtual environments; run: apt-get install $package"
        exit 2
    fi
    install "$package"
fi

[ -x "$venv/bin/python" ] || "$python" -m venv "$venv"
say "installing Python packages into $venv"
"$venv/bin/python" -m pip install --quiet --disable-pip-version-check -c constraints.txt -e '.[dev]'

# Pinocchio's wheel leaves OpenMP to the system, and the slimmest systems have none.
if ! "$python" -c 'import ctypes; ctypes.CDLL("libgomp.so.1")' 2>/dev/null; then
    { may_install && install libgomp1; } || say "no OpenMP library for the robot's kinematics; run: apt-get install libgomp1"
fi

# Nothing but videos of the robot needs these, so a machine that cannot get them goes on without.
if ! has_gl; then
    libraries="libegl1 libgl1 libgl1-mesa-dri"
    # shellcheck disable=SC2086 # three words
    { may_install && install $libraries; } ||
        say "no EGL library to draw the robot without a screen; run: apt-get install $libraries"
fi
