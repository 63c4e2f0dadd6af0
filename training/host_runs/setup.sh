#!/usr/bin/env bash
# second call: unpack everything in /tmp/pmg
set -euo pipefail
cd /tmp/pmg
cat site.part.* | tar xJf - && tar xJf host.tar.xz && mkdir -p ev && tar xJf eval.tar.xz -C ev && rm -f ev/share/pmg/robots/z1/clips/* && tar xzf clips.tar.gz -C ev/share/pmg/robots/z1/clips
. ./env.sh
nvidia-smi --query-gpu=name,memory.used --format=csv,noheader; nproc
python3 -c "import torch,warp,mujoco_warp,onnx,numpy;print(torch.__version__,numpy.__version__,warp.config.version)"
