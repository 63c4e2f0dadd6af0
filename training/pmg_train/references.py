"""References from the deployed C++ generator (training/pmg_batch), through ctypes."""

import json
import os
from pathlib import Path

import numpy as np

from pmg_train.library import load


class ReferenceBatch:
    """Many reference streams that step together.

    robot: the robot's directory. variant: "pmg", "without_gco" or "single_gait". Raises RuntimeError with the
    library's own message.
    """

    def __init__(self, library: str | Path, robot: str | Path, variant: str = "pmg", streams: int = 1, seed: int = 0, threads: int | None = None):
        self._lib = load(library)
        self._handle = self._lib.pmg_batch_create(str(robot).encode(), variant.encode(), streams, seed, threads or os.cpu_count() or 1)
        if not self._handle:
            raise RuntimeError(self._lib.pmg_batch_error().decode())
        self.streams = streams
        self.description = json.loads(self._lib.pmg_batch_description(self._handle).decode())
        self.row_size: int = self.description["row_size"]
        self.fields = {f["name"]: slice(f["offset"], f["offset"] + f["size"]) for f in self.description["fields"]}

    def __del__(self):
        if getattr(self, "_handle", None):
            self._lib.pmg_batch_destroy(self._handle)
            self._handle = None

    def reset(self) -> None:
        """Puts every stream to rest. Random commands continue."""
        self._lib.pmg_batch_reset(self._handle)

    def run(self, ticks: int, commands: np.ndarray | None = None, out: np.ndarray | None = None) -> np.ndarray:
        """(ticks, streams, row_size) float32. commands: (ticks, streams, 6) in SI, or None for random ones."""
        shape = (ticks, self.streams, self.row_size)
        if out is None:
            out = np.empty(shape, np.float32)
        if out.shape != shape or out.dtype != np.float32 or not out.flags.c_contiguous:
            raise ValueError(f"out; expected contiguous float32 {shape}")
        given = None
        if commands is not None:
            commands = np.ascontiguousarray(commands, np.float32)
            if commands.shape != (ticks, self.streams, 6):
                raise ValueError(f"commands {commands.shape}; expected {(ticks, self.streams, 6)}")
            given = commands.ctypes.data
        if self._lib.pmg_batch_run(self._handle, ticks, given, out.ctypes.data):
            raise RuntimeError(self._lib.pmg_batch_error().decode())
        return out

    def observe(self, gyro, quat_wxyz, q, dq, last_action, first: bool = False) -> np.ndarray:
        """The controller's own observation for stream 0's last tick and this robot state (a robot's sensors)."""
        arrays = [np.ascontiguousarray(a, np.float64) for a in (gyro, quat_wxyz, q, dq)]
        action = np.ascontiguousarray(last_action, np.float32)
        out = np.empty(self.description["observation"]["size"], np.float32)
        self._lib.pmg_batch_observe(self._handle, int(first), *(a.ctypes.data for a in arrays), action.ctypes.data, out.ctypes.data)
        return out
