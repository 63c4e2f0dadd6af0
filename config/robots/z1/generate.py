#!/usr/bin/env python3
"""Writes z1.urdf, the description of the humanoid Z1 (1.50 m, 35 kg, 31 joints), beside this file. Longer than 300 lines: most are tables.

    python3 config/robots/z1/generate.py            writes z1.urdf
    python3 config/robots/z1/generate.py --check    exits with 1 when z1.urdf is not what would be written

Z1 is a human body scaled to 1.50 m and 35 kg. Sources:
  [L96] P. de Leva, "Adjustments to Zatsiorsky-Seluyanov's segment inertia parameters", J. Biomech. 29(9):1223-1230, 1996,
        table 4, males (stature 1741 mm): segment lengths, masses, centres of mass, radii of gyration.
  [DC66] R. Drillis, R. Contini, "Body segment parameters", New York University report 1166.03, 1966, as drawn in D. Winter,
        "Biomechanics and Motor Control of Human Movement": ankle height 0.039 H, foot length 0.152 H, shoulder height 0.818 H.
Everything marked ASSUMPTION below is neither: a plausible number of this made-up robot.

A segment that carries motors is split into several links so that mass, centre of mass and inertia of the segment in the
zero posture stay exactly the table's: the main link is the segment minus its motors.
The zero posture is upright, legs straight, arms hanging. Axes: x forward, y left, z up in every link.
"""

import functools
import math
import operator
import sys
from pathlib import Path

STATURE_m = 1.50
MASS_kg = 35.0
SCALE = STATURE_m / 1.741  # [L96] lengths are of a stature of 1.741 m

# [L96] table 4, males: length [m] at 1.741 m, mass [fraction], centre of mass [fraction of the length from the first named
# end], radii of gyration about the sagittal (x), transverse (y) and longitudinal axis [fractions of the length].
TABLE = {
    "head": (0.2033, 0.0694, 0.5976, (0.362, 0.376, 0.312)),  # vertex - mid-gonion
    "upper_trunk": (0.1707, 0.1596, 0.2999, (0.716, 0.454, 0.659)),  # suprasternale - xiphion
    "middle_trunk": (0.2155, 0.1633, 0.4502, (0.482, 0.383, 0.468)),  # xiphion - omphalion
    "lower_trunk": (0.1457, 0.1117, 0.6115, (0.615, 0.551, 0.587)),  # omphalion - mid-hip
    "upper_arm": (0.2817, 0.0271, 0.5772, (0.285, 0.269, 0.158)),  # shoulder - elbow
    "forearm": (0.2689, 0.0162, 0.4574, (0.276, 0.265, 0.121)),  # elbow - wrist
    "hand": (0.0862, 0.0061, 0.7900, (0.628, 0.513, 0.401)),  # wrist - third metacarpale
    "thigh": (0.4222, 0.1416, 0.4095, (0.329, 0.329, 0.149)),  # hip - knee
    "shank": (0.4340, 0.0433, 0.4459, (0.255, 0.249, 0.103)),  # knee - lateral malleolus
    "foot": (0.2581, 0.0137, 0.4415, (0.257, 0.245, 0.124)),  # heel - toe tip
}
ANKLE_HEIGHT_m = 0.039 * STATURE_m  # [DC66]
FOOT_LENGTH_m = 0.152 * STATURE_m  # [DC66]
SHOULDER_Z_m = 0.818 * STATURE_m  # [DC66]
FOOT_WIDTH_m = 0.090  # ASSUMPTION
HEEL_TO_ANKLE_m = 0.069  # ASSUMPTION: 0.30 of the foot
HIP_Y_m = 0.095  # ASSUMPTION: half the distance of the hip joints
SHOULDER_Y_m = 0.170  # ASSUMPTION: half the distance of the shoulder joints
NECK_Z_m = 1.290  # ASSUMPTION: head joints between suprasternale and mid-gonion

# ASSUMPTION: limits of each joint: lower, upper [rad] (left side), effort [Nm], speed [rad/s]. The ranges hold human gait
# (hip -35..20, knee 0..65, ankle dorsiflexion 15, plantarflexion 30 degrees) and squats of 0.20 m (knee 1.6 rad, ankle
# -0.8 rad) with 2 degrees to spare. Hip flexion, ankle dorsiflexion and elbow flexion are negative.
LIMITS = {
    "hip_pitch": (-2.2, 0.9, 120, 16),
    "hip_roll": (-0.45, 0.9, 100, 14),
    "hip_yaw": (-0.9, 0.9, 60, 16),
    "knee": (-0.05, 2.4, 120, 18),
    "ankle_pitch": (-0.95, 0.75, 80, 16),
    "ankle_roll": (-0.4, 0.4, 40, 16),
    "waist_yaw": (-1.2, 1.2, 80, 12),
    "waist_roll": (-0.4, 0.4, 80, 12),
    "waist_pitch": (-0.4, 0.8, 80, 12),
    "shoulder_pitch": (-3.0, 1.2, 30, 14),
    "shoulder_roll": (-0.3, 2.6, 30, 14),
    "shoulder_yaw": (-1.5, 1.5, 30, 14),
    "elbow": (-2.3, 0.05, 30, 14),
    "wrist_yaw": (-1.6, 1.6, 10, 16),
    "wrist_roll": (-1.0, 1.0, 10, 16),
    "wrist_pitch": (-1.0, 1.0, 10, 16),
    "head_yaw": (-1.2, 1.2, 6, 12),
    "head_pitch": (-0.6, 0.8, 6, 12),
}
AXIS = {"roll": (1, 0, 0), "pitch": (0, 1, 0), "yaw": (0, 0, 1)}

# ASSUMPTION: motors and their housings that sit in a link of their own: mass [kg], radius [m] of an equivalent solid sphere.
MOTORS = {
    "hip_pitch": (0.60, 0.045),
    "hip_roll": (0.50, 0.040),
    "ankle_pitch": (0.05, 0.020),  # the cross of the ankle; its motors sit in the shank
    "waist_yaw": (0.50, 0.045),
    "waist_roll": (0.40, 0.040),
    "shoulder_pitch": (0.35, 0.035),
    "shoulder_roll": (0.25, 0.030),
    "wrist_yaw": (0.03, 0.015),
    "wrist_roll": (0.02, 0.015),
    "head_yaw": (0.20, 0.030),
}


def added(values):
    """Their sum, from left to right. sum() compensates rounding errors since Python 3.12 and gives other last digits than before."""
    return functools.reduce(operator.add, values)


class Body:
    """Mass [kg], centre of mass [m], inertia [kg m^2] about the centre of mass as a 3 x 3 nested list."""

    def __init__(self, mass, com, inertia):
        self.mass, self.com, self.inertia = mass, com, inertia

    @staticmethod
    def sphere(mass, radius, com):
        i = 0.4 * mass * radius * radius
        return Body(mass, com, [[i, 0, 0], [0, i, 0], [0, 0, i]])

    def about(self, point):
        d = [self.com[k] - point[k] for k in range(3)]
        dd = added(x * x for x in d)
        return [[self.inertia[r][c] + self.mass * ((dd if r == c else 0.0) - d[r] * d[c]) for c in range(3)] for r in range(3)]


def total(bodies):
    mass = added(b.mass for b in bodies)
    com = [added(b.mass * b.com[k] for b in bodies) / mass for k in range(3)]
    parts = [b.about(com) for b in bodies]
    return Body(mass, com, [[added(p[r][c] for p in parts) for c in range(3)] for r in range(3)])


def without(whole, parts):
    """The body that together with the parts makes the whole."""
    return total([whole] + [Body(-p.mass, p.com, [[-x for x in row] for row in p.inertia]) for p in parts])


def moved(body, by):
    return Body(body.mass, [body.com[k] + by[k] for k in range(3)], body.inertia)


def length(segment):
    return TABLE[segment][0] * SCALE


def hanging(segment, top=(0.0, 0.0, 0.0)):
    """A segment whose long axis is z, its first end at top."""
    _, mass, com, radii = TABLE[segment]
    size = length(segment)
    inertia = [[(MASS_kg * mass * (radii[r] * size) ** 2 if r == c else 0.0) for c in range(3)] for r in range(3)]
    return Body(MASS_kg * mass, [top[0], top[1], top[2] - com * size], inertia)


def foot_segment():
    """The foot seen from the ankle: long axis x, transverse axis y; centre of mass at half the ankle's height (ASSUMPTION)."""
    _, mass, com, (sagittal, transverse, longitudinal) = TABLE["foot"]
    m, radii = MASS_kg * mass, (longitudinal, transverse, sagittal)
    inertia = [[(m * (radii[r] * FOOT_LENGTH_m) ** 2 if r == c else 0.0) for c in range(3)] for r in range(3)]
    return Body(m, [com * FOOT_LENGTH_m - HEEL_TO_ANKLE_m, 0.0, -0.5 * ANKLE_HEIGHT_m], inertia)


THIGH, SHANK = length("thigh"), length("shank")
UPPER_ARM, FOREARM = length("upper_arm"), length("forearm")
HIP_Z = ANKLE_HEIGHT_m + SHANK + THIGH  # mid-hip above the sole: the pelvis' origin
WAIST = length("lower_trunk")  # omphalion above mid-hip
CHEST = length("middle_trunk") + length("upper_trunk")  # suprasternale above omphalion
SHOULDER = SHOULDER_Z_m - HIP_Z - WAIST  # above the waist joints
NECK = NECK_Z_m - HIP_Z - WAIST
TOP = STATURE_m - NECK_Z_m  # vertex above the head joints


def motor(name, com=(0.0, 0.0, 0.0)):
    mass, radius = MOTORS[name]
    return Body.sphere(mass, radius, list(com))


def bodies():
    """Every link's Body in the link's own frame, right side and left side alike (all segments are symmetric)."""
    torso = total([hanging("upper_trunk", (0, 0, CHEST)), hanging("middle_trunk", (0, 0, length("middle_trunk")))])
    torso_motors = [motor("waist_yaw"), motor("waist_roll")]
    for y in (SHOULDER_Y_m, -SHOULDER_Y_m):
        torso_motors += [motor(n, (0, y, SHOULDER)) for n in ("shoulder_pitch", "shoulder_roll")]
    links = {name + "_link": motor(name) for name in MOTORS}
    links["pelvis"] = hanging("lower_trunk", (0, 0, WAIST))
    links["torso"] = without(torso, torso_motors)
    links["head"] = without(hanging("head", (0, 0, TOP)), [motor("head_yaw")])
    links["hip_yaw_link"] = without(hanging("thigh"), [motor("hip_pitch"), motor("hip_roll")])
    links["knee_link"] = hanging("shank")
    links["ankle_roll_link"] = without(foot_segment(), [motor("ankle_pitch")])
    links["shoulder_yaw_link"] = hanging("upper_arm")
    links["elbow_link"] = without(hanging("forearm"), [motor(n, (0, 0, -FOREARM)) for n in ("wrist_yaw", "wrist_roll")])
    links["wrist_pitch_link"] = hanging("hand")
    return links


# ---- looks ---------------------------------------------------------------------------------------------------------
MATERIALS = {
    "shell": (0.90, 0.91, 0.93, 1.0),
    "graphite": (0.17, 0.18, 0.21, 1.0),
    "metal": (0.45, 0.47, 0.51, 1.0),
    "accent": (0.93, 0.42, 0.13, 1.0),
    "visor": (0.04, 0.06, 0.09, 1.0),
}


def box(center, size, material=None, rpy=(0, 0, 0)):
    return ("box", center, rpy, size, material)


def sphere(center, radius, material=None):
    return ("sphere", center, (0, 0, 0), radius, material)


def cylinder(start, end, radius, material=None):
    d = [end[k] - start[k] for k in range(3)]
    flat = math.hypot(d[0], d[1])
    rpy = (0.0, math.atan2(flat, d[2]), math.atan2(d[1], d[0]) if flat > 0 else 0.0)
    center = [0.5 * (start[k] + end[k]) for k in range(3)]
    return ("cylinder", center, rpy, (radius, math.hypot(flat, d[2])), material)


def capsule(start, end, radius, material):
    return [cylinder(start, end, radius, material), sphere(start, radius, material), sphere(end, radius, material)]


def rounded_box(center, size, radius, material):
    """A box whose vertical edges are rounded: two boxes and four cylinders."""
    x, y, z = center
    sx, sy, sz = size
    parts = [box(center, (sx - 2 * radius, sy, sz), material), box(center, (sx, sy - 2 * radius, sz), material)]
    for dx in (-1, 1):
        for dy in (-1, 1):
            cx, cy = x + dx * (0.5 * sx - radius), y + dy * (0.5 * sy - radius)
            parts.append(cylinder((cx, cy, z - 0.5 * sz), (cx, cy, z + 0.5 * sz), radius, material))
    return parts


def hub(axis, half_length, radius, material, at=(0, 0, 0)):
    """A motor's housing: a cylinder about the joint's axis."""
    start = [at[k] - half_length * axis[k] for k in range(3)]
    end = [at[k] + half_length * axis[k] for k in range(3)]
    return cylinder(start, end, radius, material)


X, Y, Z = (1, 0, 0), (0, 1, 0), (0, 0, 1)


def looks(side):
    """Visuals and collision bodies by link; side is +1 for the left and -1 for the right."""
    foot_x = 0.5 * FOOT_LENGTH_m - HEEL_TO_ANKLE_m
    hand = length("hand")
    visual = {
        "pelvis": rounded_box((0, 0, 0.062), (0.13, 0.21, 0.05), 0.045, "shell")
        + rounded_box((0, 0, 0.030), (0.11, 0.13, 0.05), 0.040, "shell")
        + [box((0, 0, -0.005), (0.08, 0.07, 0.06), "graphite"), cylinder((0, 0, 0.08), (0, 0, WAIST - 0.03), 0.055, "graphite")],
        "waist_yaw_link": [hub(Z, 0.02, 0.058, "metal", (0, 0, -0.015))],
        "waist_roll_link": [hub(X, 0.05, 0.036, "graphite")],
        "torso": [hub(Y, 0.065, 0.034, "metal")]
        + rounded_box((0, 0, 0.070), (0.12, 0.15, 0.08), 0.045, "graphite")
        + rounded_box((0, 0, 0.130), (0.145, 0.195, 0.04), 0.055, "shell")
        + rounded_box((0, 0, 0.215), (0.17, 0.24, 0.14), 0.065, "shell")
        + rounded_box((0, 0, 0.297), (0.14, 0.20, 0.026), 0.060, "shell")
        + [
            box((0.087, 0, 0.250), (0.008, 0.09, 0.016), "accent"),
            cylinder((0.080, 0, 0.205), (0.092, 0, 0.205), 0.020, "graphite"),
            cylinder((0.086, 0, 0.205), (0.0935, 0, 0.205), 0.013, "accent"),
            cylinder((0, 0, 0.31), (0, 0, NECK - 0.01), 0.035, "graphite"),
        ]
        + rounded_box((-0.085, 0, 0.210), (0.05, 0.16, 0.13), 0.020, "graphite")
        + [hub(Y, 0.025, 0.036, "graphite", (0, s * (SHOULDER_Y_m - 0.045), SHOULDER)) for s in (1, -1)],
        "head_yaw_link": [hub(Z, 0.018, 0.040, "metal")],
        "head": [
            hub(Y, 0.045, 0.026, "graphite"),
            sphere((0, 0, TOP - 0.085), 0.085, "shell"),
            cylinder((0, 0, 0.035), (0, 0, TOP - 0.085), 0.062, "shell"),
            sphere((0.018, 0, TOP - 0.135), 0.055, "shell"),
            cylinder((0.014, 0, TOP - 0.108), (0.014, 0, TOP - 0.062), 0.079, "visor"),
        ]
        + [hub(Y, 0.012, 0.026, "accent", (-0.010, s * 0.078, TOP - 0.090)) for s in (1, -1)],
        "hip_pitch_link": [hub(Y, 0.032, 0.047, "metal")],
        "hip_roll_link": [hub(X, 0.052, 0.040, "graphite")],
        "hip_yaw_link": capsule((0, 0, -0.085), (0, 0, -THIGH + 0.075), 0.054, "shell")
        + [
            cylinder((0, 0, -0.03), (0, 0, -0.09), 0.046, "graphite"),
            box((0, side * 0.050, -0.19), (0.03, 0.012, 0.13), "accent"),
            cylinder((0, 0, -THIGH + 0.08), (0, 0, -THIGH + 0.02), 0.042, "graphite"),
        ],
        "knee_link": [hub(Y, 0.047, 0.045, "metal"), hub(Y, 0.052, 0.028, "accent")]
        + capsule((-0.004, 0, -0.09), (-0.004, 0, -SHANK + 0.10), 0.044, "shell")
        + [cylinder((0, 0, -0.03), (0, 0, -0.10), 0.038, "graphite"), cylinder((0, 0, -0.20), (0, 0, -SHANK + 0.02), 0.030, "graphite")],
        "ankle_pitch_link": [hub(Y, 0.036, 0.026, "metal")],
        "ankle_roll_link": [hub(X, 0.040, 0.022, "graphite"), box((-0.005, 0, -0.024), (0.10, 0.055, 0.026), "graphite")]
        + rounded_box((foot_x, 0, -ANKLE_HEIGHT_m + 0.006), (FOOT_LENGTH_m, FOOT_WIDTH_m, 0.012), 0.040, "graphite")
        + rounded_box((foot_x - 0.004, 0, -ANKLE_HEIGHT_m + 0.021), (FOOT_LENGTH_m - 0.02, FOOT_WIDTH_m - 0.012, 0.018), 0.036, "shell"),
        "shoulder_pitch_link": [hub(Y, 0.032, 0.042, "metal")],
        "shoulder_roll_link": [sphere((0, side * 0.010, 0.006), 0.046, "shell"), hub(X, 0.049, 0.024, "metal")],
        "shoulder_yaw_link": capsule((0, 0, -0.065), (0, 0, -UPPER_ARM + 0.055), 0.036, "shell")
        + [
            cylinder((0, 0, -0.02), (0, 0, -0.07), 0.030, "graphite"),
            cylinder((0, 0, -UPPER_ARM + 0.05), (0, 0, -UPPER_ARM + 0.01), 0.028, "graphite"),
        ],
        "elbow_link": [hub(Y, 0.034, 0.033, "metal"), hub(Y, 0.038, 0.019, "accent")]
        + capsule((0, 0, -0.065), (0, 0, -FOREARM + 0.06), 0.032, "shell")
        + [cylinder((0, 0, -0.02), (0, 0, -0.07), 0.026, "graphite")],
        "wrist_yaw_link": [hub(Z, 0.022, 0.025, "graphite", (0, 0, 0.012))],
        "wrist_roll_link": [hub(X, 0.024, 0.019, "metal")],
        "wrist_pitch_link": [hub(Y, 0.022, 0.017, "graphite")]
        + rounded_box((0, 0, -0.5 * hand - 0.008), (0.070, 0.028, hand - 0.008), 0.013, "graphite")
        + capsule((0, 0, -hand - 0.005), (0.004, -side * 0.008, -hand - 0.055), 0.013, "graphite")
        + capsule((0.022, 0, -hand - 0.005), (0.026, -side * 0.008, -hand - 0.045), 0.012, "graphite")
        + capsule((-0.022, 0, -hand - 0.005), (-0.022, -side * 0.008, -hand - 0.045), 0.012, "graphite")
        + capsule((0.034, -side * 0.006, -0.030), (0.050, -side * 0.016, -0.065), 0.011, "graphite"),
    }
    collision = {
        "pelvis": [box((0, 0, 0.060), (0.13, 0.19, 0.080))],
        "torso": [box((0, 0, 0.190), (0.17, 0.230, 0.230))],
        "head": [sphere((0, 0, TOP - 0.085), 0.085)],
        "hip_yaw_link": [cylinder((0, 0, -0.09), (0, 0, -THIGH + 0.04), 0.054)],
        "knee_link": [cylinder((0, 0, -0.05), (0, 0, -SHANK + 0.05), 0.046)],
        "ankle_roll_link": [box((foot_x, 0, -0.5 * (ANKLE_HEIGHT_m + 0.012)), (FOOT_LENGTH_m, FOOT_WIDTH_m, ANKLE_HEIGHT_m - 0.012))],
        "shoulder_yaw_link": [cylinder((0, 0, -0.07), (0, 0, -UPPER_ARM + 0.04), 0.036)],
        "elbow_link": [cylinder((0, 0, -0.04), (0, 0, -FOREARM + 0.02), 0.033)],
        "wrist_pitch_link": [sphere((0, 0, -hand), 0.040)],
    }
    return visual, collision


# ---- URDF ----------------------------------------------------------------------------------------------------------
LEG = ("hip_pitch", "hip_roll", "hip_yaw", "knee", "ankle_pitch", "ankle_roll")
ARM = ("shoulder_pitch", "shoulder_roll", "shoulder_yaw", "elbow", "wrist_yaw", "wrist_roll", "wrist_pitch")
ORIGIN = {"knee": (0, 0, -THIGH), "ankle_pitch": (0, 0, -SHANK), "elbow": (0, 0, -UPPER_ARM), "wrist_yaw": (0, 0, -FOREARM)}


def number(value):
    """Nine significant digits: far below any tolerance of the description, and the same text on every machine."""
    text = f"{value:.9g}"
    return "0" if text == "-0" else text


def vector(values):
    return " ".join(number(v) for v in values)


def geometry(kind, what, size, material, origin, rpy):
    shape = {
        "box": lambda: f'<box size="{vector(size)}"/>',
        "sphere": lambda: f'<sphere radius="{number(size)}"/>',
        "cylinder": lambda: f'<cylinder radius="{number(size[0])}" length="{number(size[1])}"/>',
    }[kind]()
    paint = f'<material name="{material}"/>' if material else ""
    return f'    <{what}><origin xyz="{vector(origin)}" rpy="{vector(rpy)}"/><geometry>{shape}</geometry>{paint}</{what}>'


def link(name, kind, side, links):
    body = links[kind]
    visual, collision = looks(side)
    lines = [f'  <link name="{name}">']
    i = body.inertia
    lines.append(
        f'    <inertial><origin xyz="{vector(body.com)}" rpy="0 0 0"/><mass value="{number(body.mass)}"/>'
        f'<inertia ixx="{number(i[0][0])}" ixy="{number(i[0][1])}" ixz="{number(i[0][2])}" '
        f'iyy="{number(i[1][1])}" iyz="{number(i[1][2])}" izz="{number(i[2][2])}"/></inertial>'
    )
    for shape, center, rpy, size, material in visual.get(kind, []):
        lines.append(geometry(shape, "visual", size, material, center, rpy))
    for shape, center, rpy, size, _ in collision.get(kind, []):
        lines.append(geometry(shape, "collision", size, None, center, rpy))
    return lines + ["  </link>"]


def joint(name, kind, side, parent, child, origin):
    lower, upper, effort, speed = LIMITS[kind]
    if side < 0 and kind.endswith(("roll", "yaw")):
        lower, upper = -upper, -lower
    axis = AXIS.get(kind.rsplit("_", 1)[-1], AXIS["pitch"])
    return [
        f'  <joint name="{name}" type="revolute">',
        f'    <parent link="{parent}"/><child link="{child}"/>',
        f'    <origin xyz="{vector(origin)}" rpy="0 0 0"/><axis xyz="{vector(axis)}"/>',
        f'    <limit lower="{number(lower)}" upper="{number(upper)}" effort="{number(effort)}" velocity="{number(speed)}"/>',
        "  </joint>",
    ]


def urdf():
    links = bodies()
    check(links)
    lines = [
        '<?xml version="1.0"?>',
        "<!-- Written by generate.py: change that, not this. Masses and inertias after de Leva 1996 (J. Biomech. 29:1223-1230), males,",
        "     scaled to 1.50 m and 35 kg; sources and assumptions are in generate.py. -->",
        '<robot name="z1">',
    ]
    for name, rgba in MATERIALS.items():
        lines.append(f'  <material name="{name}"><color rgba="{vector(rgba)}"/></material>')
    lines += link("pelvis", "pelvis", 1, links)

    def chain(parent, names, prefix, side, start, last=None):
        for index, kind in enumerate(names):
            child = last if last and index == len(names) - 1 else f"{prefix}{kind}_link"
            look = last if child == last else f"{kind}_link"
            lines.extend(joint(prefix + kind, kind, side, parent, child, start if index == 0 else ORIGIN.get(kind, (0, 0, 0))))
            lines.extend(link(child, look, side, links))
            parent = child

    for prefix, side in (("left_", 1), ("right_", -1)):
        chain("pelvis", LEG, prefix, side, (0, side * HIP_Y_m, 0))
    chain("pelvis", ("waist_yaw", "waist_roll", "waist_pitch"), "", 1, (0, 0, WAIST), "torso")
    for prefix, side in (("left_", 1), ("right_", -1)):
        chain("torso", ARM, prefix, side, (0, side * SHOULDER_Y_m, SHOULDER))
    chain("torso", ("head_yaw", "head_pitch"), "", 1, (0, 0, NECK), "head")
    return "\n".join(lines + ["</robot>", ""])


def check(links):
    """Fails when a link that was cut out of a segment isn't a body: mass or a principal moment not positive."""
    pairs = added(links[n].mass * (2 if n.startswith(("hip", "knee", "ankle", "shoulder", "elbow", "wrist")) else 1) for n in links)
    assert abs(pairs - MASS_kg) < 1e-9, pairs
    for name, body in links.items():
        i = body.inertia
        minors = (i[0][0], i[0][0] * i[1][1] - i[0][1] ** 2)
        assert body.mass > 0 and all(m > 0 for m in minors), name
        trace = i[0][0] + i[1][1] + i[2][2]
        d = [[(0.5 * trace if r == c else 0.0) - i[r][c] for c in range(3)] for r in range(3)]  # density-weighted covariance
        det = (
            d[0][0] * (d[1][1] * d[2][2] - d[1][2] * d[2][1])
            - d[0][1] * (d[1][0] * d[2][2] - d[1][2] * d[2][0])
            + d[0][2] * (d[1][0] * d[2][1] - d[1][1] * d[2][0])
        )
        assert d[0][0] > 0 and d[0][0] * d[1][1] > d[0][1] ** 2 and det > 0, f"{name}: no such body"


def main():
    target = Path(__file__).resolve().parent / "z1.urdf"
    text = urdf()
    if sys.argv[1:] == ["--check"]:
        if not target.exists() or target.read_text() != text:
            print(f"{target.name} is not what generate.py writes: run config/robots/z1/generate.py", file=sys.stderr)
            return 1
        return 0
    if sys.argv[1:]:
        print(__doc__, file=sys.stderr)
        return 2
    target.write_text(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
