#!/usr/bin/env bash
cd /tmp/pmg; tar cf $OUT/runs.tar onnx runs/*/curve.csv runs/*/training.yaml runs/*/log; tar cf $OUT/actors.tar runs/*/actor.pt; tar cf $OUT/evals.tar evals; ls -la $OUT
for f in evals/z/*.txt evals/seed_2/*.txt; do echo "-- $f"; grep -v 'left$\|report in' $f | cut -c1-140; done
