#!/usr/bin/env bash
# block.sh ITERATIONS LEARN END : times in s after t0; two GPUs: pmg, seeds 1 and 2
cd /tmp/pmg && . ./env.sh; t0=$(cat t0); left() { echo $((t0 + $1 - $(date +%s))); }
its=$1 learn=$2 end=$3
E="ev/bin/pmg_eval"; V="--variation randomization.yaml"; MV="--variation randomization_main.yaml"
runs="pmg pmg_seed_2"
./launch.sh pmg pmg 1 0 $its; ./launch.sh pmg_seed_2 pmg 2 1 $its
export OMP_NUM_THREADS=1
main() { mkdir -p evals/main; nice -n 19 evm/bin/pmg_eval "${@:2}" --out evals/main/$1 > evals/main/$1.txt 2>&1; }
J=${JOBS:-20}
(sleep ${REFS:-170}
 main gait gait --jobs 1; main table1 table1 --policy pmg $MV --jobs $J; main push push --strengths 35,50 --jobs $J; main steady steady --jobs $J
 main jumps jumps $MV --jobs $J; main gentle table1 --policy pmg --scenario evm/share/pmg/scenarios/table1.yaml $MV --jobs $J; main robust robust --jobs $J
 touch evals/main/done
 timeout -s INT $(($(left $learn) + ${T3_MORE:-0} > 1 ? $(left $learn) + ${T3_MORE:-0} : 1)) nice -n 19 evm/bin/pmg_eval table3 --trials ${TRIALS:-100} --jobs $((J + 4)) --out evals/table3 > evals/table3.txt 2>&1; touch evals/table3_done) &
sleep 5
mid=0; next=420
for i in $(seq 3000); do n=0; for r in $runs; do [ -f runs/$r/exit_code ] && n=$((n + 1)); done; [ $n = 2 ] && break; [ $(left $learn) -le 0 ] && break
  if [ $(left $next) -le 0 ] && [ -f runs/pmg/actor.pt ]; then mid=$((mid + 1)); next=$((next + 200)); mkdir -p evals/mid
    (python3 -m pmg_train.export runs/pmg/actor.pt --robot robot --out evals/mid/$mid.onnx > evals/mid/$mid.log 2>&1; $E gait --policy pmg=evals/mid/$mid.onnx --jobs 1 --out evals/mid/gait$mid > evals/mid/gait$mid.txt 2>&1) & fi
  sleep 1; done
for r in $runs; do [ -f runs/$r/exit_code ] || kill $(cat runs/$r/pid); done; sleep 4
mkdir -p onnx; pids=
for r in $runs; do python3 -m pmg_train.export runs/$r/actor.pt --robot robot --out onnx/$r.onnx > onnx/$r.log 2>&1 & pids="$pids $!"; done
wait $pids; touch learned
pids=
go() { mkdir -p evals/$1; timeout $(($(left $end) > 1 ? $(left $end) : 1)) $E "${@:3}" --out evals/$1/$2 > evals/$1/$2.txt 2>&1 & pids="$pids $!"; }
p() { echo "--policy pmg=onnx/$1.onnx"; }
for r in $runs; do go $r gait gait $(p $r) --jobs 1; go $r table1 table1 $(p $r) $V --jobs ${TJ:-14}; done
wait $pids; pids=; touch first
for r in $runs; do go $r steady steady $(p $r) --jobs 4; go $r push push $(p $r) --strengths 35,50 --jobs 8; go $r jumps jumps $(p $r) $V --jobs 4; done
wait $pids; pids=
for r in $runs; do go $r gentle table1 $(p $r) --scenario ev/share/pmg/scenarios/table1.yaml $V --jobs ${TJ:-14}; go $r robust robust $(p $r) --jobs 8; done
wait $pids; touch done
