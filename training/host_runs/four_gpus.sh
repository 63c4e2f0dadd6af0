#!/usr/bin/env bash
# four_gpus.sh ITERATIONS LEARN END CONFIG : the whole block on a host of four GPUs, one run each, times in s after t0; run it by setsid.
# Learns until LEARN at the latest, measures until END.
cd /tmp/pmg && . ./env.sh; t0=$(cat t0); left() { echo $((t0 + $1 - $(date +%s))); }
its=$1 learn=$2 end=$3 config=$4
E="ev/bin/pmg_eval"; V="--variation randomization.yaml"
runs="pmg pmg_seed_2 without_gco single_gait"
./launch.sh pmg pmg 1 0 $its $config; ./launch.sh pmg_seed_2 pmg 2 1 $its $config
./launch.sh without_gco without_gco 1 2 $its $config; ./launch.sh single_gait single_gait 1 3 $its $config
sleep 5
for i in $(seq 3000); do n=0; for r in $runs; do [ -f runs/$r/exit_code ] && n=$((n + 1)); done; [ $n = 4 ] && break; [ $(left $learn) -le 0 ] && break; sleep 1; done
for r in $runs; do [ -f runs/$r/exit_code ] || kill $(cat runs/$r/pid); done; sleep 3
mkdir -p onnx; for r in $runs; do python3 -m pmg_train.export runs/$r/actor.pt --robot robot --out onnx/$r.onnx > onnx/$r.log 2>&1 & done
while pgrep -f pmg_train.export > /dev/null; do sleep 1; done
touch learned
go() { mkdir -p evals/$1; timeout $(($(left $end) > 1 ? $(left $end) : 1)) $E "${@:3}" --out evals/$1/$2 > evals/$1/$2.txt 2>&1 & }
p() { echo "--policy $2=onnx/$1.onnx"; }
go z steady steady $(p pmg pmg) --jobs 4
go z gait gait $(p pmg pmg) --jobs 1
go z table1 table1 $(p pmg pmg) $(p without_gco without_gco) $(p single_gait single_gait) $V --jobs 24
go seed_2 table1 table1 $(p pmg_seed_2 pmg) $V --jobs 12
go seed_2 steady steady $(p pmg_seed_2 pmg) --jobs 3
go seed_2 gait gait $(p pmg_seed_2 pmg) --jobs 1
go z push push $(p pmg pmg) --strengths 35,50 --jobs 12
go z jumps jumps $(p pmg pmg) $V --jobs 6
go z gentle table1 $(p pmg pmg) $(p without_gco without_gco) $(p single_gait single_gait) --scenario table1 $V --jobs 12
go z robust robust $(p pmg pmg) --jobs 8
wait; touch done
