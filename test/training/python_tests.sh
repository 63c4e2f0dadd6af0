#!/usr/bin/env bash
# Tests of training/tests on the CPU, with this build's generator and the robot's exported model. With all packages there nothing may
# be skipped: a test that skips itself fails here.
# Usage: python_tests.sh BUILD_DIR PYTEST_ARGUMENTS...     Exit codes: pytest's; 77 where Python packages are missing
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
python=/usr/bin/python3 # as third_party/python-packages
packages=$(third_party/python-packages training --cached) || exit 77
missing=$("$python" -c 'import importlib.util as found; print(*(m for m in ("numpy", "pytest", "torch", "yaml") if not found.find_spec(m)))')
[ -z "$missing" ] || { echo "$python has no $missing; scripts/setup --checks installs them" >&2; exit 77; }

tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
"$1/bin/pmg_sil" --robot z1 --export-mjcf "$tmp/z1.xml" >/dev/null
export PMG_BATCH_LIBRARY=$1/lib/libpmg_batch.so PMG_ROBOT=config/robots/z1 PMG_MJCF=$tmp/z1.xml
export PYTHONPATH=training:$packages PYTHONDONTWRITEBYTECODE=1 OMP_NUM_THREADS=1
"$python" -m pytest -q -rs -p no:cacheprovider --basetemp "$tmp/pytest" "${@:2}" | tee "$tmp/said"
! grep -E '^SKIPPED|[0-9]+ skipped' "$tmp/said" >/dev/null || { echo "FAILED: a test skipped itself" >&2; exit 1; }
