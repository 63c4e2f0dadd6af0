#!/usr/bin/env bash
# block.sh ITERATIONS LEARN END : times in s after t0
cd /tmp/pmg && . ./env.sh; t0=$(cat t0); left() { echo $((t0 + $1 - $(date +%s))); }
its=$1 learn=$2 end=$3
E="ev/bin/pmg_eval"; V="--variation randomization.yaml"
runs="pmg without_gco single_gait pmg_lead"
./launch.sh pmg pmg 1 0 $its config.yaml; ./launch.sh without_gco without_gco 1 1 $its config.yaml
./launch.sh single_gait single_gait 1 2 $its config.yaml; ./launch.sh pmg_lead pmg 1 3 $its config_lead.yaml
sleep 5
for i in $(seq 3000); do n=0; for r in $runs; do [ -f runs/$r/exit_code ] && n=$((n + 1)); done; [ $n = 4 ] && break; [ $(left $learn) -le 0 ] && break; sleep 1; done
for r in $runs; do [ -f runs/$r/exit_code ] || kill $(cat runs/$r/pid); done; sleep 3
mkdir -p onnx; for r in $runs; do python3 -m pmg_train.export runs/$r/actor.pt --robot robot --out onnx/$r.onnx > onnx/$r.log 2>&1 & done
while pgrep -f pmg_train.export > /dev/null; do sleep 1; done
touch learned
go() { mkdir -p evals/$1; timeout $(($(left $end) > 1 ? $(left $end) : 1)) $E "${@:3}" --out evals/$1/$2 > evals/$1/$2.txt 2>&1 & }
p() { echo "--policy $2=onnx/$1.onnx"; }
for r in pmg pmg_lead; do go $r gait gait $(p $r pmg) --jobs 1; go $r steady steady $(p $r pmg) --jobs 4; go $r table1 table1 $(p $r pmg) $V --jobs 20; go $r push push $(p $r pmg) --strengths 35,50 --jobs 10; done
go single_gait table1 table1 $(p single_gait single_gait) $V --jobs 12
go without_gco table1 table1 $(p without_gco without_gco) $V --jobs 12
go pmg jumps jumps $(p pmg pmg) $V --jobs 6
go pmg robust robust $(p pmg pmg) --jobs 10
go pmg gentle table1 $(p pmg pmg) $(p without_gco without_gco) $(p single_gait single_gait) --scenario ev/share/pmg/scenarios/table1.yaml $V --jobs 12
wait; touch done
