#!/usr/bin/env bash
# Trains on this host's GPUs, side by side: the three policies of config/robots/*/policies, and pmg a second time with another seed. The
# runs share the GPUs evenly and outlive the shell that started them. What OUT holds already goes on where it ended.
#   train_policies.sh start OUT MINUTES [TRAIN_OPTION...]   in the unpacked bundle, after `. ./env.sh`; options as of pmg_train.train
#   train_policies.sh show OUT                              each run's last line; exit code 0: all ended, 1: some still run, 2: one failed
#   train_policies.sh stop OUT                              ends the runs; each saves before (wait with `show`)
# RUNS="NAME:VARIANT:SEED ..." and GPUS=N (0: none) override which runs and how many GPUs.
set -euo pipefail
if [[ $# -lt 2 || ! $1 =~ ^(start|show|stop)$ || ( $1 == start && $# -lt 3 ) ]]; then sed -n '2,7s/^# \{0,1\}//p' "$0"; exit 2; fi
verb=$1 out=$2
: "${RUNS:=pmg:pmg:1 without_gco:without_gco:1 single_gait:single_gait:1 pmg_seed_2:pmg:2}"
: "${PYTHON:=python3}"

alive() { [[ -e $out/$1/pid && ! -e $out/$1/exit_code ]] && kill -0 "$(<"$out/$1/pid")" 2>/dev/null; }

start() {
  local minutes=$1 gpus=${GPUS:-$("$PYTHON" -c "import torch; print(torch.cuda.device_count())")} i=0 run name variant seed
  shift
  for run in $RUNS; do
    IFS=: read -r name variant seed <<<"$run"
    mkdir -p "$out/$name"
    if alive "$name"; then echo "$name runs already"; continue; fi
    local more=()
    [[ -e $out/$name/last.pt ]] && more=(--resume)
    rm -f "$out/$name/exit_code"
    ((gpus)) && export CUDA_VISIBLE_DEVICES=$((i++ % gpus))
    # A session of its own: the run outlives this shell and what started it.
    setsid bash -c 'trap "[[ -z \${child-} ]] || kill -TERM \$child" INT TERM
      "$@" & child=$!
      while kill -0 $child 2>/dev/null; do wait $child; done  # a signal interrupts the waiting
      wait $child; echo $? >"$0/exit_code"' \
      "$out/$name" "$PYTHON" -m pmg_train.train --robot robot --mjcf robot.xml --library lib/libpmg_batch.so --variant "$variant" --seed "$seed" \
      --out "$out/$name" --minutes "$minutes" "${more[@]}" "$@" >>"$out/$name/log" 2>&1 </dev/null &
    echo $! >"$out/$name/pid"
    echo "$name: $variant, seed $seed${CUDA_VISIBLE_DEVICES:+, GPU $CUDA_VISIBLE_DEVICES}"
  done
}

show() {
  local run name code=0
  for run in $RUNS; do
    name=${run%%:*}
    local state=running
    if [[ -e $out/$name/exit_code ]]; then
      state="ended with $(<"$out/$name/exit_code")"
      [[ $state == "ended with 0" ]] || code=2
    elif alive "$name"; then
      ((code == 2)) || code=1
    else
      state="not started or killed" code=2
    fi
    echo "$name ($state): $(tail -n 1 "$out/$name/log" 2>/dev/null)"
  done
  return $code
}

stop() {
  local run name
  for run in $RUNS; do
    name=${run%%:*}
    if alive "$name"; then kill -TERM "$(<"$out/$name/pid")"; fi
  done
}

case $verb in
  start) shift 2; start "$@" ;;
  *) "$verb" ;;
esac
