import sys

sys.argv = ["x", sys.argv[1]]
exec(open("/tmp/gpu17/fr.py").read().split("for tc in (.08")[0])
A = lambda x: x[:, 4]


def dwell(x, lim, n):
    r = np.zeros(len(x), bool)
    c = 0
    for i, (q, h) in enumerate(zip(p0(x), x[:, 3])):
        c = c + 1 if q < lim and h > 0.5 else 0
        r[i] = c >= n
    return r


p0 = p
p = lambda x: np.maximum(p0(x), 0.2)
longest = lambda lim: max(
    max(len(s) for s in "".join("1" if q < lim and h > 0.5 else "0" for q, h in zip(p0(x)[200:], x[200:, 3])).split("0")) for x in W
)
print("walk longest below .25 .2 .15 .1:", [longest(l) for l in (0.25, 0.2, 0.15, 0.1)])
print("walk A quantiles", np.quantile(np.concatenate([A(x)[200:] for x in W]), [0.1, 0.5, 0.9, 0.99, 0.999]))
for g in (0, 50, 60, 70, 80, 100, 120):
    for tc in (0.15, 0.2):
        w = min(np.min(np.where((x[200:, 3] > 0.5) & (A(x)[200:] > g), emaf(x, tc)[200:], 9)) for x in W)
        for M in (0.03, 0.05):
            t = []
            for x, c in zip(L, C):
                s = emaf(x, tc)
                i = int(round(c * 100))
                k = np.nonzero(((s[i:] < w - M) & (x[i:, 3] > 0.5) & (A(x)[i:] > g)) | dwell(x, 0.2, 14)[i:])[0]
                t.append(k[0] / 100 if len(k) else 9)
            t = np.sort(t)
            print("gate %d tc %.2f thr %.2f p50 %.2f last %s n %d" % (g, tc, w - M, t[10], t[-4:], sum(t > 0.25)))
