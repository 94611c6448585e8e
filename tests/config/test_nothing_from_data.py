"""A YAML or an override chooses no code but a part of its place, and reads nothing but its own config."""

import json
from pathlib import Path

import pytest

from codriving.config.build import validate
from codriving.config.compose import compose
from codriving.config.training import compose_training
from codriving.errors import ConfigError

SECRET = "hunter2-and-more"


@pytest.fixture(autouse=True)
def secret(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("API_KEY", SECRET)


def written(folder: Path, group: str, text: str) -> Path:
    """A folder of configs with one YAML, called ``theirs``."""
    (folder / "conf" / group).mkdir(parents=True)
    (folder / "conf" / group / "theirs.yaml").write_text(f"# Theirs.\n{text}")
    return folder / "conf"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("_target_: subprocess.Popen\nplugins: [subprocess]\nargs: [touch, {made}]\n", "of Python's standard library"),
        ("_target_: os.path.join\nplugins: [os.path]\na: '{made}'\n", "of Python's standard library"),
        ("_target_: numpy.memmap\nplugins: [numpy]\nfilename: '{made}'\nmode: w+\nshape: [4]\n", "but numpy.memmap is"),
        ("_target_: codriving.memory.store.MemoryStore\npath: '{made}'\n", "but codriving.memory.store.MemoryStore is"),
        ("_target_: codriving.config.build.build\nnode: 1\n", "has no class build"),
        ("_target_: codriving.runs.atomic.shutil.rmtree\npath: '{made}'\n", "there is no module"),
        ("_target_: builtins.eval\nplugins: [builtins]\nsource: '1'\n", "of Python's standard library"),
    ],
)
@pytest.mark.parametrize("group", ["method", "executor", "cda", "launcher"])
def test_a_class_that_is_no_part_of_its_place_is_never_called(text: str, said: str, group: str, tmp_path: Path) -> None:
    made = tmp_path / "made"
    config_dir = written(tmp_path, group, text.format(made=made))
    with pytest.raises(ConfigError, match=said):
        validate(compose([f"{group}=theirs"], config_dir))
    assert not made.exists()


@pytest.mark.parametrize("key", ["_args_", "_partial_", "_recursive_", "_convert_"])
def test_words_that_hydra_would_follow_are_keys_like_any_other(key: str, tmp_path: Path) -> None:
    config_dir = written(tmp_path, "scenario", f"defaults: [intersection, _self_]\n{key}: [1]\n")
    with pytest.raises(ConfigError, match=f"unknown key scenario.{key}"):
        validate(compose(["scenario=theirs"], config_dir))


@pytest.mark.parametrize("key", ["time_limit", "hdvs"])
def test_an_object_in_the_place_of_a_number_is_refused_before_it_is_made(key: str, tmp_path: Path) -> None:
    inner = "{_target_: codriving.memory.store.MemoryStore, path: made}"
    written(tmp_path, "scenario", "defaults: [intersection, _self_]\n")
    with pytest.raises(ConfigError):
        validate(compose(["scenario=theirs", f"scenario.{key}={inner.replace('_: ', '_:')}"], tmp_path / "conf"))


@pytest.mark.parametrize(
    "text",
    [
        "${oc.${experiment}:API_KEY}",
        "${oc.env:API_KEY}",
        "${ oc.env : API_KEY}",
        "${oc.decode:${oc.env:API_KEY}}",
        "${oc.create:x}",
        "${now:%Y}",
        "${hydra:runtime.cwd}",
        "${oc.select:experiment}",
        "${${experiment}}",
        "\\\\${oc.env:API_KEY}",
        "x${oc.dict.keys:llm}y",
    ],
)
@pytest.mark.parametrize("key", ["run", "memory.file"])
def test_of_interpolations_only_plain_references_are_followed(text: str, key: str) -> None:
    with pytest.raises(ConfigError, match=rf"^{key} .*(reads an environment variable|plain reference)") as caught:
        compose([f'{key}="{text}"', "experiment=env", "memory=online"])
    assert SECRET not in str(caught.value)


@pytest.mark.parametrize("line", ["- ${oc.env:API_KEY}", "- /llm: ${oc.env:API_KEY}", "- /llm: ${oc.decode:API_KEY}"])
def test_a_list_of_defaults_calls_no_function_either(line: str, tmp_path: Path) -> None:
    config_dir = written(tmp_path, "scenario", f"defaults:\n  {line}\n  - _self_\n")
    with pytest.raises(ConfigError) as caught:
        compose(["scenario=theirs"], config_dir)
    assert SECRET not in str(caught.value)


def test_a_yaml_of_a_training_reads_no_environment_either(tmp_path: Path) -> None:
    config_dir = written(tmp_path, "train", "experiment: env\nrun: ${oc.${experiment}:API_KEY}\n")
    with pytest.raises(ConfigError, match=r"theirs\.yaml: run .* plain reference"):
        compose_training("theirs", [], False, config_dir)


def test_plain_references_are_followed_and_functions_of_others_stay_registered() -> None:
    from omegaconf import OmegaConf

    config = compose(['output="runs/${experiment}"', "experiment=mine"])
    assert config["output"] == "runs/mine"
    assert OmegaConf.has_resolver("oc.env")
    assert SECRET not in json.dumps(config)
