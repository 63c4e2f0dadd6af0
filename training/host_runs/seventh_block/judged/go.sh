#!/bin/bash
# go.sh SECONDS
cd "$(dirname "$0")"; export LD_LIBRARY_PATH=$PWD/lib/pmg OMP_NUM_THREADS=1; end=$(( $(date +%s) + $1 )); left() { local t=$((end - $(date +%s))); echo $((t > 1 ? t : 1)); }
E=bin/pmg_eval; V="--variation randomization.yaml"; mkdir -p ev; chmod +x bin/*
go() { local n=$1; shift; timeout -s INT $(left) $E "$@" --out ev/$n > ev/$n.txt 2>&1 & }
R="pmg pmg_seed_2 pmgb pmgb_seed_2"
for r in $R; do go table1_$r table1 --policy pmg=onnx/$r.onnx $V --jobs 16; done; wait
for r in $R; do go jumps_$r jumps --policy pmg=onnx/$r.onnx $V --jobs 6; go push_$r push --policy pmg=onnx/$r.onnx --strengths 35,50 --jobs 10; done; wait
go push_main push --robot z1main --strengths 35,50 --jobs 40; go jumps_main jumps --robot z1main --jobs 12; go table1_main table1 --robot z1main --policy pmg --jobs 12; wait
for r in pmgb pmgb_seed_2; do go robust_$r robust --policy pmg=onnx/$r.onnx --jobs 30; done; wait
