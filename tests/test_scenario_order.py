"""Scenarios in one process do not disturb each other: in any order they drive the same, to the last bit."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from codriving.config.choices import choices
from codriving.config.compose import compose

REPOSITORY = Path(__file__).resolve().parents[1]
SCENARIOS = list(choices("scenario"))

ORDERS = """
import hashlib, json, os, sys
from codriving.experiment.objects import make_objects
import codriving.environment.environment, codriving.methods.codriving

SEED, DECISIONS = 3, 3

def digest(config):
    environment, method, *_ = make_objects(config)
    world = environment.reset(SEED)
    method.reset(environment.road_map, environment.driving_model, SEED)
    for _ in range(DECISIONS):
        if environment.outcome is not None:
            break
        world = environment.step(method.act(world).actions)
    found = hashlib.sha256()
    for track in environment.trajectory().tracks:
        found.update(repr((track.id, track.route, track.action)).encode())
        for name in ("x", "y", "heading", "speed", "acceleration"):
            found.update(getattr(track, name).tobytes())
    return found.hexdigest()

configs, orders = json.load(sys.stdin)
for order in orders:
    # Each order has a process of its own in which nothing has been driven, and the imports are made once.
    sys.stdout.flush()
    child = os.fork()
    if child == 0:
        print(json.dumps([[name, digest(configs[name])] for name in order]), flush=True)
        os._exit(0)
    assert os.waitpid(child, 0)[1] == 0
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs os.fork")
def test_trajectories_do_not_depend_on_the_order_of_scenarios() -> None:
    configs = {name: compose([f"scenario={name}"]) for name in SCENARIOS}
    # In turn each is the first, when no other can have left anything behind, and each follows each other one.
    orders = [SCENARIOS[index:] + SCENARIOS[:index] for index in range(len(SCENARIOS))]
    path = os.pathsep.join(filter(None, [str(REPOSITORY), os.environ.get("PYTHONPATH")]))
    done = subprocess.run(
        [sys.executable, "-c", ORDERS],
        input=json.dumps([configs, orders]),
        env={**os.environ, "PYTHONPATH": path},
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    found: dict[str, set[str]] = {name: set() for name in SCENARIOS}
    lines = [json.loads(line) for line in done.stdout.splitlines()]
    assert [[name for name, _ in line] for line in lines] == orders
    for line in lines:
        for name, digest in line:
            found[name].add(digest)
    assert {name: len(digests) for name, digests in found.items()} == dict.fromkeys(SCENARIOS, 1)
