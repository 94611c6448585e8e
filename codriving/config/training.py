"""The configs of trainings: one YAML in conf/train each, changed by ``key=value`` as everywhere."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from codriving.config.compose import compose
from codriving.config.locate import conf_dir
from codriving.config.overrides import parse
from codriving.config.schema import unknown
from codriving.config.secrets import shown
from codriving.errors import ConfigError

TRAININGS = "train"
"""The folder of these configs; it is no group, since a run has no training."""

LLM = "llm"
"""The group of language models, of which one can teach."""

GUIDANCE = "guidance"
"""The key that holds who teaches, where a student is guided."""

SMOKE = "smoke"
"""The key that holds what ``--smoke`` changes."""


def trainings(config_dir: Path | None = None) -> dict[str, Path]:
    """List the trainings.

    Returns:
        The YAML file of each, by name.
    """
    folders = [root / TRAININGS for root in (conf_dir(), config_dir) if root is not None]
    return {file.stem: file for folder in folders for file in sorted(folder.glob("*.yaml"))}


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

    known = trainings(config_dir)
    if name not in known:
        raise ConfigError(f"there is no training {name!r}; trainings: {', '.join(known)}")
    try:
        config: dict[str, Any] = OmegaConf.to_container(OmegaConf.load(known[name]), resolve=True)  # type: ignore[assignment]
    except (OmegaConfBaseException, YAMLError) as err:
        raise ConfigError(f"cannot read {known[name]} ({' '.join(str(err).split())})") from err
    small = config.pop(SMOKE, {})
    if smoke:
        for key, value in small.items():
            _set(config, key, value)
    asked = [token for token in overrides if token.partition("=")[0].partition(".")[0] == LLM]
    if asked:
        _teach(config, asked, config_dir)
    for token in (token for token in overrides if token not in asked):
        override = parse(token)
        if override.is_delete() or override.is_sweep_override():
            raise ConfigError(f"{shown(token)}: a training takes one value for each key")
        _set(config, override.key_or_group, override.value())
    return config


def _teach(config: dict[str, Any], overrides: Sequence[str], config_dir: Path | None) -> None:
    """Put the language model that ``llm=`` chooses, with its settings, in the place of the teacher."""
    if not config.get(GUIDANCE):
        raise ConfigError(f"{shown(overrides[0])}: nobody teaches in this training; it has no guidance.llm")
    config[GUIDANCE][LLM] = compose(overrides, config_dir)[LLM]


def _set(config: dict[str, Any], key: str, value: object) -> None:
    """Set a key that is there already; ``settings`` and ``reward`` may get others, which their classes check."""
    node: Any = config
    where = ""
    *path, last = key.split(".")
    for part in path:
        node, where = _inside(node, part, where, key), f"{where}.{part}" if where else part
    if not (isinstance(node, Mapping) and path and path[-1] in ("settings", "reward")):
        _inside(node, last, where, key)
    node[int(last) if isinstance(node, list) else last] = value


def _inside(node: object, part: str, where: str, key: str) -> Any:  # noqa: ANN401 - any plain value
    """Return what stands in a node under a key, or in a list under a number."""
    found = dict(enumerate(node)) if isinstance(node, list) else node if isinstance(node, Mapping) else {}
    names = {str(name): value for name, value in found.items()}
    if part not in names:
        raise unknown(key, names, where or "the training")
    return names[part]
