#!/usr/bin/env bash
# examples/fit.cpp finds what robot.yaml says of a simulated knee: within 3 % its gains, within 10 % friction and damping.
# Usage: example_fit_test.sh BIN
set -euo pipefail
bin=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$bin/pmg_calibrate_motor" --make-excitation --robot z1 --joint left_knee --angle 0.1:1.3 --seconds 4 --out "$work/excitation" >/dev/null
"$bin/pmg_sil" --robot z1 --bench left_knee --excitation "$work/excitation" --out "$work/knee" >/dev/null
"$bin/example_fit" "$work/knee" | tee "$work/fit"
near() { # name, value, tolerance
  awk -v n="$1" -v v="$2" -v t="$3" '$1 == n { found = 1; if (($2 - v) ^ 2 > (t * v) ^ 2) { print n, $2, "instead of", v; bad = 1 } } END { exit bad || !found }' "$work/fit" ||
    { echo "FAILED: $1"; exit 1; }
}
near friction.viscous_Nm_s_per_rad 0.3 0.10
near friction.coulomb_Nm 0.6 0.10
near drive.kp_scale 1.0 0.03
near drive.kd_scale 1.0 0.03
! grep -q inf "$work/fit" || { echo "FAILED: these runs tell every parameter"; exit 1; }
[ "$("$bin/example_fit" "$work/nothing" 2>&1 >/dev/null | wc -l)" = 1 ] || { echo "FAILED: a folder that isn't there is one line"; exit 1; }
