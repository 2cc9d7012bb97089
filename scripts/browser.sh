#!/bin/sh
# The browser in which `make test` tries docs/play: installed as root on Debian, otherwise left out with a word.
set -eu

say() { printf 'wordarm: %s\n' "$*" >&2; }

command -v chromium >/dev/null && exit 0
# Ubuntu's package of that name is a stub for another way of installing.
if [ "$(id -u)" = 0 ] && grep -q '^ID=debian' /etc/os-release 2>/dev/null; then
    say "installing chromium for the tests of docs/play"
    if apt-get update -qq &&
        DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends chromium >/dev/null; then
        exit 0
    fi
fi
say "no chromium, so the tests of docs/play in a browser are skipped; as root on Debian: apt-get install chromium"
