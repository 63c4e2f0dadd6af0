set -euo pipefail
cd /tmp/gpu22
mkdir -p w
python3 -m pip download -q --no-deps --only-binary=:all: --python-version 3.12 --implementation cp \
  --platform manylinux_2_28_x86_64 --platform manylinux_2_27_x86_64 --platform manylinux_2_17_x86_64 --platform manylinux2014_x86_64 \
  -d w warp-lang==1.19.0 mujoco==3.11.0 mujoco-warp==3.11.0 etils==1.15.0
mkdir -p s/site; for w in w/*.whl; do python3 -m zipfile -e $w s/site; done
cd s/site
rm -rf warp/bin/warp-clang.so warp/tests warp/examples mujoco/plugin mujoco/mjx mujoco/testdata mujoco/experimental mujoco/introspect
python3 - 90 <<'P'
import mmap, struct, sys
keep = int(sys.argv[1])
with open('warp/bin/warp.so', 'r+b') as f, mmap.mmap(f.fileno(), 0) as m:
    at = 0
    while (start := m.find(b'\x50\xed\x55\xba', at)) >= 0:
        version, header, size = struct.unpack_from('<HHQ', m, start + 4)
        at = start + 4
        if version != 1 or header != 16 or size > len(m): continue
        entry, end = start + 16, start + 16 + size
        while entry < end:
            kind, _, skip, length = struct.unpack_from('<HHIQ', m, entry)
            if skip > 4096 or length > size: break
            arch, = struct.unpack_from('<I', m, entry + 28)
            if arch != keep and kind in (1, 2):
                m[entry + skip:entry + skip + length] = bytes(length)
            entry += skip + length
        at = end
P
cd ..; tar cf - site | xz --x86 --lzma2=preset=6,dict=128MiB -T1 > /tmp/gpu22/site.tar.xz
ls -la /tmp/gpu22; echo SITEDONE
