#!/usr/bin/env bash
# third_party/fetch without a network: says what it lacks and leaves nothing half-made; is content with a filled cache; and
# doesn't use a file that isn't the pinned one. PIP_NO_INDEX takes pip's network away.
set -euo pipefail
source=$1
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
mkdir "$tmp/third_party" "$tmp/cache"
cp "$source"/third_party/{fetch,debian-mirror,pins} "$tmp/third_party/"
fail() { echo "FAILED: $*"; exit 1; }

fetch() { XDG_CACHE_HOME=$tmp/cache PIP_NO_INDEX=1 PIP_FIND_LINKS='' "$tmp/third_party/fetch" >"$tmp/said" 2>&1; }

fetch && fail "an empty cache and no network must be an error"
grep -q "could not download mujoco 2.2.2" "$tmp/said" || fail "the message doesn't name what is missing: $(cat "$tmp/said")"
[ ! -e "$tmp/third_party/prefix" ] || fail "something was left half-made"

cp "${XDG_CACHE_HOME:-$HOME/.cache}"/pmg/* "$tmp/cache/pmg/"
fetch || fail "a filled cache must be enough: $(cat "$tmp/said")"
[ -f "$tmp/third_party/prefix/mujoco/lib/libmujoco.so.2.2.2" ] || fail "MuJoCo wasn't unpacked"

rm -rf "$tmp/third_party/prefix"
echo tampered >>"$tmp/cache/pmg/mujoco-2.2.2.wheel"
fetch && fail "a file with another checksum was used"
[ ! -e "$tmp/third_party/prefix" ] || fail "a file with another checksum was unpacked"
echo "all as promised"
