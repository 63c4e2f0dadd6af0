# quiet_step NAME LOG COMMAND...: runs a command and appends its output to a log file. One line shows the progress, as build step or seconds:
# renewed on a terminal, every ten seconds elsewhere. If the command fails, the log's last lines follow. Returns its status.
quiet_step() {
  local name=$1 log=$2 status
  shift 2
  set +e
  "$@" </dev/null 2>&1 | show_step "$name" "$log"
  status=${PIPESTATUS[0]}
  set -e
  if [ "$status" -ne 0 ]; then
    tail -n 15 "$log" | cut -c1-200
    echo "$name: failed ($status); all of its words are in $log" >&2
  fi
  return "$status"
}

show_step() { # name log: copies stdin to the log
  local name=$1 log=$2 start=$SECONDS shown=$SECONDS said="" line got terminal=no
  [ -t 1 ] && terminal=yes
  while true; do
    got=0
    IFS= read -r -t 1 line || got=$?
    if [ "$got" -gt 128 ]; then
      printf '%s' "$line" >>"$log" # no whole line within a second
    elif [ "$got" -eq 0 ]; then
      printf '%s\n' "$line" >>"$log"
      [[ $line =~ ^\[([0-9]+)/([0-9]+)\] ]] && said="${BASH_REMATCH[1]} of ${BASH_REMATCH[2]}, "
    else
      printf '%s' "$line" >>"$log"
      break
    fi
    if [ $terminal = yes ] && [ "$shown" -ne $SECONDS ]; then
      printf '\r%-60s' "$name: $said$((SECONDS - start)) s" && shown=$SECONDS
    elif [ $terminal = no ] && [ $((SECONDS - shown)) -ge 10 ]; then
      echo "$name: $said$((SECONDS - start)) s" && shown=$SECONDS
    fi
  done
  [ $terminal = no ] || printf '\r%-60s\r' ""
  echo "$name: ended after $((SECONDS - start)) s"
}
