import glob
import re
import sys

import numpy as np

d = "/tmp/gpu17/x/" + sys.argv[1]


def rd(f):
    return np.array([[float(z) for z in l.split()[1:6]] for l in open(f, errors="replace") if l.startswith("FL ")])


L = []
C = []
for s in range(1, 21):
    L.append(rd(f"{d}/l{s}.fl"))
    t = open(f"{d}/l{s}.xml").read()
    m = re.search(r"lifted ([0-9.]+) s", t)
    C.append(float(m.group(1)) if m else np.nan)
W = [rd(f) for f in sorted(glob.glob(d + "/w*.fl"))]


def ema(v, tc):
    a = 1 - np.exp(-0.01 / tc)
    y = np.empty_like(v)
    s = v[0]
    for i, z in enumerate(v):
        s += a * (z - s)
        y[i] = s
    return y


def ev(n, g):
    w = [np.min(np.where(x[200:, 3] > 0.5, g(x)[200:], 9)) for x in W]
    for M in (0, 0.05):
        thr = min(w) - M
        t = []
        for x, c in zip(L, C):
            s = g(x)
            i = int(round(c * 100))
            k = np.nonzero((s[i:] < thr) & (x[i:, 3] > 0.5))[0]
            t.append(k[0] / 100 if len(k) else 9)
        t = np.sort(t)
        print("%-20s thr %.2f p50 %.2f 3 last %s >.25: %d" % (n, thr, t[10], t[-4:], sum(t > 0.25)))


p = lambda x: np.maximum(x[:, 0], x[:, 1])
for tc in (0.05, 0.1, 0.15, 0.2):
    ev("ema %.2f" % tc, lambda x: ema(p(x), tc))
