#!/usr/bin/env bash
cd /tmp/pmg; echo "pmg $(cat runs/pmg/exit_code 2>/dev/null): $(tail -n 1 runs/pmg/log | cut -c1-330)"; echo "t $(( $(date +%s) - $(cat t0) )) $(ls learned done 2>/dev/null)"
tar cf $OUT/runs.tar runs/pmg/actor.pt runs/pmg/last.pt runs/pmg/curve.csv runs/pmg/training.yaml runs/pmg/log onnx 2>/dev/null; tar czf $OUT/evals.tgz evals 2>/dev/null; true
