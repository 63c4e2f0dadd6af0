#!/usr/bin/env bash
# For tests of programs, which source it: check runs a program; failed is 1 once one did other than promised.
failed=0
check() { # what, expected exit code, pattern, command...
  local what=$1 expected=$2 pattern=$3 out code
  shift 3
  out=$("$@" 2>&1)
  code=$?
  if [ "$code" != "$expected" ] || ! grep -qE "$pattern" <<<"$out"; then
    printf 'FAILED: %s: exit code %s, expected %s; no line has "%s" in:\n%s\n' "$what" "$code" "$expected" "$pattern" "$out"
    failed=1
  fi
}
