# landing.py CSV_DIR (of `pmg_log export RUN --csv CSV_DIR`): pelvis, soles and ankles by phase since the left initial contact, measured and reference, last 8 s
import csv
import math
import sys

D = sys.argv[1] + "/"


def load(f, cols):
    r = csv.reader(open(D + f))
    h = next(r)
    ix = [h.index(c) for c in cols]
    return [[float(x[i]) for i in ix] for x in r], h


def mm(A, B):
    return [[sum(A[i][k] * B[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def mv(A, v):
    return [sum(A[i][k] * v[k] for k in range(3)) for i in range(3)]


def R(ax, q):
    c, s = math.cos(q), math.sin(q)
    return {"x": [[1, 0, 0], [0, c, -s], [0, s, c]], "y": [[c, 0, s], [0, 1, 0], [-s, 0, c]], "z": [[c, -s, 0], [s, c, 0], [0, 0, 1]]}[ax]


J = ["hip_pitch", "hip_roll", "hip_yaw", "knee", "ankle_pitch", "ankle_roll"]


def foot(RB, q, side):
    sy = 1 if side == "left" else -1
    OFF = [(0, 0.095 * sy, 0), (0, 0, 0), (0, 0, 0), (0, 0, -0.363756462), (0, 0, -0.373923033), (0, 0, 0)]
    M = RB
    p = [0, 0, 0]
    for o, a, x in zip(OFF, ["y", "x", "z", "y", "y", "x"], q):
        d = mv(M, o)
        p = [p[i] + d[i] for i in range(3)]
        M = mm(M, R(a, x))
    low = 9
    for X in (0.159, -0.069):
        for Y in (0.045, -0.045):
            z = p[2] + mv(M, (X, Y, -0.0585))[2]
            low = min(low, z)
    return low, p, math.degrees(math.asin(M[2][0]))


g, h = load("GROUND_TRUTH.csv", ["p_WB_m.z", "foot_force_N.left", "foot_force_N.right"])
hq = [c for c in h if c.startswith("q_WB")]
G, _ = load("GROUND_TRUTH.csv", hq)
P, _ = load("GROUND_TRUTH.csv", ["p_WB_m.x"])
S, _ = load("STATE.csv", ["q_rad.%s_%s" % (s, j) for s in ("left", "right") for j in J])
rc = ["q_ref_rad.%s_%s" % (s, j) for s in ("left", "right") for j in J] + [
    "q_ref_rad.waist_roll",
    "q_ref_rad.waist_pitch",
    "phase",
    "contact_center.left",
    "optimised.height_m",
    "height_deficit_m",
]
Q, _ = load("REFERENCE.csv", rc)
n = min(len(g), len(S), len(Q))
print(n, len(g), len(S), len(Q), hq)
bins = {}
for k in range(n - 800, n - 1):
    ph = Q[k][14]
    since = (ph - (Q[k][15] - 0.31)) % 1.0
    b = int(since * 50)
    w, x, y, z = G[k]
    yaw = math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    RW = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    RB = mm(R("z", -yaw), RW)
    roll = math.atan2(RB[2][1], RB[2][2])
    pit = math.asin(-RB[2][0])
    RR = mm(R("x", -Q[k][12]), R("y", -Q[k][13]))
    ml, mpl, mt = foot(RB, S[k][:6], "left")
    mr, mpr, _ = foot(RB, S[k][6:12], "right")
    rl, rpl, rt = foot(RR, Q[k][:6], "left")
    rr, rpr, _ = foot(RR, Q[k][6:12], "right")
    zr = 0.0 + Q[k][16]
    bins.setdefault(b, []).append(
        [g[k][0], -min(rl, rr), ml, rl, mr, rr, mpl[0], rpl[0], roll, -Q[k][12], pit, -Q[k][13], mt, rt, g[k][1], g[k][2], mpr[0], rpr[0]]
        + [S[k][i] - Q[k][i] for i in (0, 3, 4)]
    )
print(
    "%  pelvis z meas ref diff | left sole meas ref diff | right sole diff | ankle x left meas ref | right | roll m r | pitch m r | toes m r | FL FR | dq hip knee ankle"
)
for b in sorted(bins):
    v = [sum(c) / len(c) for c in zip(*bins[b])]
    print(
        "%3d %6.1f %6.1f %5.1f | %6.1f %6.1f %5.1f | %5.1f | %5.0f %5.0f | %5.0f %5.0f | %5.3f %5.3f | %5.3f %5.3f | %5.1f %5.1f | %4.0f %4.0f | %5.1f %5.1f %5.1f"
        % (
            b * 2,
            v[0] * 1e3,
            v[1] * 1e3,
            (v[0] - v[1]) * 1e3,
            v[2] * 1e3,
            v[3] * 1e3,
            (v[2] - v[3]) * 1e3,
            (v[4] - v[5]) * 1e3,
            v[6] * 1e3,
            v[7] * 1e3,
            v[16] * 1e3,
            v[17] * 1e3,
            v[8],
            v[9],
            v[10],
            v[11],
            v[12],
            v[13],
            v[14],
            v[15],
            *[math.degrees(a) for a in v[18:]],
        )
    )
