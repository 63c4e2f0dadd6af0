import sys

sys.argv = ["x", sys.argv[1]]
exec(open("contacts.py").read().split("for side,other")[0])
ks = np.array([o[0] for o in out])
ref = np.array([-min(o[1][0], o[2][0]) for o in out])
z = G["p_WB_m.z"][ks]
ph = Rf["phase"][ks]
print(
    "ref mean %.1f sd %.1f; measured mean %.1f sd %.1f mm; optimised height mean %.1f user %.1f deficit %.1f"
    % (
        1e3 * ref.mean(),
        1e3 * ref.std(),
        1e3 * z.mean(),
        1e3 * z.std(),
        1e3 * Rf["optimised.height_m"][ks].mean(),
        1e3 * Rf["user.height_m"][ks].mean(),
        1e3 * Rf["height_deficit_m"][ks].mean(),
    )
)
ci = Rf["contact.left"][ks]
on = [i for i in range(1, len(ks)) if ci[i] > 0.5 and ci[i - 1] < 0.5]
print("phase at flag onset", [round(ph[i], 3) for i in on[:4]], "center", Rf["contact_center.left"][ks[0]])
b = (((ph - ph[on[0]]) % 1) * 25).astype(int)
for i in range(25):
    m = b == i
    print("%3d ref %.0f meas %.0f d %.0f" % (i * 4, 1e3 * ref[m].mean(), 1e3 * z[m].mean(), 1e3 * (z - ref)[m].mean()), end=" | ")
print()
