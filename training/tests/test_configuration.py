"""A configuration file is read whole or refused."""

from pathlib import Path

import pytest
import yaml

from pmg_train.configuration import load_config

HERE = Path(__file__).resolve().parent.parent


def test_the_committed_file_is_complete():
    assert load_config(HERE / "config.yaml")["symmetry"]["weight"] >= 0


def changed(tmp_path: Path, change) -> Path:
    content = yaml.safe_load((HERE / "config.yaml").read_text())
    change(content)
    path = tmp_path / "config.yaml"
    path.write_text(yaml.safe_dump(content))
    return path


def put(*keys_and_value):
    *keys, last, value = keys_and_value

    def change(content):
        for key in keys:
            content = content[key]
        content[last] = value

    return change


@pytest.mark.parametrize(
    "change, said",
    [
        (put("rewards", "velocty", 1.0), "rewards: unknown key velocty; expected velocity_slow, "),
        (put("rewards", "height", 1.0), "rewards: height: 1.0; expected a map with the keys weight, s"),
        (lambda c: c["ppo"].pop("gamma"), "ppo: gamma is missing"),
        (put("ppo", "gamma", float("nan")), "ppo: gamma: nan; expected a finite number"),
        (put("ppo", "gamma", True), "ppo: gamma: True; expected a finite number"),
        (put("gains", "knee", [150]), "gains: .*; expected {name: .number, number., ...}"),
        (put("physics", "jacobian", "thin"), "jacobian: thin; expected auto, dense or sparse"),
    ],
)
def test_a_key_or_value_that_means_nothing_is_named(tmp_path, change, said):
    with pytest.raises(ValueError, match=f"config.yaml: (.*: )?{said}"):
        load_config(changed(tmp_path, change))


def test_a_file_that_is_no_yaml_is_named(tmp_path):
    path = tmp_path / "config.yaml"
    path.write_text("ppo: {")
    with pytest.raises(ValueError, match=r"config.yaml: .*line 1"):
        load_config(path)
