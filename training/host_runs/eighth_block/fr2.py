exec(open("/tmp/gpu17/fr.py").read().split("for tc in (.08")[0])
p0 = p
for lo, hi in ((-9, 9), (-9, 1.2), (-9, 1.0), (0, 1.2), (0.0, 9), (0.2, 9), (0.3, 1.2)):
    p = lambda x: np.clip(p0(x), lo, hi)
    for tc in (0.15, 0.2, 0.25):
        ev("clip %.1f %.1f tc %.2f" % (lo, hi, tc), lambda x: emaf(x, tc))
