import numpy as np

L = [np.array(x, float) for x in list(np.load("lift.npy", allow_pickle=True))[:20]]
C = np.load("clear.npy")
W = [np.array(x, float) for x in np.load("walk.npy", allow_pickle=True)]


def feats(x):
    return x[:, 0] + x[:, 1], np.maximum(x[:, 4] + x[:, 5], x[:, 6] + x[:, 7])


def ema(v, tc):
    a = 1 - np.exp(-0.01 / tc)
    y = np.empty_like(v)
    s = v[0]
    for i, z in enumerate(v):
        s += a * (z - s)
        y[i] = s
    return y


def ev(name, score):
    w = [np.min(np.where(x[200:, 12] > 0.5, score(x)[200:], 9)) for x in W]
    allw = np.sort(np.concatenate([score(x)[200:] for x in W]))
    for thr in (np.sort(w)[0], np.sort(w)[1]):  # no false verdict at all; one
        t = []
        for x, c in zip(L, C):
            s = score(x)
            i = int(round(c * 100))
            k = np.nonzero((s[i:] < thr) & (x[i:, 12] > 0.5))[0]
            t.append(k[0] / 100 if len(k) else 9.99)
        t = np.sort(t)
        print("%-40s thr %.2f lift p50 %.2f p90 %.2f max %.2f >.25: %d" % (name, thr, t[10], t[18], t[-1], sum(t > 0.25)))


p = lambda x: feats(x)[0]
f = lambda x: feats(x)[1]
T = lambda x: np.hypot(x[:, 8], x[:, 9]) / 60
tm = lambda x: np.maximum(x[:, 8], x[:, 9]) / 60
cl = lambda v, lo, hi: np.clip(v, lo, hi)
for tc in (0.05, 0.08, 0.1, 0.15, 0.2):
    ev("ema%.2f p" % tc, lambda x: ema(p(x), tc))
    ev("ema%.2f f" % tc, lambda x: ema(f(x), tc))
    ev("ema%.2f mean" % tc, lambda x: ema((p(x) + f(x)) / 2, tc))
    ev("ema%.2f mean clipped 0..1.2" % tc, lambda x: ema((cl(p(x), -0.2, 1.2) + cl(f(x), -0.2, 1.2)) / 2, tc))
    ev("ema%.2f mean+T/2" % tc, lambda x: ema((p(x) + f(x)) / 2 + 0.5 * T(x), tc))
    ev("ema%.2f T" % tc, lambda x: ema(T(x), tc))
    ev("ema%.2f max(p,f)" % tc, lambda x: ema(np.maximum(p(x), f(x)), tc))
