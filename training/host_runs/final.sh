#!/usr/bin/env bash
# final.sh LEARN EVAL : waits until the runs end, LEARN s after t0 (date +%s > t0 in the first call) at the latest; exports, measures until EVAL s, packs
cd /tmp/pmg && . ./env.sh; t0=$(cat t0); left() { echo $((t0 + $1 - $(date +%s))); }
N="pmg pmg_seed_2 without_gco single_gait"
for i in $(seq 1000); do n=0; for r in $N; do [ -f runs/$r/exit_code ] && n=$((n+1)); done; [ $n = 4 ] && break; [ $(left $1) -le 0 ] && break; sleep 1; done
for r in $N; do [ -f runs/$r/exit_code ] || kill $(cat runs/$r/pid); done; sleep 3
mkdir -p onnx; for r in $N; do python3 -m pmg_train.export runs/$r/actor.pt --robot robot --out onnx/$r.onnx > onnx/$r.log 2>&1 & done; wait
tar cf $OUT/runs.tar onnx runs/*/curve.csv runs/*/training.yaml runs/*/log
tar cf $OUT/actors.tar runs/*/actor.pt; echo exported $(left $2) left; ls -la onnx
E="ev/bin/pmg_eval"; V="--variation randomization.yaml"; D=$2
go() { mkdir -p evals/$1; timeout $(( $(left $2) > 1 ? $(left $2) : 1 )) $E "${@:4}" --out evals/$1/$3 > evals/$1/$3.txt 2>&1 & }
p() { echo "--policy $2=onnx/$1.onnx"; }
go z $D steady steady $(p pmg pmg) --jobs 8
go z $D gait gait $(p pmg pmg) --jobs 1
go z $D table1 table1 $(p pmg pmg) $(p without_gco without_gco) $(p single_gait single_gait) $V --jobs 30
go seed_2 $D table1 table1 $(p pmg_seed_2 pmg) $V --jobs 20
go seed_2 $D steady steady $(p pmg_seed_2 pmg) --jobs 6
go seed_2 $D gait gait $(p pmg_seed_2 pmg) --jobs 1
wait; tar cf $OUT/evals.tar evals
go z $D gentle table1 $(p pmg pmg) $(p without_gco without_gco) $(p single_gait single_gait) --scenario table1 $V --jobs 30
go z $D push push $(p pmg pmg) --strengths 35,50 --jobs 20
go z $D jumps jumps $(p pmg pmg) $V --jobs 10
go z $D robust robust $(p pmg pmg) --jobs 20
wait; tar cf $OUT/evals.tar evals
for f in evals/z/*.txt evals/seed_2/*.txt; do echo "-- $f"; grep -v 'left$\|report in' $f | cut -c1-140; done
