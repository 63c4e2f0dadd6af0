"""This code reproduces test/data/training/observations.json, the reference of the tests of the controller's assembler. Needs only torch."""

import json
from pathlib import Path

from make_observations import observations

RECORD = Path(__file__).resolve().parents[2] / "test" / "data" / "training" / "observations.json"
TOLERANCE = 1e-7  # of the same arithmetic on another machine, elements of order one


def test_the_recorded_observations_are_trainings():
    record = json.loads(RECORD.read_text())
    names = [f"{term['name']}, {term['age_ticks']} ticks old: {e}" for term in record["observation"]["terms"] for e in term["elements"]]
    seen = observations(record["ticks"], record)
    for number, (tick, found) in enumerate(zip(record["ticks"], seen, strict=True)):
        for name, expected, value in zip(names, tick["observation"], found, strict=True):
            assert abs(value - expected) <= TOLERANCE * max(1, abs(expected)), f"{name}, tick {number}"
