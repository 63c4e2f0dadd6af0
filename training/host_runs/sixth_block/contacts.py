import csv
import math
import sys

import numpy as np

D = sys.argv[1] + "/csv/"


def load(f):
    r = csv.reader(open(D + f))
    h = next(r)
    d = [[float(x) if x and x[0] in "-0123456789." else np.nan for x in row] for row in r]
    return {n: np.array([row[i] for row in d]) for i, n in enumerate(h)}


Rf = load("REFERENCE.csv")
S = load("STATE.csv")
G = load("GROUND_TRUTH.csv")
J = ["hip_pitch", "hip_roll", "hip_yaw", "knee", "ankle_pitch", "ankle_roll"]


def Rm(ax, q):
    c, s = math.cos(q), math.sin(q)
    return np.array({"x": [[1, 0, 0], [0, c, -s], [0, s, c]], "y": [[c, 0, s], [0, 1, 0], [-s, 0, c]], "z": [[c, -s, 0], [s, c, 0], [0, 0, 1]]}[ax])


def low(RB, q, side):
    sy = 1 if side == "left" else -1
    OFF = [(0, 0.095 * sy, 0), (0, 0, 0), (0, 0, 0), (0, 0, -0.363756462), (0, 0, -0.373923033), (0, 0, 0)]
    M = RB
    p = np.zeros(3)
    for o, a, x in zip(OFF, ["y", "x", "z", "y", "y", "x"], q):
        p = p + M @ np.array(o)
        M = M @ Rm(a, x)
    c = np.array([p + M @ np.array((X, Y, -0.0585)) for X in (0.159, -0.069) for Y in (0.045, -0.045)])
    heel = min(c[2][2], c[3][2])
    toe = min(c[0][2], c[1][2])
    return min(heel, toe), heel, toe


n = len(Rf["phase"])
T = n - 900
out = []
for k in range(n - 900, n - 1):
    RR = Rm("x", -Rf["q_ref_rad.waist_roll"][k]) @ Rm("y", -Rf["q_ref_rad.waist_pitch"][k])
    l = {s: low(RR, [Rf["q_ref_rad.%s_%s" % (s, j)][k] for j in J], s) for s in ("left", "right")}
    out.append((k, l["left"], l["right"]))
for side, other in (("left", "right"), ("right", "left")):
    i = 1 if side == "left" else 2
    o = 3 - i
    ev = []
    c = Rf["contact." + side]
    rate = Rf["phase_rate_per_s"]
    for a in range(1, len(out)):
        k = out[a][0]
        if c[k] > 0.5 and c[k - 1] < 0.5:
            ev.append(a)
    rows = []
    for a in ev:
        if a < 30 or a > len(out) - 20:
            continue
        k = out[a][0]
        # relative height of landing foot over stance foot around
        rel = [1e3 * (out[a + d][i][0] - out[a + d][o][0]) for d in range(-12, 12)]
        f = np.array([G["foot_force_N." + side][k + d] for d in range(-12, 12)])
        rows.append(
            (
                rel,
                f,
                [Rf["contact_weight." + side][k + d] for d in range(-12, 12)],
                [1e3 * Rf["foot_height_m." + side][k + d] for d in range(-12, 12)],
            )
        )
    rel = np.mean([r[0] for r in rows], 0)
    f = np.mean([r[1] for r in rows], 0)
    w = np.mean([r[2] for r in rows], 0)
    fh = np.mean([r[3] for r in rows], 0)
    print(side, len(rows), "ticks from scheduled contact; tick = %.2f %% of cycle" % (rate[n - 100]))
    print(" d    ", " ".join("%5d" % d for d in range(-12, 12)))
    print(" rel mm", " ".join("%5.1f" % x for x in rel))
    print(" footh ", " ".join("%5.1f" % x for x in fh))
    print(" weight", " ".join("%5.2f" % x for x in w))
    print(" force ", " ".join("%5.0f" % x for x in f))
