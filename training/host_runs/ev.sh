#!/usr/bin/env bash
# ev.sh NAME... : exports each run's actor.pt and measures it
cd /tmp/pmg && . ./env.sh
mkdir -p onnx evals
for n in "$@"; do
  python3 -m pmg_train.export runs/$n/actor.pt --robot robot --out onnx/$n.onnx > onnx/$n.log 2>&1 || { tail -3 onnx/$n.log; continue; }
  E="ev/bin/pmg_eval" P="--policy pmg=onnx/$n.onnx" O=evals/$n; mkdir -p $O
  J=${J:-12}
  $E steady $P --jobs $J --out $O/steady > $O/steady.txt 2>&1 &
  $E table1 $P --jobs $J --variation randomization.yaml --out $O/table1 > $O/table1.txt 2>&1 &
  $E jumps $P --jobs $J --variation randomization.yaml --out $O/jumps > $O/jumps.txt 2>&1 &
  $E push $P --jobs $J --strengths 35,50 --out $O/push > $O/push.txt 2>&1 &
  $E gait $P --jobs 1 --out $O/gait > $O/gait.txt 2>&1 &
  if [ -n "${SERIAL:-}" ]; then wait; fi
done
wait
for n in "$@"; do echo "===== $n"; for f in steady table1 jumps push gait; do echo "-- $f"; grep -v '^$' evals/$n/$f.txt | cut -c1-150 | head -${LINES_MAX:-40}; done; done
