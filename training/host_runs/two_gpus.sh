#!/usr/bin/env bash
# two_gpus.sh ITERATIONS LEARN EVAL : the whole block on a host of two GPUs, times in s after t0; run it by setsid. GPU 0: pmg, then pmg_seed_2;
# GPU 1: without_gco and single_gait side by side. Measures pmg while the others learn.
cd /tmp/pmg && . ./env.sh; t0=$(cat t0); left() { echo $((t0 + $1 - $(date +%s))); }
its=$1 learn=$2 end=$3
E="ev/bin/pmg_eval"; V="--variation randomization.yaml"
export_policy() { mkdir -p onnx; python3 -m pmg_train.export runs/$1/actor.pt --robot robot --out onnx/$1.onnx > onnx/$1.log 2>&1; }
go() { mkdir -p evals/$1; nice timeout $(( $(left $end) > 1 ? $(left $end) : 1 )) $E "${@:3}" --out evals/$1/$2 > evals/$1/$2.txt 2>&1 & }
p() { echo "--policy $2=onnx/$1.onnx"; }
ended() { for i in $(seq 3000); do [ -f runs/$1/exit_code ] && return; [ $(left $learn) -le 0 ] && break; sleep 1; done; kill $(cat runs/$1/pid); sleep 2; }
./launch.sh without_gco without_gco 1 1 $its; ./launch.sh single_gait single_gait 1 1 $its
./launch.sh pmg pmg 1 0 $its
ended pmg; ./launch.sh pmg_seed_2 pmg 2 0 $its
export_policy pmg
go z steady steady $(p pmg pmg) --jobs 4
go z gait gait $(p pmg pmg) --jobs 1
go z push push $(p pmg pmg) --strengths 35,50 --jobs 8
go z jumps jumps $(p pmg pmg) $V --jobs 4
go z pmg_table1 table1 $(p pmg pmg) $V --jobs 8
ended without_gco; ended single_gait; ended pmg_seed_2
for r in pmg_seed_2 without_gco single_gait; do export_policy $r & done
while pgrep -f pmg_train.export > /dev/null; do sleep 1; done
touch learned
go z table1 table1 $(p pmg pmg) $(p without_gco without_gco) $(p single_gait single_gait) $V --jobs 14
go seed_2 table1 table1 $(p pmg_seed_2 pmg) $V --jobs 10
go seed_2 steady steady $(p pmg_seed_2 pmg) --jobs 4
go z gentle table1 $(p pmg pmg) $(p without_gco without_gco) $(p single_gait single_gait) --scenario table1 $V --jobs 8
go z robust robust $(p pmg pmg) --jobs 8
wait; touch done
