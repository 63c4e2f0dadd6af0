#!/bin/bash
# TAG SEED
cd /work/trees/gait17; d=/tmp/gpu17/x/$1; mkdir -p $d
FLP=1 FLN=1 build/ci/bin/test_sil_room --gtest_filter="Robots/LiftedInMidWalk.*/$(($2-1))" --gtest_output=xml:$d/l$2.xml > /dev/null 2> $d/l$2.fl
