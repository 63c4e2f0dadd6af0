#!/usr/bin/env bash
# Packs what a GPU host without network needs, for Linux x86-64 with Python 3.12, PyTorch, numpy, PyYAML and CUDA:
#   bundle.sh BUILD_DIR ROBOT OUT_DIR [SM]
# BUILD_DIR holds lib/libpmg_batch.so and bin/pmg_sil; ROBOT is a name as pmg_sil takes it; SM is the GPU's compute capability
# without the dot (default 90: H100, H200). OUT_DIR gets host.tar.xz (generator library with the libraries it links, robot, MJCF,
# training code: a second to make again) and site.tar.xz (Python packages; made once, about 60 MB). On the host:
#   mkdir -p /tmp/pmg && tar xJf site.tar.xz -C /tmp/pmg && tar xJf host.tar.xz -C /tmp/pmg && cd /tmp/pmg && . ./env.sh
#   python3 -m pmg_train.train --robot robot --mjcf robot.xml --library lib/libpmg_batch.so --out runs/pmg --minutes 20
set -euo pipefail
if [[ $# -lt 3 || $1 == --help ]]; then sed -n '2,9s/^# \{0,1\}//p' "$0"; exit 2; fi
here=$(cd "$(dirname "$0")" && pwd); build=$(cd "$1" && pwd); robot=$2; out=$(mkdir -p "$3" && cd "$3" && pwd); sm=${4:-90}
: "${PYTHON:=python3}"
tmp=$(mktemp -d); trap 'rm -rf "$tmp"' EXIT

mkdir -p "$tmp/host/lib" "$tmp/host/robot"
# The generator with its libraries in one folder; the C++ and C run-time libraries are the host's (newer or equal ones will do).
cp "$build/lib/libpmg_batch.so" "$tmp/host/lib/"
ldd "$build/lib/libpmg_batch.so" | awk '$2 == "=>" {print $3}' | grep -Ev '/(libc|libm|libgcc_s|libstdc\+\+|libpthread|libdl)\.so' |
  while read -r library; do cp -L "$library" "$tmp/host/lib/"; done
chmod u+w "$tmp"/host/lib/*
for library in "$tmp"/host/lib/*.so*; do strip "$library"; patchelf --set-rpath '$ORIGIN' "$library"; done
"$build/bin/pmg_sil" --robot "$robot" --export-mjcf "$tmp/host/robot.xml" > /dev/null
robot_dir=$robot; [[ -d $robot_dir ]] || robot_dir=$here/../config/robots/$robot
cp -r "$robot_dir"/. "$tmp/host/robot/"; rm -rf "$tmp/host/robot/policies"
cp -r "$here/pmg_train" "$here/config.yaml" "$here/randomization.yaml" "$here/train_policies.sh" "$tmp/host/"
rm -rf "$tmp/host/pmg_train/__pycache__"
printf 'export PYTHONPATH=$PWD:$PWD/site MUJOCO_GL=disable PYTHONUNBUFFERED=1\n' > "$tmp/host/env.sh"
tar cJf "$out/host.tar.xz" -C "$tmp/host" .

[[ -e $out/site.tar.xz ]] && { echo "$out/site.tar.xz is there already; delete it to make it anew"; exit 0; }
"$PYTHON" -m pip download -q --no-deps --only-binary=:all: --python-version 3.12 --implementation cp \
  --platform manylinux_2_28_x86_64 --platform manylinux_2_27_x86_64 --platform manylinux_2_17_x86_64 --platform manylinux2014_x86_64 \
  -d "$tmp/wheels" warp-lang==1.19.0 mujoco==3.11.0 mujoco-warp==3.11.0 etils==1.15.0
mkdir -p "$tmp/site/site"
for wheel in "$tmp"/wheels/*.whl; do unzip -q -o "$wheel" -d "$tmp/site/site"; done
cd "$tmp/site/site"
# Not the CPU compiler, samples and viewers.
rm -rf warp/bin/warp-clang.so warp/tests warp/examples mujoco/plugin mujoco/mjx mujoco/testdata mujoco/experimental mujoco/introspect
"$PYTHON" - "$sm" <<'P'
# Blank the GPU code of other architectures inside warp.so's fat binaries: sizes stay, so the file stays valid.
import mmap, struct, sys
keep = int(sys.argv[1])
with open('warp/bin/warp.so', 'r+b') as f, mmap.mmap(f.fileno(), 0) as m:
    at = 0
    while (start := m.find(b'\x50\xed\x55\xba', at)) >= 0:              # fat binary magic
        version, header, size = struct.unpack_from('<HHQ', m, start + 4)
        at = start + 4
        if version != 1 or header != 16 or size > len(m): continue
        entry, end = start + 16, start + 16 + size
        while entry < end:
            kind, _, skip, length = struct.unpack_from('<HHIQ', m, entry)
            if skip > 4096 or length > size: break
            arch, = struct.unpack_from('<I', m, entry + 28)
            if arch != keep and kind in (1, 2):                          # 1 PTX, 2 machine code
                m[entry + skip:entry + skip + length] = bytes(length)
            entry += skip + length
        at = end
P
tar cf - -C "$tmp/site" . | xz --x86 --lzma2=preset=7,dict=128MiB -T1 > "$out/site.tar.xz"
du -sh "$out"/*.tar.xz
