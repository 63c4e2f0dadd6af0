#!/usr/bin/env bash
# pmg_controller --hal ethercat as a user runs it, against emulated slaves on the other end of a cable. Run by test/ethercat/cablerun.
# Usage: programs_test.sh BIN
set -uo pipefail
bin=$1
source "$(dirname "${BASH_SOURCE[0]}")/../apps/expect_program.bash"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$(dirname "${BASH_SOURCE[0]}")/bridged_z1" "$work/z1"
controller=("$bin/pmg_controller" --hal ethercat --robot "$work/z1" --lcm-url memq:// --no-log --despite-doctor)
check "no slave answers" 2 '^pmg_controller: ecat0: no EtherCAT slave answers; expected 5' "${controller[@]}"
"$bin/pmg_emulated_slaves" --robot "$work/z1" --interface ecat1 --gantry >"$work/slaves" 2>&1 &
slaves=$!
until grep -q answer "$work/slaves"; do sleep 0.1; kill -0 $slaves || { cat "$work/slaves"; exit 1; }; done
check "the controller drives" 0 'passive' "${controller[@]}" --duration 3
check "the doctor sees the card" 0 'ecat0' "$bin/pmg_controller" --hal ethercat --robot "$work/z1" --print-config
if command -v setpriv >/dev/null; then
  check "without CAP_NET_RAW" 2 '^pmg_controller: ecat0: no permission for raw sockets; expected CAP_NET_RAW' \
    setpriv --bounding-set -net_raw --inh-caps -net_raw "${controller[@]}"
fi
ip link set ecat0 down
check "an interface that is down" 2 '^pmg_controller: ecat0: is down; expected it up' "${controller[@]}"
kill $slaves
wait $slaves
ip link del ecat0
check "a missing interface" 2 '^pmg_controller: ecat0: no such interface' "${controller[@]}"
[ $failed = 0 ] && echo "all programs did as promised"
exit $failed
