#!/usr/bin/env bash
# judge.sh END_S: exports and evaluates every kept checkpoint from iteration 2,900 on, and the final actors
cd /tmp/pmg; . ./env.sh; t0=$(<t0); end=$1
since() { echo $(( $(date +%s) - t0 )); }
export PMG_CONFIG=/tmp/pmg/config OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 CUDA_VISIBLE_DEVICES=
E=/tmp/pmg/eval/bin/pmg_eval
mkdir -p onnx evals
one() { # name command args... ; into evals/name/command
  local name=$1 what=$2; shift 2
  timeout $((end - $(since))) nice -n 10 $E "$@" --policy pmg=onnx/$name.onnx --jobs 6 --out evals/$name/$what > evals/$name/$what.txt 2>&1
  local r=$?
  echo "$(since) $name $what: $r"
}
judge() { # name all
  local name=$1
  mkdir -p evals/$name
  one $name train table1 --variation randomization.yaml &
  one $name gait gait &
  one $name steady steady &
  if [[ $2 != baseline ]]; then one $name table3 table3 --trials $([[ $2 == checkpoint ]] && echo 16 || echo 100) & fi
  if [[ $2 != checkpoint ]]; then
    one $name eval table1 &
    one $name gentle table1 --scenario config/scenarios/table1.yaml &
    one $name push push --strengths 35,50 --trials 200 &
    one $name jumps jumps --variation randomization.yaml &
    one $name robust robust &
    one $name table2 table2 &
  fi
  wait
  echo "$(since) $name judged"
}
judged=" "
while [ "$(since)" -lt "$end" ]; do
  for f in runs/pmgh/actor_*.pt runs/pmgh_seed_2/actor_*.pt; do
    [[ -e $f ]] || continue
    it=${f##*actor_}; it=${it%.pt}; ((it >= 2900)) || continue
    name=$(basename $(dirname $f))_$it
    [[ $judged == *" $name "* ]] && continue
    judged+="$name "
    python3 -m pmg_train.export $f --robot robot --out onnx/$name.onnx && judge $name checkpoint &
  done
  for r in pmgh pmgh_seed_2 without_gco single_gait; do
    [[ $judged == *" $r "* ]] && continue
    [[ -e runs/$r/exit_code ]] || continue
    judged+="$r "
    kind=final; [[ $r == pmgh* ]] || kind=baseline
    python3 -m pmg_train.export runs/$r/actor.pt --robot robot --out onnx/$r.onnx && judge $r $kind &
  done
  sleep 2
done
