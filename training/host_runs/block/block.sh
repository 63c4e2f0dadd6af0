#!/usr/bin/env bash
# block.sh ITERATIONS STOP_S END_S: seconds since t0
cd /tmp/pmg; . ./env.sh; t0=$(<t0)
since() { echo $(( $(date +%s) - t0 )); }
export RUNS="pmgh:pmg:1 pmgh_seed_2:pmg:2 without_gco:without_gco:1 single_gait:single_gait:1"
export OMP_NUM_THREADS=4
./train_policies.sh start runs 26 --iterations $1 --threads 14 --checkpoint-s 30 --keep-every-s 85
echo "started at $(since)"
setsid ./judge.sh $3 > judge.log 2>&1 < /dev/null &
while [ "$(since)" -lt "$2" ]; do sleep 2; ./train_policies.sh show runs | grep -q '(running)' || break; done
./train_policies.sh stop runs
for i in $(seq 30); do sleep 1; ./train_policies.sh show runs | grep -q '(running)' || break; done
echo "training ended at $(since)"; touch trained
