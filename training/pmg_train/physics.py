"""mujoco_warp worlds whose state and per-world parameters are torch tensors on the same memory."""

import mujoco
import mujoco_warp as mjw
import torch
import warp as wp

from pmg_train.actuation import step_inertia
from pmg_train.randomization import Robots

BATCHED = ("geom_friction", "body_mass", "body_inertia", "body_ipos", "actuator_gainprm", "actuator_biasprm", "dof_armature",
           "dof_frictionloss")


@wp.kernel
def _sole_forces(contacts: wp.array(dtype=int), geom: wp.array(dtype=wp.vec2i), world: wp.array(dtype=int),
                 dim: wp.array(dtype=int), address: wp.array2d(dtype=int), force: wp.array2d(dtype=float),
                 capacity: int, left: int, right: int, out: wp.array2d(dtype=float)):
    c = wp.tid()
    if c >= wp.min(contacts[0], capacity):
        return
    foot = int(-1)
    pair = geom[c]
    if pair[0] == left or pair[1] == left:
        foot = 0
    if pair[0] == right or pair[1] == right:
        foot = 1
    if foot < 0 or dim[c] != 3:
        return
    normal = float(0.0)
    for k in range(4):  # pyramidal cone: the normal force is the sum over the edges
        row = address[c, k]
        if row >= 0:
            normal += force[world[c], row]
    wp.atomic_add(out, world[c], foot, normal)


class Worlds:
    """`substeps` physics steps a call. Positions and forces of bodies are those of the last substep's start."""

    def __init__(self, model: mujoco.MjModel, worlds: int, substeps: int, foot_links: list[str], limits: dict,
                 device: str):
        self.model, self.device = model, device
        self.deployed_step_s = limits["deployed_timestep_s"]
        with wp.ScopedDevice(device):
            self.m = mjw.put_model(model, batch_sizes={name: worlds for name in BATCHED})
            self.d = mjw.make_data(model, nworld=worlds, nconmax=limits["contacts_per_world"],
                                   njmax=limits["constraints_per_world"])
        view = wp.to_torch
        self.qpos, self.qvel, self.warmstart = view(self.d.qpos), view(self.d.qvel), view(self.d.qacc_warmstart)
        self.xpos, self.xquat, self.torque = view(self.d.xpos), view(self.d.xquat), view(self.d.actuator_force)
        self.torch_device = self.qpos.device
        self.target = [torch.zeros(worlds, model.nu, device=self.torch_device) for _ in range(substeps)]
        self._target_warp = [wp.from_torch(t) for t in self.target]
        self.sole_force = torch.zeros(worlds, 2, device=self.torch_device)
        self._sole_force_warp = wp.from_torch(self.sole_force)
        self._soles = [model.geom(f"{link}_sole").id for link in foot_links]
        self._graph = None

    def apply(self, robots: Robots, torso: str) -> None:
        """Writes the drawn parameters into the worlds."""
        model, view = self.model, wp.to_torch
        for sole in self._soles:
            view(self.m.geom_friction)[:, sole, 0] = robots.friction
        view(self.m.body_mass).copy_(robots.body_mass)
        view(self.m.body_inertia)[:] *= robots.link_mass[:, :, None]
        view(self.m.body_ipos)[:, model.body(torso).id] += robots.torso_com
        view(self.m.actuator_gainprm)[:, :, 0] *= robots.kp
        bias = view(self.m.actuator_biasprm)
        bias[:, :, 1] *= robots.kp
        bias[:, :, 2] *= robots.kd
        self._set_armature(robots.armature)
        view(self.m.dof_frictionloss)[:, 6:] *= robots.joint_friction

    def _set_armature(self, factor: torch.Tensor) -> None:
        """The drawn one, less what the damping in these longer steps adds."""
        model, armature = self.model, wp.to_torch(self.m.dof_armature)[:, 6:]
        kd = torch.tensor(model.dof_damping[6:] - model.actuator_biasprm[:, 2], dtype=torch.float32, device=self.torch_device)
        added = step_inertia(kd, model.opt.timestep, self.deployed_step_s)
        armature.copy_(torch.maximum(armature * factor - added, 0.1 * armature))

    def capture(self) -> None:
        """Compiles; on a GPU also records one call as a CUDA graph."""
        with wp.ScopedDevice(self.device):
            self._step()
            if self.device.startswith("cuda"):
                wp.synchronize()
                with wp.ScopedCapture() as recorded:
                    self._step()
                self._graph = recorded.graph
                wp.synchronize()

    def step(self) -> None:
        if self._graph is not None:
            wp.capture_launch(self._graph)
        else:
            with wp.ScopedDevice(self.device):
                self._step()

    def _step(self) -> None:
        for target in self._target_warp:
            wp.copy(self.d.ctrl, target)
            mjw.step(self.m, self.d)
        self._sole_force_warp.zero_()
        contact = self.d.contact
        wp.launch(_sole_forces, dim=self.d.naconmax, device=self.device,
                  inputs=[self.d.nacon, contact.geom, contact.worldid, contact.dim, contact.efc_address,
                          self.d.efc.force, self.d.naconmax, self._soles[0], self._soles[1], self._sole_force_warp])

    def fullest(self) -> tuple[int, int]:
        """(most constraints of a world, contacts of all worlds) of the last step: compare with what was allocated."""
        return int(wp.to_torch(self.d.nefc).max()), int(self.d.nacon.numpy()[0])
