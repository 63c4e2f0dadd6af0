#!/usr/bin/env bash
# examples/backend built from a copy outside this tree against this build, and run: nothing of the project is built again or changed.
# Usage: own_backend_test.sh BUILD COMPILER
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
build=$(cd "$1" && pwd) compiler=$2
work=$(mktemp -d)
board=
trap '[ -z "$board" ] || kill $board 2>/dev/null || true; rm -rf "$work"' EXIT
cp -r "$root/examples/backend" "$work/own"
cmake -S "$work/own" -B "$work/build" -G Ninja -DCMAKE_CXX_COMPILER="$compiler" -Dpmg_DIR="$build" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
cmake --build "$work/build" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
export PMG_CONFIG=$root/config # its binary is outside build tree and prefix
cd "$root"
run=("$work/build/own_controller" --robot z1 --hal udp --lcm-url memq:// --no-log --no-realtime --policy none)
failed=0
check() { # what, pattern, file
  grep -qE "$2" "$3" && return
  printf 'FAILED: %s: no line has "%s" in:\n' "$1" "$2"
  cat "$3"
  failed=1
}
lines=$(grep -vcE '^\s*(//.*)?$' "$root/examples/backend/udp_backend.cpp")
[ "$lines" -le 100 ] || { echo "FAILED: the backend has $lines lines of code, expected 100 at most"; failed=1; }
"$work/build/own_controller" --help >"$work/help"
check "help names it beside the others" 'can, drives on CAN buses.*udp, drives on a board' <(tr -s ' \n' ' ' <"$work/help")
python3 "$root/examples/backend/board.py" >"$work/board" 2>&1 &
board=$!
until [ -s "$work/board" ]; do sleep 0.1; kill -0 $board || { cat "$work/board"; exit 1; }; done
port=$(head -1 "$work/board")
code=0
"${run[@]}" --board-port "$port" --duration 2 >"$work/out" 2>&1 || code=$?
[ $code = 0 ] || { echo "FAILED: exit code $code"; cat "$work/out"; failed=1; }
check "it runs" 'mode: passive' "$work/out"
kill $board
wait $board || true
board=
check "the board got commands, none of them stiff" '^[0-9]{3,} commands, 0 with stiffness' "$work/board"
code=0
"${run[@]}" --board-port "$port" --duration 2 >"$work/out" 2>&1 || code=$?
[ $code = 2 ] || { echo "FAILED: without a board: exit code $code, expected 2"; failed=1; }
check "a board that is silent is one line" '^pmg_controller: the board does not answer' "$work/out"
tail -1 "$work/board"
exit $failed
