#!/usr/bin/env bash
# short.sh ITERATIONS LEARN END, times in s after t0
cd /tmp/pmg && . ./env.sh; t0=$(cat t0); left() { echo $((t0 + $1 - $(date +%s))); }
its=$1 learn=$2 end=$3
E="ev/bin/pmg_eval"; V="--variation randomization.yaml"
runs="pmg pmg_seed_2 pmg_z1_seed_2 single_gait"
./launch.sh pmg pmg 1 0 $its config_short.yaml; ./launch.sh pmg_seed_2 pmg 2 1 $its config_short.yaml
./launch.sh pmg_z1_seed_2 pmg 2 2 $its config_short_z1.yaml; ./launch.sh single_gait single_gait 1 3 $its config_short.yaml
sleep 5
for i in $(seq 3000); do n=0; for r in $runs; do [ -f runs/$r/exit_code ] && n=$((n + 1)); done; [ $n = 4 ] && break; [ $(left $learn) -le 0 ] && break; sleep 1; done
for r in $runs; do [ -f runs/$r/exit_code ] || kill $(cat runs/$r/pid); done; sleep 3
mkdir -p onnx; for r in $runs; do python3 -m pmg_train.export runs/$r/actor.pt --robot robot --out onnx/$r.onnx > onnx/$r.log 2>&1 & done
while pgrep -f pmg_train.export > /dev/null; do sleep 1; done
touch learned
go() { mkdir -p evals/$1; timeout $(($(left $end) > 1 ? $(left $end) : 1)) $E "${@:3}" --out evals/$1/$2 > evals/$1/$2.txt 2>&1 & }
p() { echo "--policy $2=onnx/$1.onnx"; }
for r in pmg pmg_seed_2; do go $r gait gait $(p $r pmg) --jobs 1; done
go pmg steady steady $(p pmg pmg) --jobs 4
go pmg table1 table1 $(p pmg pmg) $V --jobs 20
go pmg_seed_2 table1 table1 $(p pmg_seed_2 pmg) $V --jobs 20
go pmg_z1_seed_2 table1 table1 $(p pmg_z1_seed_2 pmg) $V --jobs 20
go single_gait table1 table1 $(p single_gait single_gait) $V --jobs 10
go pmg push push $(p pmg pmg) --strengths 35,50 --jobs 16
go pmg jumps jumps $(p pmg pmg) $V --jobs 6
wait; touch done
