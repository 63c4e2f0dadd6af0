#!/usr/bin/env bash
# The emulated drives against hosts that this project did not write (third_party/python/foreign_can.txt): what the tests of this project's
# client believe of a drive must be what these hosts believe of one. Each switches the left elbow on, reads it, moves it, and switches it off.
# Usage: foreign_hosts_test.sh BIN      (PMG_CAN_HOSTS="damiao cia402": those hosts alone)
# Exit codes: 0, 1 a host and the emulator differ, 77 the packages or a kernel with CAN are missing (the test is skipped)
set -uo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
bin=$1
if [ -z "${2:-}" ]; then
  packages=$("$here/../../third_party/python-packages" foreign_can --cached) || exit 77
  exec "$here/canrun" "$here/foreign_hosts_test.sh" "$bin" "$packages"
fi
export PYTHONPATH=$2:$here PYTHONDONTWRITEBYTECODE=1
failed=0
# Ranges are those of the motor that the host takes it for.
drive_of() {
  case $1 in
  cubemars) echo '{protocol: cubemars, position_rad: 12.5, velocity_rad_s: 50, torque_Nm: 65, kp_Nm_per_rad: 500, kd_Nm_s_per_rad: 5}' ;;
  mini_cheetah) echo '{protocol: mini_cheetah, position_rad: 12.5, velocity_rad_s: 22.5, torque_Nm: 65, kp_Nm_per_rad: 500, kd_Nm_s_per_rad: 5}' ;;
  damiao*) echo '{protocol: damiao, reply_id: 112, position_rad: 12.5, velocity_rad_s: 45, torque_Nm: 54, kp_Nm_per_rad: 500, kd_Nm_s_per_rad: 5}' ;;
  cia402)
    echo '{protocol: cia402, mode: position, counts_per_turn: 65536, velocity_unit_rad_s: 0.001, rated_torque_Nm: 40, torque_Nm: 60,' \
      'kp_Nm_per_rad: 60, kd_Nm_s_per_rad: 2}'
    ;;
  esac
}
for host in ${PMG_CAN_HOSTS:-cubemars mini_cheetah damiao damiao_motorbridge cia402}; do
  robot=/run/$host
  cp -r config/robots/z1 "$robot"
  # Its bus is can0, which some of these hosts have built in, with room for a CANopen drive's frames; the others of that bus keep clear of CANopen's identifier 0.
  sed -i -e 's/name: can0/name: a_leg/' -e 's/name: can2/name: can0/' -e 's/name: a_leg/name: can2/' \
    -e '/^  left_wrist_pitch:/s/name: can0/name: can2/' \
    -e 's/arm: {protocol: mit,/arm: {protocol: mit, reply_id: 126,/' -e '/^  left_elbow:/s/drive: arm/drive: elbow/' \
    -e "/^drives:/a\\  elbow: $(drive_of $host)" "$robot/robot.yaml"
  # A loaded computer's host is late, and its drive would let go.
  "$bin/pmg_emulated_drives" --robot "$robot" --gantry --patience 100 >"/run/drives.out" 2>&1 &
  drives=$!
  until grep -q answer /run/drives.out; do sleep 0.1; kill -0 $drives || { cat /run/drives.out; exit 1; }; done
  for _ in 1 2 3 4 5; do # a drive that is late is silent, for pmg_bus
    angle=$("$bin/pmg_bus" scan --robot "$robot" 2>&1 | sed -nE 's/^left_elbow +can0 +4 +(-?[0-9.]+) deg .*/\1/p')
    [ -n "$angle" ] && break
  done
  if [ -z "$angle" ]; then
    echo "FAILED: $host: pmg_bus does not find the emulated drive"
    failed=1
  elif said=$(timeout 280 /usr/bin/python3 "$here/foreign_hosts.py" "$host" "$angle" 2>&1); then
    sed "s/^/$host: /" <<<"$said"
  else
    printf 'FAILED: %s, and the emulated drive, which is at %s deg:\n%s\n' "$host" "$angle" "$said"
    failed=1
  fi
  kill $drives && wait $drives
done
[ $failed = 0 ] && echo "each host drove its drive"
exit $failed
