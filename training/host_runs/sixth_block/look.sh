#!/usr/bin/env bash
cd /tmp/pmg; for r in pmg pmg_seed_2; do echo "$r $(cat runs/$r/exit_code 2>/dev/null): $(tail -n 1 runs/$r/log | cut -c1-330)"; done; echo "t $(( $(date +%s) - $(cat t0) )) $(ls learned first done 2>/dev/null | tr '\n' ' ') main: $(ls evals/main 2>/dev/null | tr '\n' ' ')"
grep -h "lands\|Walks at" evals/mid/gait*.txt 2>/dev/null | cut -c1-120
tail -n 2 evals/table3.txt 2>/dev/null | cut -c1-200
tar cf $OUT/runs.tar runs/*/actor.pt runs/*/curve.csv runs/*/training.yaml runs/*/log onnx 2>/dev/null
cp runs/pmg/last.pt $OUT/last_pmg.pt 2>/dev/null; cp runs/pmg_seed_2/last.pt $OUT/last_pmg_seed_2.pt 2>/dev/null
tar czf $OUT/evals.tgz evals 2>/dev/null; true
