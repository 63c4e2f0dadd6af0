#!/usr/bin/env bash
# third_party/npm-packages and third_party/python-packages: without a network they say what is missing and leave nothing half-made; what is
# there is enough. An npm of our own stands in for the network: it fails halfway, or brings what the pins name.
set -euo pipefail
source=$1
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
mkdir "$tmp/bin"
fail() { echo "FAILED: $*"; exit 1; }
packages() { XDG_CACHE_HOME=$tmp/cache PIP_NO_INDEX=1 PIP_FIND_LINKS='' PATH="$tmp/bin:$PATH" "$source/third_party/$@" 2>"$tmp/said"; }
nothing_is_left() { [ -z "$(find "$tmp/cache" -mindepth 2 2>/dev/null)" ] || fail "$1: something was left: $(find "$tmp/cache")"; }
npm_does() { printf '#!/bin/sh\nmkdir "$3/node_modules"\n%s\n' "$1" >"$tmp/bin/npm"; chmod +x "$tmp/bin/npm"; }

npm_does 'exit 1'
for what in npm-packages "python-packages tools"; do
  # shellcheck disable=SC2086 # two words
  packages $what --cached && fail "$what: an empty cache must be an error"
  grep -q "aren't there yet: run third_party/$what" "$tmp/said" || fail "$what: the remedy isn't said: $(cat "$tmp/said")"
  # shellcheck disable=SC2086
  packages $what && fail "$what: what can't be obtained must be an error"
  grep -q "could not obtain" "$tmp/said" || fail "$what: the message doesn't say what is wrong: $(cat "$tmp/said")"
  nothing_is_left "$what"
done

npm_does 'echo brought; exit 0'
folder=$(packages npm-packages) || fail "what was obtained must be enough: $(cat "$tmp/said")"
[ -f "$folder/package-lock.json" ] && [ -d "$folder/node_modules" ] || fail "not the packages' folder: $folder"
[ "$(find "$tmp/cache/pmg-npm" -mindepth 1 -maxdepth 1)" = "$folder" ] || fail "more than the folder was left"
npm_does 'exit 1'
[ "$(packages npm-packages --cached)" = "$folder" ] || fail "what is there must be enough"
packages python-packages nonsense && fail "a set that isn't there must be an error"
grep -q "no set 'nonsense'" "$tmp/said" || fail "the wrong set isn't named"
echo "all as promised"
