"""Everything that can go wrong, as one tree.

CodrivingError                      anything this program raises on purpose
├── UserError                       the user can mend it: one line, exit code 2, no traceback
│   ├── ConfigError                 a key, value, range or cross-field rule of the config
│   │   └── ScenarioError           a scenario whose vehicles cannot be placed or whose road is broken
│   ├── RunFolderError              a run folder that is unwritable, of another config, or damaged
│   │   └── DamagedEpisodeError     an episode whose files are not as they were written; it is driven again
│   ├── RecordingError              a file of trajectories that cannot be read
│   ├── FilmError                   a film that cannot be written
│   ├── MemoryFileError             a file of memories that is missing, damaged, or of another embedder or version
│   ├── WeightsError                trained weights that are missing, damaged, or meant for something else
│   ├── TrainingError               a training that cannot begin or go on
│   ├── LauncherError               a launcher that cannot drive, or that has lost episodes
│   └── ModelError                  a language model that cannot be used, or must not be used any more
│       └── SpendingLimitError      the tokens or the money that may be spent are used up
└── EpisodeError                    an episode could not go on; it becomes a record and the batch continues
    └── ModelUnavailableError       a language model did not answer in time, retries included
"""


class CodrivingError(Exception):
    """Base of every error that this program raises on purpose."""


class UserError(CodrivingError):
    """Raised when the user can mend what is wrong; the message says what, why and what to do."""


class ConfigError(UserError):
    """Raised when a config key, type, range or cross-field rule is broken."""


class ScenarioError(ConfigError):
    """Raised when a scenario's vehicles cannot be placed or its road is inconsistent."""


class RunFolderError(UserError):
    """Raised when a run folder cannot be written, belongs to another config, or is damaged."""


class DamagedEpisodeError(RunFolderError):
    """Raised when the files of a stored episode are missing, damaged, or of another one; a run drives it again."""


class RecordingError(UserError):
    """Raised when a file of trajectories cannot be read; the message names file, sheet and column."""


class FilmError(UserError):
    """Raised when a film cannot be written."""


class MemoryFileError(UserError):
    """Raised when a file of memories is missing, damaged, of another embedder or version, or cannot be written."""


class WeightsError(UserError):
    """Raised when trained weights are missing, damaged, or were trained for something else."""


class TrainingError(UserError):
    """Raised when a training cannot begin or go on, for instance without PyTorch."""


class LauncherError(UserError):
    """Raised when a launcher cannot drive, or does not give back what it was given; what is finished is kept."""


class EpisodeError(CodrivingError):
    """Raised when an episode cannot go on; the batch records it and continues."""


class ModelError(UserError):
    """Raised when a language model cannot be used: no key, no server, no such model."""


class SpendingLimitError(ModelError):
    """Raised when the tokens or the money that may be spent are used up; the batch stops and can be resumed."""


class ModelUnavailableError(EpisodeError):
    """Raised when a language model does not answer, retries included; the episode ends, the batch goes on."""


def require(condition: bool, message: str) -> None:
    """Refuse a setting.

    Raises:
        ConfigError: If the condition does not hold.
    """
    if not condition:
        raise ConfigError(message)


def require_range(name: str, value: float, low: float, high: float, unit: str = "") -> None:
    """Refuse a number outside [low, high], or one that is not a number.

    Raises:
        ConfigError: With the setting, its range and the value.
    """
    require(low <= value <= high, f"{name} must be {low:g} to {high:g}{unit}, got {value:g}")


def require_interval(name: str, value: tuple[float, float], low: float, high: float, unit: str = "") -> None:
    """Refuse an interval that is reversed or leaves [low, high].

    Raises:
        ConfigError: With the setting, its range and the value.
    """
    shown = f"[{', '.join(f'{v:g}' for v in value)}]"
    holds = len(value) == 2 and low <= value[0] <= value[1] <= high
    require(holds, f"{name} must be [smallest, largest] within {low:g} to {high:g}{unit}, got {shown}")
