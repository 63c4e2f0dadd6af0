import csv
import sys

import numpy as np

D = sys.argv[1] + "/csv/"


def load(f):
    r = csv.reader(open(D + f))
    h = next(r)
    d = [[float(x) if x and x[0] in "-0123456789." else np.nan for x in row] for row in r]
    return {n: np.array([row[i] for row in d]) for i, n in enumerate(h)}


G = load("GROUND_TRUTH.csv")
R = load("REFERENCE.csv")
rows = list(csv.reader(open(D + "SCENARIO.csv")))[1:]
tr = {round(x, 2): i for i, x in enumerate(R["time_s"])}
gi = [i for i, x in enumerate(G["time_s"]) if round(x, 2) in tr]
ri = [tr[round(G["time_s"][i], 2)] for i in gi]
g = {k: v[gi] for k, v in G.items()}
r = {k: v[ri] for k, v in R.items()}
t = g["time_s"]
w, x, y, z = [g["q_WB." + c] for c in "wxyz"]
yaw = np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
vx = np.cos(yaw) * g["v_WB_W_m_s.x"] + np.sin(yaw) * g["v_WB_W_m_s.y"]
vy = -np.sin(yaw) * g["v_WB_W_m_s.x"] + np.cos(yaw) * g["v_WB_W_m_s.y"]
w, x, y, z = [g["q_WT." + c] for c in "wxyz"]
roll = np.arctan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
yr = np.gradient(np.unwrap(yaw), t)
T = 105


def avg(v):
    c = np.cumsum(np.insert(v, 0, 0))
    o = np.array([(c[i + 1] - c[max(0, i + 1 - T)]) / min(i + 1, T) for i in range(len(v))])
    return o


U = lambda n: r["user." + n]
C = lambda n: r["command." + n]
print("%-34s %6s %6s | v err foll exc | steady: user vx vy om  cmd vx vy om  got vx vy om | roll err foll  steady user got" % ("step", "", ""))
tot = np.zeros(8)
n = 0
a = {
    k: avg(v)
    for k, v in dict(
        vx=vx,
        vy=vy,
        om=yr,
        roll=roll,
        ux=U("vx_m_s"),
        uy=U("vy_m_s"),
        uo=U("omega_rad_s"),
        ur=U("roll_rad"),
        cx=C("vx_m_s"),
        cy=C("vy_m_s"),
        co=C("omega_rad_s"),
        cr=C("roll_rad"),
    ).items()
}
for i, q in enumerate(rows):
    t0 = float(q[0])
    t1 = t0 + float(q[5])
    m = (t >= t0) & (t < t1)
    s = (t >= t1 - 1.5) & (t < t1)
    ev = np.hypot(a["vx"] - a["ux"], a["vy"] - a["uy"])
    fv = np.hypot(a["cx"] - a["ux"], a["cy"] - a["uy"])
    av = np.hypot(a["vx"] - a["cx"], a["vy"] - a["cy"])
    er = abs(a["roll"] - a["ur"])
    fr = abs(a["cr"] - a["ur"])
    nv = np.hypot(a["ux"], a["uy"])
    if i > 0 and t0 < 176:
        tot += [ev[m].sum(), fv[m].sum(), nv[m].sum(), er[m].sum(), fr[m].sum(), abs(a["ur"])[m].sum(), av[m].sum(), av[s].mean() * m.sum()]
        n += m.sum()
    f = lambda *k: " ".join("%5.2f" % a[j][s].mean() for j in k)
    print(
        "%-34s | %.3f %.3f %6.3f | adm %.3f steady %.3f | %s | %s | %s | %.3f %.3f  %6.3f %6.3f"
        % (
            q[6],
            ev[m].mean(),
            fv[m].mean(),
            ev[m].mean() - fv[m].mean(),
            av[m].mean(),
            av[s].mean(),
            f("ux", "uy", "uo"),
            f("cx", "cy", "co"),
            f("vx", "vy", "om"),
            er[m].mean(),
            fr[m].mean(),
            a["ur"][s].mean(),
            a["roll"][s].mean(),
        )
    )
print(
    "v err %.4f foll %.4f none %.4f; roll %.4f %.4f %.4f; to admissible %.4f steady %.4f" % tuple(tot / n),
    "shares %.3f %.3f" % ((tot[0] - tot[1]) / (tot[2] - tot[1]), (tot[3] - tot[4]) / (tot[5] - tot[4])),
)
