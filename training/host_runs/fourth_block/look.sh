#!/usr/bin/env bash
# look.sh SECONDS : shows and packs; ends early when done
cd /tmp/pmg; e=$(($(date +%s) + $1))
while [ $(date +%s) -lt $e ] && [ ! -f done ]; do sleep 2; done
for r in runs/*/; do r=$(basename $r); echo "$r $(cat runs/$r/exit_code 2>/dev/null): $(tail -n 1 runs/$r/log | cut -c1-260)"; done
tar cf $OUT/runs.tar runs/*/curve.csv runs/*/training.yaml runs/*/log runs/*/actor.pt $(ls -d onnx 2>/dev/null); [ -d evals ] && tar cf $OUT/evals.tar evals; ls -la $OUT; ls; echo t $(($(date +%s) - $(cat t0)))
[ -f done ] && for f in evals/*/*.txt; do echo "-- $f"; grep -v 'left$\|report in' $f | cut -c1-140; done; true
