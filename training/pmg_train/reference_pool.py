"""References, computed in advance and kept on the device. A world reads a row in each tick and may start anywhere in any stream."""

import numpy as np
import torch

from pmg_train.references import ReferenceBatch

CHUNK_TICKS = 100


class ReferencePool:
    """rows: (ticks * streams, row size) float32 on the device, tick-major."""

    def __init__(self, batch: ReferenceBatch, ticks: int, device: str):
        self.ticks, self.streams = ticks, batch.streams
        self.rows = torch.empty(ticks * batch.streams, batch.row_size, device=device)
        chunk = np.empty((CHUNK_TICKS, batch.streams, batch.row_size), np.float32)
        for first in range(0, ticks, CHUNK_TICKS):
            count = min(CHUNK_TICKS, ticks - first)
            batch.run(count, out=chunk[:count])
            if not np.isfinite(chunk[:count]).all():
                raise FloatingPointError("the generator gave a reference that is not finite")
            at = first * batch.streams
            self.rows[at : at + count * batch.streams].copy_(torch.from_numpy(chunk[:count]).flatten(0, 1))

    def read(self, stream: torch.Tensor, tick: torch.Tensor) -> torch.Tensor:
        return self.rows.index_select(0, tick * self.streams + stream)
