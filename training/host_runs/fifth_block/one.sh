#!/usr/bin/env bash
# one.sh ITERATIONS LEARN END
cd /tmp/pmg && . ./env.sh; t0=$(cat t0); left() { echo $((t0 + $1 - $(date +%s))); }
./launch.sh pmg pmg 1 0 $1 config_x1.yaml; sleep 5
for i in $(seq 3000); do [ -f runs/pmg/exit_code ] && break; [ $(left $2) -le 0 ] && break; sleep 1; done
[ -f runs/pmg/exit_code ] || kill $(cat runs/pmg/pid); for i in 1 2 3 4 5 6; do [ -f runs/pmg/exit_code ] && break; sleep 1; done
mkdir -p onnx evals/pmg; python3 -m pmg_train.export runs/pmg/actor.pt --robot robot --out onnx/pmg.onnx > onnx/pmg.log 2>&1
touch learned; export OMP_NUM_THREADS=1
timeout $(left $3) ev/bin/pmg_eval gait --policy pmg=onnx/pmg.onnx --jobs 1 --out evals/pmg/gait > evals/pmg/gait.txt 2>&1 &
timeout $(left $3) ev/bin/pmg_eval table1 --policy pmg=onnx/pmg.onnx --variation randomization.yaml --jobs 14 --out evals/pmg/table1 > evals/pmg/table1.txt 2>&1 &
wait; touch done
