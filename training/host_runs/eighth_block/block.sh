#!/usr/bin/env bash
# block.sh ITERATIONS LEARN END : times in s after t0; a run a GPU, exported and judged when learning ends
cd /tmp/pmg && . ./env.sh; t0=$(cat t0); left() { echo $((t0 + $1 - $(date +%s))); }
its=$1 learn=$2 end=$3
E="env LD_LIBRARY_PATH=ev/lib/pmg ev/bin/pmg_eval"; V="--variation randomization.yaml"
gpus=$(nvidia-smi -L | wc -l)
if [ $gpus -ge 4 ]; then runs="pmgc pmgc_seed_2 pmgd pmgd_seed_2"; elif [ $gpus -ge 2 ]; then runs="pmgc pmgd"; else runs="pmgd"; fi
echo $runs > runs_list; g=0
for r in $runs; do c=config_c.yaml; s=1; case $r in pmgd*) c=config_d.yaml;; esac; case $r in *_seed_2) s=2;; esac
  ./launch.sh $r pmg $s $g $its $c; g=$((g + 1)); done
n=$(set -- $runs; echo $#); cores=$(env -u OMP_NUM_THREADS nproc); each=$((cores / n)); [ $each -lt 4 ] && each=4
export OMP_NUM_THREADS=1
sleep 5; mid=0; next=420
for i in $(seq 4000); do k=0; for r in $runs; do [ -f runs/$r/exit_code ] && k=$((k + 1)); done; [ $k = $n ] && break; [ $(left $learn) -le 0 ] && break
  if [ $(left $next) -le 0 ]; then mid=$((mid + 1)); next=$((next + 200)); mkdir -p evals/mid
    for r in $runs; do [ -f runs/$r/actor.pt ] && (python3 -m pmg_train.export runs/$r/actor.pt --robot robot --out evals/mid/$r.$mid.onnx > evals/mid/$r.$mid.log 2>&1; $E gait --policy pmg=evals/mid/$r.$mid.onnx --jobs 1 --out evals/mid/$r.$mid > evals/mid/$r.$mid.txt 2>&1; rm -f evals/mid/$r.$((mid - 2)).onnx) & done; fi
  sleep 1; done
for r in $runs; do [ -f runs/$r/exit_code ] || kill $(cat runs/$r/pid); done; sleep 4
mkdir -p onnx; pids=
for r in $runs; do python3 -m pmg_train.export runs/$r/actor.pt --robot robot --out onnx/$r.onnx > onnx/$r.log 2>&1 & pids="$pids $!"; done
wait $pids; touch learned
pids=
go() { mkdir -p evals/$1; local t=$(left $end); timeout -s INT $((t > 1 ? t : 1)) $E "${@:3}" --out evals/$1/$2 > evals/$1/$2.txt 2>&1 & pids="$pids $!"; }
p() { echo "--policy pmg=onnx/$1.onnx"; }
for r in $runs; do go $r gait gait $(p $r) --jobs 1; go $r table1 table1 $(p $r) $V --jobs $each; done
wait $pids; pids=; touch first
for r in $runs; do go $r steady steady $(p $r) --jobs $each; go $r push push $(p $r) --strengths 35,50 --jobs $each; go $r jumps jumps $(p $r) $V --jobs $each; done
wait $pids; pids=; touch second
for r in $runs; do go $r gentle table1 $(p $r) --scenario ev/share/pmg/scenarios/table1.yaml $V --jobs $each; go $r robust robust $(p $r) --jobs $each; done
wait $pids; pids=; touch third
for r in $runs; do go $r exact table1 $(p $r) --variation exact_encoders.yaml --jobs $each; done
wait $pids; touch done
