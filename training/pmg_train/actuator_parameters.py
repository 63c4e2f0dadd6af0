"""The numbers of motor.yaml; src/model/actuator_parameters.hpp explains each."""

import json
import math
from pathlib import Path

# The neutral value of each parameter, by group and key of motor.yaml, as test/training/actuator_record_test.cpp writes it; null is infinite.
_WRITTEN = json.loads(Path(__file__).with_suffix(".json").read_text())
NEUTRAL = {name: math.inf if value is None else value for name, value in _WRITTEN.items()}
REFERENCE_TEMPERATURE_C = 25.0  # the parameters of friction and torque hold at this temperature
