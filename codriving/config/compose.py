"""Overrides to one resolved config, as a plain dict; in the parent process only, since Hydra's state is global."""

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from codriving.config.choices import EXPERIMENTS, check_config_dir, read_yaml
from codriving.config.choices import choices as known_choices
from codriving.config.experiments import changes_of, is_delta, key_of
from codriving.config.locate import conf_dir, experiments_root
from codriving.config.overrides import at_home, prepare
from codriving.config.plugins import find_beside, gathered
from codriving.config.references import check_references, no_resolvers
from codriving.config.schema import GROUPS, LARGEST_SEED, ROOT, SHOWN, check_root, texts
from codriving.config.suites import check_scenario
from codriving.errors import ConfigError

_VARIABLE = re.compile(r"[A-Z_][A-Z0-9_]*")
_PASSWORD = re.compile(r"\w+://[^/]*@")
_NO_GROUP = re.compile(r"Could not override '([^'@]+)'")


def compose(overrides: Sequence[str], config_dir: Path | None = None) -> dict[str, Any]:
    """Compose the config that the overrides ask for, without the names of its YAMLs.

    Args:
        overrides: ``key=value`` tokens.

    Raises:
        ConfigError: If anything in the overrides or in a YAML file cannot be used.
    """
    return compose_named(overrides, config_dir)[0]


def compose_named(overrides: Sequence[str], config_dir: Path | None = None) -> tuple[dict[str, Any], dict[str, str]]:
    """Compose the config that the overrides ask for.

    The keys, types and ranges of the root and the rules between keys are checked here; those of each node are checked
    by ``validate``, which builds it.

    Args:
        overrides: ``key=value`` tokens; groups take the name of one of their YAML files.

    Returns:
        The config with every reference resolved, made of dicts, lists, texts, numbers, booleans and None; and the name
        of the YAML that each group is set to.

    Raises:
        ConfigError: If anything in the overrides or in a YAML file cannot be used.
    """
    import hydra
    from hydra.errors import HydraException
    from omegaconf import open_dict
    from omegaconf.errors import OmegaConfBaseException
    from yaml import YAMLError

    if config_dir is not None:
        config_dir = config_dir.absolute()
        check_config_dir(config_dir)
    # Quoted, for a path may hold blanks, commas and quotes.
    folders = [str(root).replace("\\", "\\\\").replace("'", "\\'") for root in (experiments_root(), config_dir) if root]
    search_path = "hydra.searchpath=[" + ",".join(f"'file://{folder}'" for folder in folders) + "]"
    tokens = [search_path, *(prepare(token, config_dir) for token in _unfolded(overrides, config_dir))]
    try:
        with hydra.initialize_config_dir(str(conf_dir()), version_base="1.3"), no_resolvers():
            config = hydra.compose("config", overrides=tokens, return_hydra_config=True)
        chosen = config.hydra.runtime.choices
        check_scenario(chosen, config_dir)
        choices = {group: str(chosen[group]) for group in GROUPS if chosen.get(group) is not None}
        with open_dict(config):
            del config["hydra"]
        resolved = resolve(config)
    except YAMLError as err:
        raise ConfigError(f"{one_line(err)}; mend the YAML there") from err
    except (HydraException, OmegaConfBaseException) as err:
        if group := _NO_GROUP.match(str(err)):
            key = group[1].replace("/", ".")
            raise ConfigError(
                f"there is no group {group[1]}; a key of a group is written with dots: {key}=..."
            ) from err
        raise ConfigError(one_line(err)) from err
    except ConfigError:
        raise
    except Exception as err:  # On odd YAML files these libraries raise whatever their code comes across
        if config_dir is not None and isinstance(err, UnicodeDecodeError | OSError):
            for file in sorted(config_dir.glob("*/*.yaml")):
                read_yaml(file)
        why = "it nests too deep" if isinstance(err, RecursionError) else f"{type(err).__name__}: {one_line(err)}"
        raise ConfigError(
            f"the config cannot be composed ({why}); look at the values and at the YAML files that they name"
        ) from err
    for key in SHOWN if isinstance(resolved["method"], dict) else ():
        resolved["method"].pop(key, None)
    plain = gathered(_with_home({str(key): value for key, value in resolved.items()}))
    check_root(plain)
    _check_together(plain, choices)
    find_beside(plain["plugins"], config_dir)
    return plain, choices


def _unfolded(overrides: Sequence[str], config_dir: Path | None) -> list[str]:
    """Write out what ``experiments=NAME`` sets, where that is a file with rows; all else comes after it."""
    files, rest, first = known_choices(EXPERIMENTS, config_dir), [], []
    for token in overrides:
        file = files.get(token.partition("=")[2]) if key_of(token) == EXPERIMENTS else None
        if file is None or is_delta(file):
            rest.append(token)
        else:
            first = changes_of(file, config_dir)
    given = set(map(key_of, rest))
    return [*(token for token in first if key_of(token) not in given), *rest]


def resolve(config: Any, file: Path | None = None) -> dict[str, Any]:  # noqa: ANN401 - a config of OmegaConf, which is imported late
    """Resolve every reference of a config, as a plain dict; none reads anything but the config itself."""
    from omegaconf import OmegaConf

    check_references(OmegaConf.to_container(config, resolve=False), file)
    with no_resolvers():
        found: dict[str, Any] = OmegaConf.to_container(config, resolve=True)  # type: ignore[assignment]
    return found


def show(resolved: Mapping[str, Any]) -> str:
    """Write a composed config as YAML, in the order in which it was composed."""
    from omegaconf import OmegaConf

    return OmegaConf.to_yaml(OmegaConf.create(dict(resolved)))


def _with_home(node: Any) -> Any:  # noqa: ANN401 - any plain value
    if isinstance(node, Mapping):
        return {name: _with_home(inner) for name, inner in node.items()}
    if isinstance(node, list):
        return [_with_home(inner) for inner in node]
    return at_home(node) if isinstance(node, str) else node


def _check_together(resolved: Mapping[str, Any], choices: Mapping[str, str]) -> None:
    """Check what concerns more than one key of the root; rules between the keys of a node are its constructor's."""
    check_secrets(resolved)
    last = resolved["seed"] + resolved["episodes"] - 1
    if last > LARGEST_SEED:
        raise ConfigError(f"seed + episodes - 1 must be at most {LARGEST_SEED}, got {last}; lower seed or episodes")
    if "/" in (shard := resolved["shard"] or "") and int(shard.partition("/")[0]) > int(shard.partition("/")[2]):
        raise ConfigError(f"shard must be {ROOT['shard'].rule}, got {shard!r}")
    if choices.get("launcher") == "serial" and resolved["workers"] not in ("auto", 1):
        raise ConfigError(f"workers must be auto or 1 with launcher=serial, got {resolved['workers']}")


def check_secrets(resolved: Mapping[str, Any]) -> None:
    """Refuse what may be a key where the name of its variable belongs; the message leaves the value out."""
    for key, value in sorted(texts(resolved), key=lambda pair: pair[0].count(".")):
        if key.endswith("_env") and not _VARIABLE.fullmatch(value):
            raise ConfigError(
                f"{key} must be the name of an environment variable (capitals, digits and _) that holds the key, not "
                f"the key itself; what was given is not shown: set the variable and give its name, {key}=MY_KEY"
            )
        if _PASSWORD.match(value):
            raise ConfigError(
                f"{key} must be an address without user and password, for it is written to the run folder; what was "
                "given is not shown"
            )


def one_line(err: BaseException) -> str:
    """Join what a library says in several lines; the useful half is often in the cause."""
    texts = [str(err), *([str(err.__cause__)] if err.__cause__ else [])]
    lines = [line.strip() for text in texts for line in text.splitlines()]
    noise = ("full_key:", "object_type=", "See https:", "Config search path", "provider=", "Set the environment")
    return " ".join(line for line in dict.fromkeys(lines) if line and not line.startswith(noise))
