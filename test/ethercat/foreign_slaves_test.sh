#!/usr/bin/env bash
# The master against slaves that this project did not write: KickCAT's emulated slave controllers, its slave stack and its CiA 402 motor
# (program network_simulator, built in its folder `build`) on the other end of a cable.
# Usage: foreign_slaves_test.sh TEST_ETHERCAT
# Environment: PMG_KICKCAT is KickCAT's folder (default: out/KickCAT)
# Exit codes: 0, 1 a promise is broken, 77 KickCAT or a network namespace is missing (the test is skipped)
set -uo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
tests=$1
export PMG_KICKCAT=${PMG_KICKCAT:-$(cd "$here/../.." && pwd)/out/KickCAT}
if [ ! -x "$PMG_KICKCAT/build/simulation/network_simulator" ]; then
  echo "foreign_slaves_test: SKIPPED: no KickCAT in $PMG_KICKCAT (docs/how-to/hal.md says how to build it)" >&2
  exit 77
fi
failed=0
names=$("$tests" --gtest_list_tests --gtest_filter='ForeignSlaves.*' | sed -n 's/^  \([A-Za-z]*\).*/\1/p')
for promise in $names; do
  # Their watchdog of 20 ms runs in real time: where a loaded computer held the outputs up for so long, the same is tried again.
  for try in 1 2 3 4 5; do
    said=$("$here/cablerun" "$tests" --gtest_filter="ForeignSlaves.$promise" 2>&1)
    code=$?
    [ $code = 77 ] && { echo "$said"; exit 77; }
    grep -q '^held up' <<<"$said" || break
    echo "$promise: $(grep '^held up' <<<"$said") in try $try of 5"
  done
  if [ $code = 0 ] && grep -q '^\[  PASSED  \] 1 test' <<<"$said"; then
    echo "$promise: shown"
  else
    printf 'FAILED: %s\n%s\n' "$promise" "$said"
    failed=1
  fi
done
[ -n "$names" ] && [ $failed = 0 ] && echo "the foreign slaves were driven as promised" && exit 0
exit 1
