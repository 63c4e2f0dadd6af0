import glob
import re
import xml.etree.ElementTree as ET

import numpy as np


def parse(lines):
    r = []
    for l in lines:
        f = l.split()
        r.append([float(f[i]) for i in (1, 2, 4, 5, 7, 8, 9, 10, 12, 13, 15, 17, 19)])
    return np.array(r)


lift = []
cur = []
for l in open("lw.txt", errors="replace"):
    if "[ RUN" in l:
        cur = []
    elif l.startswith("FL") and len(l.split()) >= 22:
        cur.append(l)
    elif ("[  FAILED" in l and "ms)" in l) or "[       OK" in l:
        lift.append(parse(cur))
        print(len(cur))
clear = [float(re.search(r"lifted ([0-9.]+) s", p.get("value")).group(1)) for p in ET.parse("lw.xml").iter("property") if p.get("name") == "figures"]
walk = {g: parse([l for l in open(g) if l.startswith("FL") and len(l.split()) >= 22]) for g in sorted(glob.glob("wl/*.fl"))}
print(len(lift), len(clear), [len(x) for x in walk.values()])
np.save("lift.npy", np.array(lift, dtype=object), allow_pickle=True)
np.save("clear.npy", clear)
np.save("walk.npy", np.array(list(walk.values()), dtype=object), allow_pickle=True)
