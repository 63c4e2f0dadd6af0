#!/usr/bin/env bash
# launch.sh NAME VARIANT SEED GPU ITERATIONS [CONFIG]
cd /tmp/pmg && . ./env.sh
name=$1 variant=$2 seed=$3 gpu=$4 its=$5 config=${6:-config.yaml}
mkdir -p runs/$name
export CUDA_VISIBLE_DEVICES=$gpu OMP_NUM_THREADS=4
setsid bash -c 'python3 -m pmg_train.train --robot robot --mjcf robot.xml --library lib/libpmg_batch.so --variant '$variant' --seed '$seed' --config '$config' --out runs/'$name' --minutes 60 --iterations '$its' --checkpoint-s 60 & echo $! > runs/'$name'/pid; wait $!; echo $? > runs/'$name'/exit_code' >> runs/$name/log 2>&1 </dev/null &
