"""The exported MJCF (`pmg_sil --export-mjcf`) as MuJoCo models: a light one for training, a faithful one for evaluation."""

from pathlib import Path

import mujoco
import numpy as np


def joint_kind(name: str) -> str:
    """left_hip_pitch -> hip_pitch."""
    for side in ("left_", "right_"):
        name = name.removeprefix(side)
    return name


def policy_gains(description: dict, gains: dict) -> tuple[np.ndarray, np.ndarray]:
    """kp, kd of every joint in the robot's order [Nm/rad], [Nm s/rad]: the policy's gains on its joints, robot.yaml's on the others."""
    kinds = {joint_kind(j["name"]) for j in description["joints"] if j["policy"]}
    if kinds != set(gains):
        raise ValueError(f"gains of {', '.join(sorted(gains))}; expected exactly {', '.join(sorted(kinds))}")
    kp, kd = [], []
    for joint in description["joints"]:
        pair = (joint["kp_Nm_per_rad"], joint["kd_Nm_s_per_rad"])
        if joint["policy"]:
            pair = gains[joint_kind(joint["name"])]
        kp.append(float(pair[0]))
        kd.append(float(pair[1]))
    return np.array(kp), np.array(kd)


def _set_gains(spec: mujoco.MjSpec, description: dict, gains: dict) -> None:
    kp, kd = policy_gains(description, gains)
    for i, joint in enumerate(description["joints"]):
        actuator = spec.actuator(joint["name"])
        actuator.gainprm[0] = kp[i]
        actuator.biasprm[1], actuator.biasprm[2] = -kp[i], -kd[i]


def _check(model: mujoco.MjModel, description: dict) -> mujoco.MjModel:
    names = [j["name"] for j in description["joints"]]
    found = [model.joint(j).name for j in range(1, model.njnt)]
    actuators = [model.actuator(a).name for a in range(model.nu)]
    if found != names or actuators != names:
        raise ValueError(f"joint order of the MJCF {found} differs from the robot's {names}")
    site = model.site("imu")
    if not np.allclose(site.quat, [1, 0, 0, 0]) or model.body(site.bodyid[0]).name != description["base_link"]:
        raise ValueError("the IMU must be aligned with the base link: the batched sensors take the base's own frame")
    return model


def evaluation_model(mjcf: str | Path, description: dict, gains: dict) -> mujoco.MjModel:
    """The exported model (2 ms, implicit, all collision shapes) with the policy's gains. It equals the controller's simulation except for
    dry friction, which is MuJoCo's own here."""
    spec = mujoco.MjSpec.from_file(str(mjcf))
    _set_gains(spec, description, gains)
    return _check(spec.compile(), description)


def training_model(mjcf: str | Path, description: dict, gains: dict, physics: dict) -> mujoco.MjModel:
    """The same robot with few contacts: soles on the floor, shins and feet against the other leg's."""
    spec = mujoco.MjSpec.from_file(str(mjcf))
    _set_gains(spec, description, gains)
    soles = {f"{link}_sole": link for link in description["foot_links"]}
    for geom in list(spec.geoms):
        if geom.name in soles:
            geom.contype, geom.conaffinity, geom.condim = 0, 1, 3
        elif geom.name == "floor":
            geom.friction = [0.01, 0.005, 0.0001]  # MuJoCo takes the larger of two frictions: the sole's
        elif geom.type == mujoco.mjtGeom.mjGEOM_CAPSULE and "knee" in geom.parent.name and geom.contype:
            left = geom.parent.name.startswith("left")
            geom.contype, geom.conaffinity, geom.condim = (2, 4, 1) if left else (4, 2, 1)
        else:
            spec.delete(geom)
    for link in soles.values():
        left = link.startswith("left")
        spec.body(link).add_geom(
            type=mujoco.mjtGeom.mjGEOM_CAPSULE,
            name=f"{link}_guard",
            size=[0.035, 0, 0],
            fromto=[-0.03, 0, -0.015, 0.12, 0, -0.015],
            mass=0,
            condim=1,
            contype=2 if left else 4,
            conaffinity=4 if left else 2,
        )
    policy = {j["name"] for j in description["joints"] if j["policy"]}
    for joint in spec.joints:
        if joint.type == mujoco.mjtJoint.mjJNT_HINGE and joint.name not in policy:
            joint.frictionloss = 0.0  # it would cost an actuator model for each joint, and balance does not depend on it
    for sensor in list(spec.sensors):
        spec.delete(sensor)
    spec.option.timestep = physics["timestep_s"]
    spec.option.iterations = physics["iterations"]
    spec.option.ls_iterations = physics["ls_iterations"]
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    spec.option.cone = mujoco.mjtCone.mjCONE_PYRAMIDAL
    spec.option.jacobian = {
        "auto": mujoco.mjtJacobian.mjJAC_AUTO,
        "dense": mujoco.mjtJacobian.mjJAC_DENSE,
        "sparse": mujoco.mjtJacobian.mjJAC_SPARSE,
    }[physics["jacobian"]]
    return _check(spec.compile(), description)
