"""What a user is told when a model cannot be used: one line that says what to set."""

from codriving.errors import ModelError, ModelUnavailableError
from codriving.llm.faults import CallError, Kind

_FOR_GOOD = (Kind.KEY, Kind.QUOTA, Kind.MODEL, Kind.UNREACHABLE)
"""Failures that no further episode would escape, if nothing has worked yet."""


def must_be_mended(fault: CallError) -> bool:
    """Whether a first call that fails in this way is for the user to mend."""
    return fault.kind in _FOR_GOOD


def unusable(fault: CallError, model: str, api_base: str | None, api_key_env: str | None) -> ModelError:
    """Say that a model cannot be used, and what to set."""
    where = server(model, api_base)
    said = f" ({fault.detail})" if fault.detail else ""
    key = api_key_env or "the variable that llm.api_key_env names"
    cures = {
        Kind.KEY: (f"the key in {api_key_env}", f"set {key} to a valid key")
        if api_key_env
        else ("requests without a key", "set llm.api_key_env to the name of the variable that holds the key"),
        Kind.MODEL: (f"the model {model}", "set llm.model to one that it has"),
    }
    if fault.kind is Kind.KEY:
        what, cure = cures[Kind.KEY]
        return ModelError(f"{where} refuses {what}{said}; {cure}")
    if fault.kind is Kind.MODEL:
        _, cure = cures[Kind.MODEL]
        return ModelError(f"{where} does not know the model {model}{said}; {cure}, or check llm.api_base")
    cure = {
        Kind.UNREACHABLE: "start the server, or set llm.api_base to its address",
        Kind.QUOTA: f"buy some, or set {key} to another key",
        Kind.UNREADABLE: "set llm.api_base to the address of its API, which often ends in /v1",
        Kind.TIMEOUT: "raise llm.deadline, or check llm.api_base",
        Kind.RATE: "try later, or raise llm.attempts",
        Kind.SERVER: "try later, or check llm.model and llm.api_base",
        Kind.DROPPED: "try later, or check llm.api_base",
    }.get(fault.kind, "change the setting of llm that it complains about")
    return ModelError(f"{where} {fault.kind.value}{said}; {cure}")


def unavailable(fault: CallError, model: str, api_base: str | None) -> ModelUnavailableError:
    """Say that a model did not answer this time."""
    times = "once" if fault.attempts == 1 else f"{fault.attempts} times"
    return ModelUnavailableError(f"{model}: {server(model, api_base)} {fault}, asked {times}")


def server(model: str, api_base: str | None) -> str:
    """Name the server in a message."""
    return api_base or f"the provider of {model}"
