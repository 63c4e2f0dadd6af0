import csv
import sys

import numpy as np

D = sys.argv[1] + "/csv/"
t0, t1, st = float(sys.argv[2]), float(sys.argv[3]), int(sys.argv[4])


def load(f):
    r = csv.reader(open(D + f))
    h = next(r)
    d = [[float(x) if x and x[0] in "-0123456789." else np.nan for x in row] for row in r]
    return {n: np.array([row[i] for row in d]) for i, n in enumerate(h)}


R = load("REFERENCE.csv")
S = load("STATE.csv")
G = load("GROUND_TRUTH.csv")
if len(sys.argv) > 5:
    print([k for k in R])
    print([k for k in S])
    print([k for k in G])
n = min(len(R["phase"]), len(G[list(G)[0]]))
tk = [k for k in G if "pos" in k or "quat" in k or "velocity" in k or "force" in k]
J = ["hip_pitch", "hip_roll", "hip_yaw", "knee", "ankle_pitch", "ankle_roll"]
for k in range(int(t0 * 100), int(t1 * 100), st):
    e = " ".join("%5.0f" % (np.degrees(S["q_rad.%s_%s" % (s, j)][k] - R["q_ref_rad.%s_%s" % (s, j)][k])) for s in ("left", "right") for j in J)
    print("%6.2f ph %.2f" % (k / 100, R["phase"][k]), "F %4.0f %4.0f" % (G["foot_force_N.left"][k], G["foot_force_N.right"][k]), e)
print("---")
for k in range(int((t1 - 2.6) * 100), int(t1 * 100), 6):
    print(
        "%6.2f ph %.3f rate %.2f gain %.2f" % (k / 100, R["phase"][k], R["phase_rate_per_s"][k], R["gain"][k]),
        " ".join(
            "%s %s"
            % (n, " ".join("%5.2f" % R["%s.%s" % (n, c)][k] for c in ("vx_m_s", "vy_m_s", "omega_rad_s", "pitch_rad", "roll_rad", "height_m")))
            for n in ("user", "command")
        ),
        "c %d %d" % (R["contact.left"][k], R["contact.right"][k]),
        "v %.2f %.2f" % (G["v_WB_W_m_s.x"][k], G["v_WB_W_m_s.y"][k]),
    )
print("+++")
for k in range(int((t1 - 1.4) * 100), int((t1 - 0.9) * 100)):
    print(
        "%6.2f ph %.3f gain %.2f F %4.0f %4.0f z %.3f vz %.2f"
        % (k / 100, R["phase"][k], R["gain"][k], G["foot_force_N.left"][k], G["foot_force_N.right"][k], G["p_WB_m.z"][k], G["v_WB_W_m_s.z"][k])
    )
