#!/usr/bin/env bash
# Usage: foxglove_client_test.bash FOLDER_OF_PROGRAMS; exit codes: foxglove_client_test.mjs', and 77 where node or its packages can't be had
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
command -v node > /dev/null || { echo "no node: scripts/setup --slow" >&2; exit 77; }
packages=$("$here/../../third_party/npm-packages") || exit 77
exec node "$here/foxglove_client_test.mjs" "$1" "$packages"
