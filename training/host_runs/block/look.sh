#!/usr/bin/env bash
# look.sh UNTIL_S: waits until then (or until all is judged), prints the state, brings files
cd /tmp/pmg; t0=$(<t0)
since() { echo $(( $(date +%s) - t0 )); }
while [ "$(since)" -lt "$1" ]; do sleep 2; done
export RUNS="pmgh:pmg:1 pmgh_seed_2:pmg:2 without_gco:without_gco:1 single_gait:single_gait:1"
echo "at $(since)"; ./train_policies.sh show runs | cut -c1-420; cat judge.log 2>/dev/null | tail -40
tar czf $OUT/onnx.tgz onnx 2>/dev/null
tar czf $OUT/runs.tgz runs/*/actor.pt runs/*/curve.csv runs/*/training.yaml runs/*/log 2>/dev/null
find evals -name '*.txt' -o -name '*.json' 2>/dev/null | tar czf $OUT/evals.tgz -T - 2>/dev/null
ls -la $OUT
