#!/usr/bin/env bash
# The bring-up of docs/how-to/hal.md, command by command, on a robot with drives of both protocols on two buses that somebody wrote down by
# hand (bring_up_robot.yaml), against emulated drives on real CAN interfaces; then the mistakes that a bring-up is there to find. Run by
# test/can/canrun. It is in real time, and the drives' watchdogs are patient: a loaded computer leaves programs waiting for longer than 20 ms.
# Usage: bring_up_test.sh BIN
# Exit codes: 0, 1 a step shows something else
set -uo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
bin=$1
work=$(mktemp -d)
drives=
trap '[ -z "$drives" ] || kill $drives 2>/dev/null; rm -rf "$work"' EXIT
failed=0
robot() { # name [sed expressions for robot.yaml...]
  mkdir -p "$work/$1"
  cp "$here/../data/robots/biped/biped.urdf" "$work/$1/"
  sed "${@:2}" -e '' "$here/bring_up_robot.yaml" >"$work/$1/robot.yaml"
}
begin() { # name of the robot that is there
  "$bin/pmg_emulated_drives" --robot "$work/$1" --gantry --patience 50 >"$work/drives" 2>&1 &
  drives=$!
  until grep -q answer "$work/drives"; do sleep 0.1; kill -0 $drives || { cat "$work/drives"; exit 1; }; done
}
end() {
  kill $drives
  wait $drives
  drives=
}
step() { # what, expected exit code (or several, as a pattern), pattern..., --, command...: each pattern is in a line
  local what=$1 expected=$2 patterns=() out code pattern
  shift 2
  while [ "$1" != -- ]; do patterns+=("$1"); shift; done
  shift
  out=$("$@" 2>&1)
  code=$?
  for pattern in "${patterns[@]}"; do
    grep -qE -- "$pattern" <<<"$out" && continue
    printf 'FAILED: %s: no line has "%s" in:\n%s\n' "$what" "$pattern" "$out"
    failed=1
  done
  [[ $code =~ ^($expected)$ ]] && return
  printf 'FAILED: %s: exit code %s, expected %s:\n%s\n' "$what" "$code" "$expected" "$out"
  failed=1
}
bus() { # subcommand and its options, on the robot as it is written down
  "$bin/pmg_bus" "$@" --robot "$work/${described:-right}"
}
robot right
step "nobody is powered" 1 'waist_pitch \(can0, node 1\) does not answer' 'right_hip_yaw \(can1, node 1\) does not answer' -- bus scan
begin right
step "scan" 0 '^can0: 4 motors, 13 frames a cycle, at most [0-9]+ % of the bus' '^can1: 7 motors and the IMU, 17 frames a cycle' \
  '^can0: 122 other nodes were asked, and CANopen.s up to 127; 0 of them answered' '^can1: 117 other nodes were asked; 0 of them answered' \
  'waist_pitch +can0 +1 .* deg .* Nm +- degC  no fault' 'left_knee +can0 +3 .* Nm +35 degC  no fault' 'left_ankle_pitch +can0 +4 .*no fault' \
  'right_knee +can1 +4 .*no fault' -- bus scan
step "watch" 0 'left_hip_pitch +can0 +2 .*no fault' -- bus watch --for 0.5
for joint in left_knee waist_pitch left_ankle_pitch right_knee; do # torque mode, position mode, MIT beside them, MIT with CAN FD
  step "enable $joint" 0 "^$joint was enabled without a command and disabled again: .* deg, no fault" -- bus enable $joint
done
step "zero needs a yes" 2 'expected --yes' -- bus zero right_hip_roll
step "zero of an MIT drive" 0 '^right_hip_roll: was .* deg, is -?0\.0. deg now' -- bus zero right_hip_roll --yes
step "zero of a CiA 402 drive is robot.yaml's" 0 'left_hip_pitch is at .* deg\. .* write `zero_offset_rad: -?[0-9.]+` into its `bus`' -- \
  bus zero left_hip_pitch --yes
for joint in left_hip_pitch waist_pitch left_ankle_pitch right_knee; do
  step "wiggle $joint" '0|3' "^$joint moves by 3.0 deg there and back. For \+ the model's limb goes: " \
    'asked 3\.00 deg, moved [1-4]\.[0-9]+ deg; .*(agrees? with the model|too small to tell)' -- bus wiggle $joint --by 3
done
step "wiggle as far as it tells" '0|3' '^left_hip_pitch moves by [0-9.]+ deg there and back' -- bus wiggle left_hip_pitch
"$bin/pmg_bus" dump --robot "$work/right" >"$work/dump" &
dumping=$!
until [ -s "$work/dump" ]; do sleep 0.1; kill -0 $dumping || break; done # it listens
bus scan >/dev/null
bus enable left_knee >/dev/null
until grep -q ' can1 021#' "$work/dump"; do sleep 0.1; kill -0 $dumping || break; done
kill $dumping
wait $dumping
for pattern in ' can0 603#40001000' ' can0 583#' ' can0 080#$' ' can0 203#' ' can0 183#' ' can0 283#' ' can0 07E#04' ' can1 001##1FFFFFFFFFFFFFFFD' \
  ' can1 000##101' ' can1 021#'; do # SDO, its answer, SYNC, the PDOs; an MIT reply; the same with CAN FD; the IMU
  grep -qE "^\([0-9]+\.[0-9]{6}\)$pattern" "$work/dump" && continue
  printf 'FAILED: dump: no frame is like "%s" in:\n' "$pattern"
  cut -d' ' -f2- "$work/dump" | sort | uniq -c | sort -rn | head -40
  failed=1
done
end

# What is written down wrong, or wired wrong.
robot torque -e '/^  torque:/s/rated_torque_Nm: 20/rated_torque_Nm: 25/'
robot reply -e '/^  beside:/s/reply_id: 126/reply_id: 125/'
robot nodes -e '/^  left_knee:/s/node: 3/node: 9/' -e '/^  right_knee:/s/node: 4/node: 9/'
rods='linkages: [{joints: [right_ankle_pitch], motors: [{crank_centre_m: [0, 0, 0.3], axis: [0, 1, 0], crank_end_m: [0.05, 0, 0.3], rod_end_m: [0.05, 0, 0]}]}]'
robot rods -e "\$a $rods"
begin right
described=torque step "another drive" 1 'left_knee \(can0, node 3\): object 0x6076 \(rated torque\) is 20 Nm; expected rated_torque_Nm 25' -- bus scan
described=reply step "another reply identifier" 1 'left_ankle_pitch \(can0, node 4\) does not answer' \
  "can0: heard identifier 0x7E with 8 bytes, .*an answer of left_ankle_pitch with another identifier; robot.yaml's .reply_id. should be 0x7E" -- bus scan
described=nodes step "another node" 1 'left_knee \(can0, node 9\) does not answer' \
  'can0: somebody answers as node 3 \(CANopen device type 0x00020192: profile 402\)' 'right_knee \(can1, node 9\) does not answer' \
  'can1: somebody answers as node 4; ' -- bus scan
end
begin rods
described=rods step "a linkage" 0 'right_ankle_pitch +can1 +5 .*no fault  \(its crank\)' 'right_ankle_pitch +can1 +joint +-?[0-9.]+ deg' -- bus scan
described=rods step "wiggle through a linkage" '0|3' '^right_ankle_pitch moves there and back, its linkage' 'right_ankle_pitch: asked 3.00 deg, moved [1-4]' -- \
  bus wiggle right_ankle_pitch --by 3
described=rods step "a sole that may lie level" '0|1|3' '(puts the sole level|the sole lies as if|the sole.s angle can.t tell|agree with the model)' -- bus level right_ankle_pitch
described=rods step "no sole" 2 'waist_pitch is above no sole; expected a joint of a leg' -- bus level waist_pitch
end
[ $failed = 0 ] && echo "the bring-up went as the page says"
exit $failed
