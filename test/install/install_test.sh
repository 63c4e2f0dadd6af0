#!/usr/bin/env bash
# What cmake --install makes, moved to another folder: a robot walks there, examples/embed builds against it and runs, pages and completions
# are there. And the source tree within another project.
# Usage: install_test.sh BUILD COMPILER
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
build=$(cd "$1" && pwd) compiler=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() {
  echo "FAILED: $*"
  exit 1
}
quiet() { "$@" >"$work/log" 2>&1 || { cat "$work/log"; fail "$*"; }; }

quiet cmake --install "$build" --prefix "$work/first"
mv "$work/first" "$work/moved"
prefix=$work/moved
cd "$work" # no path of the source tree helps

for program in "$prefix"/bin/*; do
  name=$(basename "$program")
  "$program" --version >"$work/log" 2>&1 || { cat "$work/log"; fail "$name does not start"; }
  runpath=$(readelf -d "$program" | sed -n 's/.*R[UN]*PATH.*\[\(.*\)\]/\1/p')
  [[ $runpath =~ ^\$ORIGIN/\.\./lib[^:]*$ ]] || fail "$name looks for its libraries in: $runpath"
  ! grep -qF "$root" "$program" || fail "$name names the source tree: $(strings "$program" | grep -F "$root" | head -3)"
  for file in share/man/man1/$name.1.gz share/bash-completion/completions/$name share/zsh/site-functions/_$name share/fish/vendor_completions.d/$name.fish; do
    [ -s "$prefix/$file" ] || fail "no $file"
  done
done

# One second of the demo, from a folder without any of its files.
printf 'name: short\nsteps:\n  - {for_s: 1.0, text: stands, mode: stand}\n' >short.yaml
"$prefix/bin/pmg_sil" --robot z1 --policy pmg --scenario short.yaml --out run >log 2>&1 || { cat log; fail "pmg_sil in the moved prefix"; }
[ -s run/summary.json ] || fail "pmg_sil left no summary"
"$prefix/bin/pmg_sil" --robot z1 --scenario tuor --out run >log 2>&1 && fail "an unknown scenario was played"
grep -q "scenario 'tuor' is neither known nor a file; did you mean tour?" log || { cat log; fail "the scenarios of the prefix are not found by name"; }
PMG_CONFIG=$work/nowhere "$prefix/bin/pmg_sil" --robot z1 --scenario short.yaml --out run >log 2>&1 && fail "PMG_CONFIG is not heeded"
grep -q "PMG_CONFIG: '$work/nowhere' isn't a folder" log || { cat log; fail "PMG_CONFIG is not heeded"; }

# Completion: an option of a subcommand, the values of an option.
completed() { # words
  bash -c 'source "$1"; COMP_WORDS=("${@:2}"); COMP_CWORD=$(($# - 2)); "_$2"; echo "${COMPREPLY[*]}"' _ "$prefix/share/bash-completion/completions/$1" "$@"
}
[ "$(completed pmg_eval table1 --sc)" = --scenario ] || fail "pmg_eval table1 --sc completes as: $(completed pmg_eval table1 --sc)"
[ "$(completed pmg_sil --blend pa)" = paper ] || fail "pmg_sil --blend pa completes as: $(completed pmg_sil --blend pa)"
[ "$(completed pmg_log rep)" = replay ] || fail "pmg_log rep completes as: $(completed pmg_log rep)"

# The package of the prefix.
cp -r "$root/examples/embed" "$work/embed"
quiet cmake -S embed -B embed/build -G Ninja "-DCMAKE_CXX_COMPILER=$compiler" "-DCMAKE_PREFIX_PATH=$prefix" "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror"
quiet cmake --build embed/build
embed/build/embed >walked
[ "$(wc -l <walked)" = 200 ] || fail "examples/embed printed $(wc -l <walked) lines"
python3 - walked <<'PY' || fail "examples/embed does not walk"
import sys
rows = [[float(x) for x in line.split()] for line in open(sys.argv[1])]
knee = [row[2] for row in rows]
sys.exit(0 if max(knee) - min(knee) > 0.3 else 1)
PY

# The tree within another project: include alone, and the whole as FetchContent takes it. C++20 comes with the targets, a type of build does not.
mkdir within
cat >within/CMakeLists.txt <<TXT
cmake_minimum_required(VERSION 3.22)
project(within LANGUAGES CXX)
if(ALONE)
  add_subdirectory($root/include generator)
  add_library(user OBJECT user.cpp)
  target_link_libraries(user PRIVATE pmg::generator)
else()
  include(FetchContent)
  FetchContent_Declare(pmg SOURCE_DIR $root)
  FetchContent_MakeAvailable(pmg)
  add_library(user OBJECT user.cpp)
  target_link_libraries(user PRIVATE pmg::clips)
  if(CMAKE_BUILD_TYPE OR TARGET pmg_sil)
    message(FATAL_ERROR "the project around it gets a type of build, or programs")
  endif()
endif()
TXT
printf '#include <pmg/phase.hpp>\nstatic_assert(__cplusplus >= 202002L);\n' >within/user.cpp
for alone in ON OFF; do
  quiet cmake -S within -B "within/$alone" -G Ninja "-DCMAKE_CXX_COMPILER=$compiler" -DALONE=$alone
  quiet cmake --build "within/$alone" --target user
done
echo "all as promised"
