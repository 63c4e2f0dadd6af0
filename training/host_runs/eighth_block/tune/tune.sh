#!/usr/bin/env bash
# tune.sh LEARN : from two policies' networks, other weights; LEARN: s after t0 when learning ends
cd /tmp/pmg && . ./env.sh; t0=$(cat t0); left() { echo $((t0 + $1 - $(date +%s))); }
g=0; for r in e1 e2 e3 e4; do i=last_pmgd.pt; [ $r = e3 ] && i=last_pmgc.pt
  EXTRA="--initial $i --randomization kicks_full.yaml" ./launch.sh $r pmg 1 $g 5000 $r.yaml; g=$((g + 1)); done
export OMP_NUM_THREADS=1
while [ $(left $1) -gt 0 ]; do sleep 0.5; done
for r in e1 e2 e3 e4; do tail -n 1 runs/$r/log | cut -c1-300; kill $(cat runs/$r/pid); done; sleep 3; mkdir -p onnx
for r in e1 e2 e3 e4; do python3 -m pmg_train.export runs/$r/actor.pt --robot robot --out onnx/$r.onnx > onnx/$r.log 2>&1 & done; wait
cp onnx/*.onnx $OUT/; E="env LD_LIBRARY_PATH=ev/lib/pmg ev/bin/pmg_eval"
for r in e1 e2 e3 e4; do timeout -s INT 60 $E table1 --policy pmg=onnx/$r.onnx --variation randomization.yaml --jobs 16 --out evals/$r > $OUT/table1_$r.txt 2>&1 & 
  timeout -s INT 60 $E gait --policy pmg=onnx/$r.onnx --jobs 1 --out evals/g$r > $OUT/gait_$r.txt 2>&1 & done; wait
for r in e1 e2 e3 e4; do tail -n 9 $OUT/table1_$r.txt; grep "flexion \|dorsi" $OUT/gait_$r.txt | tail -6; grep Walks $OUT/gait_$r.txt | cut -c1-60; done; cp runs/*/curve.csv $OUT/ 2>/dev/null; echo $(( $(date +%s) - t0 ))
