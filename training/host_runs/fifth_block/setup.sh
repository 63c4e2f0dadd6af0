#!/usr/bin/env bash
# second call: unpack everything in /tmp/pmg
set -euo pipefail
cd /tmp/pmg
cat site.part.* | tar xJf - && tar xJf host.tar.xz && tar xJf eval.tar.xz
mkdir -p evm/bin && cp ev/bin/pmg_eval evm/bin/

. ./env.sh
nvidia-smi --query-gpu=name,memory.used --format=csv,noheader; nproc
python3 -c "import torch,warp,mujoco_warp,onnx,numpy;print(torch.__version__,numpy.__version__,warp.config.version)"
