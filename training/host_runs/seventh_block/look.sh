#!/usr/bin/env bash
# look.sh UNTIL : waits until UNTIL s after t0 (or done), then packs what there is into $OUT
cd /tmp/pmg; t0=$(cat t0)
while [ $(( $(date +%s) - t0 )) -lt $1 ] && [ ! -f done ]; do sleep 2; done
for r in $(cat runs_list); do echo "$r $(cat runs/$r/exit_code 2>/dev/null): $(tail -n 1 runs/$r/log | cut -c1-330)"; done
echo "t $(( $(date +%s) - t0 )) $(ls learned first second third done 2>/dev/null | tr '\n' ' ')"
grep -H "lands\|Walks at" evals/mid/*.txt 2>/dev/null | cut -c11-150
for r in $(cat runs_list); do cp runs/$r/last.pt $OUT/last_$r.pt 2>/dev/null; done
tar cf - runs/*/actor.pt runs/*/curve.csv runs/*/training.yaml runs/*/log onnx 2>/dev/null | gzip -1 > $OUT/runs.tgz
tar cf - evals --exclude='*.onnx' 2>/dev/null | gzip -3 > $OUT/evals.tgz; ls -l $OUT; du -sh evals; true
