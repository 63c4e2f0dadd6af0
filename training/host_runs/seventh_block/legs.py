import csv
import sys

import numpy as np

D = sys.argv[1] + "/csv/"
t0, t1 = float(sys.argv[2]), float(sys.argv[3])


def load(f):
    r = csv.reader(open(D + f))
    h = next(r)
    d = [[float(x) if x and x[0] in "-0123456789." else np.nan for x in row] for row in r]
    return {n: np.array([row[i] for row in d]) for i, n in enumerate(h)}


S = load("STATE.csv")
J = ["hip_pitch", "knee", "ankle_pitch"]
for k in range(int(t0 * 100), int(t1 * 100)):
    print(
        "%.2f" % (k / 100),
        *(
            "%s q %s dq %s tau %s"
            % (
                s[0],
                " ".join("%5.1f" % np.degrees(S["q_rad.%s_%s" % (s, j)][k]) for j in J),
                " ".join("%5.1f" % S["dq_rad_s.%s_%s" % (s, j)][k] for j in J),
                " ".join("%5.0f" % S["torque_Nm.%s_%s" % (s, j)][k] for j in J),
            )
            for s in ("left", "right")
        ),
    )
