"""The only place that knows LiteLLM: one request out, one reply in, and nothing decided."""

import asyncio
import logging
import os
from dataclasses import asdict
from importlib import import_module
from types import ModuleType
from typing import Any, cast

from codriving.llm.connections import client
from codriving.llm.faults import fault_of, without_key
from codriving.llm.loop import loop
from codriving.llm.parsing import clean
from codriving.llm.request import ChatRequest, Reply, response_format, worded

# Sent where no key is named; without it LiteLLM would take one from the environment and give it to a stranger.
NO_KEY = "none"

_COMPATIBLE = "openai"  # LiteLLM's word for a server that speaks OpenAI's protocol


class Sender:
    """Sends through LiteLLM, over connections that the whole process shares."""

    async def load(self) -> None:
        """Import LiteLLM, which takes seconds the first time, so that no deadline runs meanwhile."""
        await load_litellm()

    async def send(self, request: ChatRequest, form: str, key: str | None, deadline: float) -> Reply:
        """Send a request once."""
        optional = {"temperature": request.temperature, "response_format": response_format(form, request.schema)}
        try:
            response = await _loaded[0].acompletion(
                model=request.model,
                custom_llm_provider=provider_of(request.model, request.api_base),
                messages=[asdict(message) for message in worded(request.messages, form, request.schema)],
                api_base=request.api_base,
                api_key=key or NO_KEY,
                timeout=deadline,
                max_retries=0,
                num_retries=0,
                stream=False,
                max_tokens=request.max_tokens,
                **{name: value for name, value in optional.items() if value is not None},
            )
            return _reply(response, form, key)
        except Exception as err:
            fault = fault_of(err, key)
        # Outside the handler: LiteLLM's exception, which may quote the key, is not dragged along as context.
        raise fault


_loaded: list[Any] = []
_loading = asyncio.Lock()


async def load_litellm() -> ModuleType:
    """Import LiteLLM and what it imports in its first call, which takes seconds; only the first time."""
    async with _loading:
        if not _loaded:
            _loaded.append(await _import())
    return cast(ModuleType, _loaded[0])


async def _import() -> ModuleType:
    """Import LiteLLM, make it keep quiet, and give it one way of sending for all providers."""
    os.environ.setdefault("LITELLM_LOCAL_MODEL_COST_MAP", "True")
    os.environ.setdefault("LITELLM_MODE", "PRODUCTION")  # Otherwise it reads a .env from some folder above
    import litellm
    import openai

    litellm.suppress_debug_info = True
    litellm.telemetry = False
    # For embeddings a 0 of the call counts as nothing said; retries have one owner.
    litellm.DEFAULT_MAX_RETRIES = 0  # type: ignore[attr-defined]
    for name in ("LiteLLM", "httpx", "openai"):
        # Their lines may hold addresses with keys; what goes wrong is told by us.
        logging.getLogger(name).setLevel(logging.CRITICAL)
    litellm.disable_aiohttp_transport = True
    session = client()
    litellm.aclient_session = session
    # Providers that have no library of their own are reached through clients that LiteLLM makes for itself.
    handlers = import_module("litellm.llms.custom_httpx.http_handler")
    handlers.AsyncHTTPHandler.create_client = _client_of_litellm
    litellm.module_level_aclient.client = session
    loop().at_close(session.aclose)
    # Nothing is sent: LiteLLM makes the reply up. It does so only if that is not empty.
    await litellm.acompletion(
        model=f"{_COMPATIBLE}/none",
        messages=[{"role": "user", "content": "Answer with the one word: yes"}],
        api_base="http://127.0.0.1:9",
        api_key=NO_KEY,
        mock_response="yes",
    )
    openai.AsyncOpenAI(api_key=NO_KEY, http_client=session).chat.completions  # noqa: B018 - imports it
    return litellm


def _client_of_litellm(handler: object, timeout: Any, event_hooks: Any, *_: object, **__: object) -> Any:  # noqa: ANN401
    return client(timeout=timeout, event_hooks=event_hooks)


def provider_of(model: str, api_base: str | None) -> str | None:
    """Name the protocol where a server of one's own is given and the model's name does not say it."""
    if api_base is None:
        return None
    try:
        _loaded[0].get_llm_provider(model=model)
    except Exception:
        return _COMPATIBLE
    return None


def _reply(response: Any, form: str, key: str | None) -> Reply:  # noqa: ANN401 - LiteLLM's response has no narrow type
    """Normalise a response: any text that is there, and why it ends."""
    usage = getattr(response, "usage", None)
    names = ("prompt_tokens", "completion_tokens")
    tokens: dict[str, Any] = {name: max(0, int(getattr(usage, name, None) or 0)) for name in names}
    choices = getattr(response, "choices", None) or ()
    if not choices:
        return Reply("", "", form=form, **tokens)
    message = choices[0].message
    beside = getattr(message, "provider_specific_fields", None) or {}
    return Reply(
        text=clean(without_key(_text(getattr(message, "content", None)), key)),
        finish_reason=str(choices[0].finish_reason or ""),
        refusal=clean(without_key(str(getattr(message, "refusal", None) or beside.get("refusal") or ""), key)),
        form=form,
        **tokens,
    )


def _text(content: object) -> str:
    """Return the text of a message, whose content may come in parts."""
    if isinstance(content, list):
        return "".join(str(part.get("text") or "") for part in content if isinstance(part, dict))
    return content if isinstance(content, str) else ""
