#!/bin/bash
d=/tmp/gpu17/x/$1; mkdir -p $d; cd /tmp/gpu15e
FLP=1 FLN=1 /work/trees/gait17/build/ci/bin/pmg_sil --robot robot/config/robots/z1 --policy robot/config/robots/z1/policies/$2.onnx --scenario table1_full --vary late/randomization.yaml --seed $3 --out $d/o$2$3 2> $d/w$2_$3.fl > /dev/null; rm -rf $d/o$2$3
