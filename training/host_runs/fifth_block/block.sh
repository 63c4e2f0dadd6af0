#!/usr/bin/env bash
# block.sh ITERATIONS LEARN END : times in s after t0; four GPUs
cd /tmp/pmg && . ./env.sh; t0=$(cat t0); left() { echo $((t0 + $1 - $(date +%s))); }
its=$1 learn=$2 end=$3
E="ev/bin/pmg_eval"; V="--variation randomization.yaml"
runs="pmg pmg_seed_2 pmg_roll person"
./launch.sh pmg pmg 1 0 $its config.yaml; ./launch.sh pmg_seed_2 pmg 2 1 $its config.yaml
./launch.sh pmg_roll pmg 1 2 $its config_roll.yaml; ./launch_person.sh 3 2250
main() { mkdir -p evals/main; evm/bin/pmg_eval "${@:2}" --out evals/main/$1 > evals/main/$1.txt 2>&1; }
(sleep 150; export OMP_NUM_THREADS=1; main table1 table1 $V --jobs 20; main gentle table1 --scenario evm/share/pmg/scenarios/table1.yaml --jobs 20; main variation table1 --jobs 20; touch evals/main/done) &
sleep 5
for i in $(seq 3000); do n=0; for r in $runs; do [ -f runs/$r/exit_code ] && n=$((n + 1)); done; [ $n = 4 ] && break; [ $(left $learn) -le 0 ] && break; sleep 1; done
for r in $runs; do [ -f runs/$r/exit_code ] || kill $(cat runs/$r/pid); done; sleep 3
mkdir -p onnx; for r in pmg pmg_seed_2 pmg_roll; do python3 -m pmg_train.export runs/$r/actor.pt --robot robot --out onnx/$r.onnx > onnx/$r.log 2>&1 & done
(cd /tmp/pmg_person; PYTHONPATH=/tmp/pmg_person:/tmp/pmg/site python3 -m pmg_train.export runs/person/actor.pt --robot robot --out /tmp/pmg/onnx/person.onnx > /tmp/pmg/onnx/person.log 2>&1) &
while pgrep -f pmg_train.export > /dev/null; do sleep 1; done
touch learned
go() { mkdir -p evals/$1; timeout $(($(left $end) > 1 ? $(left $end) : 1)) $E "${@:3}" --out evals/$1/$2 > evals/$1/$2.txt 2>&1 & }
p() { echo "--policy pmg=onnx/$1.onnx"; }
for r in pmg pmg_seed_2 pmg_roll; do go $r gait gait $(p $r) --jobs 1; go $r table1 table1 $(p $r) $V --jobs 20; go $r steady steady $(p $r) --jobs 3; done
for r in pmg pmg_roll; do go $r push push $(p $r) --strengths 35,50 --jobs 8; done
go pmg jumps jumps $(p pmg) $V --jobs 6
go pmg robust robust $(p pmg) --jobs 8
go pmg gentle table1 $(p pmg) --scenario ev/share/pmg/scenarios/table1.yaml --jobs 8
wait; touch done
