#!/usr/bin/env bash
# pmg_bus and pmg_controller --hal can as a user runs them, against emulated drives on real CAN interfaces. Run by test/can/canrun.
# Usage: programs_test.sh BIN
set -uo pipefail
bin=$1
source "$(dirname "${BASH_SOURCE[0]}")/../apps/expect_program.bash"
check "no drive answers" 1 'left_hip_pitch \(can0, node 1\) does not answer' "$bin/pmg_bus" scan --robot z1
check "the controller refuses" 2 '^pmg_controller: left_hip_pitch \(can0, node 1\) does not answer.*\(30 more: pmg_bus scan\)' \
  "$bin/pmg_controller" --hal can --robot z1 --lcm-url memq:// --no-log --no-realtime
"$bin/pmg_emulated_drives" --robot z1 --gantry --faults /run/faults >/run/drives.out 2>&1 &
drives=$!
until grep -q answer /run/drives.out; do sleep 0.1; kill -0 $drives || { cat /run/drives.out; exit 1; }; done
check "every drive answers" 0 'left_knee +can0 +4 .*no fault' "$bin/pmg_bus" scan --robot z1
if command -v setpriv >/dev/null; then # a kernel's CAN sockets are open to everybody
  check "without CAP_NET_RAW" 0 'left_knee +can0 +4 .*no fault' setpriv --bounding-set -net_raw --inh-caps -net_raw "$bin/pmg_bus" scan --robot z1
fi
fault() { # line for the drives, what they say to it
  echo "$1" >/run/faults
  until grep -qF "$2" /run/drives.out; do sleep 0.1; kill -0 $drives || { cat /run/drives.out; exit 1; }; done
}
fault "left_knee over-current" "left_knee: over-current"
check "a fault on demand" 1 'left_knee +can0 +4 .*over-current' "$bin/pmg_bus" scan --robot z1
fault "left_knee wel" "'left_knee wel': expected one word after left_knee: silent, twice"
fault "left_knee well" "left_knee: well"
fault "right_knee silent" "right_knee: silent"
check "a silent drive on demand" 1 'right_knee \(can1, node 4\) does not answer' "$bin/pmg_bus" scan --robot z1
fault "right_knee well" "right_knee: well"
check "both are well again" 0 'left_knee +can0 +4 .*no fault' "$bin/pmg_bus" scan --robot z1
check "one drive is enabled" 0 'left_knee was enabled without a command and disabled again' "$bin/pmg_bus" enable left_knee --robot z1
check "zero needs a yes" 2 'expected --yes' "$bin/pmg_bus" zero left_knee --robot z1
check "zero" 0 'left_elbow: was .* deg, is -?0.0. deg now' "$bin/pmg_bus" zero left_elbow --yes --robot z1
check "an unknown joint" 2 "^pmg_bus: 'left_kne' isn't a joint; did you mean left_knee" "$bin/pmg_bus" enable left_kne --robot z1
("$bin/pmg_bus" scan --robot z1 >/dev/null; "$bin/pmg_bus" scan --robot z1 >/dev/null) &
check "a recording" 0 '^\([0-9]+\.[0-9]{6}\) can4 021#[0-9A-F]{16}$' "$bin/pmg_bus" dump --for 1 --robot z1
wait $!
"$bin/pmg_bus" watch --for 60 --robot z1 >/dev/null &
watching=$!
"$bin/pmg_bus" dump --for 60 --robot z1 >/run/dump &
dumping=$!
until grep -q ' can4 005#' /run/dump; do sleep 0.1; kill -0 $watching || exit 1; done # it asks
kill $dumping
check "one program drives a bus" 2 '^pmg_bus: can0: pmg_bus \(process [0-9]+\) drives it; expected nobody else' "$bin/pmg_bus" scan --robot z1
check "others listen" 0 'left_knee +can0 +4 .*no fault' "$bin/pmg_bus" watch --for 1 --robot z1
kill $watching
wait $watching
ip link set can2 down
check "a bus that is down" 2 '^pmg_bus: can2: is down; expected it up' "$bin/pmg_bus" scan --robot z1
ip link del can2
check "a missing interface" 2 '^pmg_controller: can2: no such interface' "$bin/pmg_controller" --hal can --robot z1 --lcm-url memq:// --no-log --no-realtime
kill $drives
wait $drives
[ $failed = 0 ] && echo "all programs did as promised"
exit $failed
