import csv
import sys

import numpy as np

D = sys.argv[1]


def load(f):
    r = csv.reader(open(D + "/csv/" + f))
    h = next(r)
    d = [[float(x) if x and x[0] in "-0123456789." else np.nan for x in row] for row in r]
    return {n: np.array([row[i] for row in d]) for i, n in enumerate(h)}


G = load("GROUND_TRUTH.csv")
ST = load("STATUS.csv")
S = load("STATE.csv")
F = np.array([[float(x) for x in (l.split()[1], l.split()[2], l.split()[4], l.split()[5])] for l in open(D + ".fl") if l.startswith("FL")])
T = (G["foot_force_N.left"] + G["foot_force_N.right"]) / 343.0
s = F[:, 0] + F[:, 1]
off = len(T) - len(F)
print("len", len(T), len(F))
T = T[off:]
print("rms err", np.sqrt(np.mean((s - T) ** 2)), "low true <.25:", np.mean(T < 0.25))
b = s < 0.25
i = 0
runs = []
while i < len(b):
    if b[i]:
        j = i
        while j < len(b) and b[j]:
            j += 1
        runs.append((j - i, i))
        i = j
    else:
        i += 1
runs.sort(reverse=True)
for n, i in runs[:6]:
    print(
        "t %.2f n %d est %.2f true mean %.2f  az %s" % ((i + off) / 100, n, s[i : i + n].mean(), T[i : i + n].mean(), ""),
        " ".join("%.1f" % x for x in T[i - 6 : i + n + 4]),
    )
    k = i + off
    print(
        "   knees",
        np.degrees(S["q_rad.left_knee"][k : k + n : 2]).round(),
        np.degrees(S["q_rad.right_knee"][k : k + n : 2]).round(),
        [k for k in S if "accel" in k][:3],
    )
for n, i in runs[:3]:
    for d in range(-8, n + 6, 2):
        k = i + off + d
        print(
            "%.2f est L %.2f R %.2f true %.2f %.2f sd %.2f %.2f"
            % (k / 100, F[i + d, 0], F[i + d, 1], G["foot_force_N.left"][k] / 343, G["foot_force_N.right"][k] / 343, F[i + d, 2], F[i + d, 3]),
            "knee %.0f %.0f" % tuple(np.degrees([S["q_rad.left_knee"][k], S["q_rad.right_knee"][k]])),
            "acc %.1f gyro %.1f %.1f %.1f"
            % (np.linalg.norm([S["acceleration_m_s2." + c][k] for c in "xyz"]), *[S["gyro_rad_s." + c][k] for c in "xyz"]),
            "st tau",
            *["%.0f" % S["torque_Nm.right_" + j][k] for j in ("hip_pitch", "hip_roll", "knee", "ankle_pitch")],
        )
    print()
