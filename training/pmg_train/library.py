"""libpmg_batch.so, the C++ code that training shares with the controller and the simulation: its functions for ctypes (pmg_batch.h)."""

import ctypes
from pathlib import Path


def load(path: str | Path) -> ctypes.CDLL:
    """OSError when there is no such library."""
    lib = ctypes.CDLL(str(path))
    pointer, text, integer = ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int32
    for name, result, arguments in (
        ("create", pointer, [text, text, integer, ctypes.c_uint64, integer]),
        ("destroy", None, [pointer]),
        ("error", text, []),
        ("description", text, [pointer]),
        ("run", integer, [pointer, integer, pointer, pointer]),
        ("reset", None, [pointer]),
        ("observe", integer, [pointer, integer] + [pointer] * 6),
        ("randomization", text, [text]),
        ("motors", text, [text, text]),
        ("scenario", text, [text]),
    ):
        function = getattr(lib, f"pmg_batch_{name}")
        function.restype, function.argtypes = result, arguments
    return lib
