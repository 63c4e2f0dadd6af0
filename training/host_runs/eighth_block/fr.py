exec(open("/tmp/gpu17/ana.py").read().split("for tc in")[0])


def emaf(x, tc, limit=0.5, w=lambda h: float(h > 0.5)):
    v = p(x)
    a = 1 - np.exp(-0.01 / tc)
    y = np.empty_like(v)
    s = v[0]
    for i, z in enumerate(v):
        s += a * w(x[i, 3]) * (z - s)
        y[i] = s
    return y


for tc in (0.08, 0.1, 0.12, 0.15, 0.2):
    ev("freeze %.2f" % tc, lambda x: emaf(x, tc))
