"""The configs of trainings: one YAML in conf/train each, changed by ``key=value`` as everywhere."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from codriving.config.choices import SUITE, TRAININGS, choices
from codriving.config.compose import check_secrets, compose, one_line, resolve
from codriving.config.overrides import parse, shown, written
from codriving.config.schema import unknown
from codriving.errors import ConfigError

_OPEN = (["settings"], ["reward"], ["world"])

WORLD = (SUITE, "limits", "drivers")  # The groups that say in what world a training drives


def trainings(config_dir: Path | None = None) -> dict[str, Path]:
    """List the trainings.

    Returns:
        The YAML file of each, by name.
    """
    return choices(TRAININGS, config_dir)


def compose_training(
    name: str, overrides: Sequence[str], smoke: bool, config_dir: Path | None = None
) -> dict[str, Any]:
    """Compose the config of a training.

    Args:
        overrides: ``key=value`` tokens; a part of a list is named by its number, as in ``traffic.0.weight=2``.

    Returns:
        The config, made of dicts, lists, texts, numbers, booleans and None.

    Raises:
        ConfigError: If there is no such training, or an override cannot be used.
    """
    from omegaconf import OmegaConf
    from omegaconf.errors import OmegaConfBaseException
    from yaml import YAMLError

    overrides = written(overrides)
    known = trainings(config_dir)
    if name not in known:
        raise ConfigError(f"there is no training {name!r}; trainings: {', '.join(known)}")
    try:
        config = resolve(OmegaConf.load(known[name]), known[name])
    except (OmegaConfBaseException, YAMLError) as err:
        raise ConfigError(f"cannot read {known[name]} ({one_line(err)})") from err
    small = config.pop("smoke", {})
    for key, value in small.items() if smoke else ():
        _set(config, key, value)
    teacher = [token for token in overrides if token.partition("=")[0].partition(".")[0] == "llm"]
    if teacher:
        if not config.get("guidance"):
            raise ConfigError(
                f"{shown(teacher[0])}: this training has no teacher, so no model can be chosen for it; leave it out"
            )
        config["guidance"]["llm"] = compose(teacher, config_dir)["llm"]
    if bare := [token for token in overrides if token.partition("=")[0] in WORLD]:
        raise ConfigError(f"{bare[0]}: the world of a training is a part of its config; write world.{bare[0]}")
    for override, token in ((parse(token), token) for token in overrides if token not in teacher):
        if override.is_delete() or override.is_sweep_override():
            raise ConfigError(f"{shown(token)}: a training takes one value for each key")
        _set(config, override.key_or_group, override.value())
    if isinstance(world := config.get("world"), Mapping):
        if strange := [key for key in world if key not in WORLD]:
            raise unknown(f"world.{strange[0]}", WORLD, "world")
        compose([f"{key}={value}" for key, value in world.items()])  # Environments of a training know ours alone
    check_secrets(config)
    return config


def _set(config: dict[str, Any], key: str, value: object) -> None:
    """Set a key that is there already; mappings in ``_OPEN`` may get others, which are checked later."""
    node: Any = config
    path = key.split(".")
    for depth, part in enumerate(path):
        found = dict(enumerate(node)) if isinstance(node, list) else node if isinstance(node, Mapping) else {}
        names = {str(name): name for name in found}
        last = depth == len(path) - 1
        checked_later = last and isinstance(node, Mapping) and path[depth - 1 : depth] in _OPEN
        if part not in names and not checked_later:
            raise unknown(key, names, ".".join(path[:depth]) or "the training")
        if last:
            node[names.get(part, part)] = value
        else:
            node = node[names[part]]
