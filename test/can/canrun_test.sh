#!/usr/bin/env bash
# What canrun makes of a user-mode Linux: a test is skipped only where the kernel can't start, and what fails in one that started fails. The
# kernel is a script here, which does what the case says.
# Usage: canrun_test.sh
# Exit codes: 0, 1 a promise is broken
set -uo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/usr/bin" "$work/bin"
cat >"$work/usr/bin/linux.uml" <<'KERNEL'
#!/usr/bin/env bash
for word; do case $word in init=*) init=${word#init=} ;; esac; done
folder=${init%/*} init=${init##*/}
amx() { echo "userspace - ptrace set fp regs failed, errno = 14"; }
panic() { echo "Kernel panic - not syncing: Attempted to kill init!"; kill -ABRT $$; }
begin() {
  echo >"$folder/begun"
  [ "$init" = init ] || exit 0
  [ "$CASE" != dies ] || panic
  bash "$folder/command" >"$folder/out" 2>"$folder/err" </dev/null
  echo $? >"$folder/code"
}
echo "Failed to initialize ubd device 0"
case $CASE in
panics) panic ;;
no_init) if [ "$init" = init ]; then panic; else begin; fi ;;
amx) if [ -n "$LD_PRELOAD" ]; then begin; else amx; panic; fi ;;
amx_for_good) amx; panic ;;
*) begin ;;
esac
KERNEL
printf '#!/bin/sh\nexit 1\n' >"$work/bin/ip" # this kernel has no CAN
cp "$work/bin/ip" "$work/bin/busybox"
chmod +x "$work/usr/bin/linux.uml" "$work/bin/ip" "$work/bin/busybox"
failed=0
check() { # what the kernel does, exit code, pattern in what canrun says, command...
  local said code
  said=$(CASE=$1 CANROOT=$work PATH=$work/bin:$PATH "$here/canrun" "${@:4}" 2>&1)
  code=$?
  [ "$code" = "$2" ] && grep -qE "$3" <<<"$said" && return
  printf 'FAILED: %s, %s: exit code %s, expected %s and "%s" in:\n%s\n' "$1" "${*:4}" "$code" "$2" "$3" "$said"
  failed=1
}
check works 0 '^said$' echo said
check works 5 '^said$' bash -c 'echo said; exit 5'
check works 137 '' bash -c 'kill -9 $$'
check works 99 '' bash -c 'exit 99'
check panics 77 "^canrun: SKIPPED: user-mode Linux can't start on this computer: Kernel panic - not syncing: " true
check amx_for_good 77 "^canrun: SKIPPED: .*: userspace - ptrace set fp regs failed, errno = 14$" true
check amx 0 '^said$' echo said
check amx 5 '' bash -c 'exit 5'
check dies 99 'Kernel panic' true
check no_init 99 '^canrun: FAILED: user-mode Linux starts here, and the command never began' true
[ $failed = 0 ] && echo "canrun did as promised"
exit $failed
