"""The only place that knows LiteLLM: one request out, one reply in, and nothing decided."""

import asyncio
import json
import logging
import os
import warnings
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict
from importlib import import_module
from types import ModuleType
from typing import Any, cast

from codriving.errors import ModelError
from codriving.llm.connections import Outgoing, changed, client, keep_bodies
from codriving.llm.faults import fault_of, set_of, without_key
from codriving.llm.loop import loop
from codriving.llm.parsing import clean, one_line
from codriving.llm.places import places_of
from codriving.llm.request import ChatRequest, Reply, response_format, spoken, worded

# Sent where no key is named; without it LiteLLM would take one from the environment and give it to a stranger.
NO_KEY = "none"

_COMPATIBLE = "openai"  # LiteLLM's word for a server that speaks OpenAI's protocol


class Sender:
    """Sends through LiteLLM, over connections that the whole process shares."""

    timed = True  # Whether it is measured how long an answer takes
    marked = False  # Whether it is told on which occasion something is asked

    async def load(self) -> None:
        """Import LiteLLM, which takes seconds the first time, so that no deadline runs meanwhile."""
        await load_litellm()

    async def send(
        self, request: ChatRequest, form: str, key: str | None, deadline: float, key_header: str | None = None
    ) -> Reply:
        """Send a request once."""
        optional = {"temperature": request.temperature, "response_format": response_format(form, request.schema)}
        bodies = keep_bodies()
        messages = spoken(worded(request.messages, form, request.schema), request.system_role)
        carried = {key_header: key} if key_header and key else {}
        # LiteLLM is not told: what comes in events is put together before it sees it.
        fields = {**({"stream": True} if request.stream else {}), **request.extra}
        extra = Outgoing(fields, {**request.headers, **carried}, request.max_tokens_field, key_header)
        try:
            with changed(extra):
                response = await _loaded[0].acompletion(
                    model=request.model,
                    custom_llm_provider=provider_of(request.model, request.api_base),
                    messages=[asdict(message) for message in messages],
                    api_base=request.api_base,
                    api_key=NO_KEY if carried else key or NO_KEY,
                    timeout=deadline,
                    max_retries=0,
                    num_retries=0,
                    stream=False,
                    max_tokens=request.max_tokens,
                    **{name: value for name, value in optional.items() if value is not None},
                )
            return reply_of(response.model_dump(), _completion(bodies), form, key)
        except Exception as err:
            fault = fault_of(err, key)
        if body := _completion(bodies):
            # LiteLLM takes no content in parts; the server's own words are there all the same.
            return reply_of(body, body, form, key)
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
    given = dict(os.environ)
    os.environ.setdefault("LITELLM_LOCAL_MODEL_COST_MAP", "True")
    os.environ.setdefault("LITELLM_MODE", "PRODUCTION")  # Otherwise it reads a .env from some folder above
    try:
        import litellm
        import openai
    except Exception as error:  # It reads numbers and names of levels from variables as it is imported
        said = f"{type(error).__name__}: {error}"
        suspects = [n for n, v in sorted(given.items()) if v and (n.startswith("LITELLM_") or repr(v) in said)]
        # It reads certificates, too, and does not say of which file.
        suspects += set_of("SSL_CERT_FILE") if isinstance(error, OSError) else []
        cure = f"unset {' and '.join(suspects)}" if suspects else "install codriving again"
        raise ModelError(f"LiteLLM, which asks language models, cannot be imported ({said:.200}); {cure}") from error

    litellm.suppress_debug_info = True
    litellm.telemetry = False
    # For embeddings a 0 of the call counts as nothing said; retries have one owner.
    litellm.DEFAULT_MAX_RETRIES = 0  # type: ignore[attr-defined]
    for name in ("LiteLLM", "httpx", "openai"):
        # Their lines may hold addresses with keys; what goes wrong is told by us.
        logging.getLogger(name).setLevel(logging.CRITICAL)
    # Of content in parts and arguments that are no text, which are read all the same.
    warnings.filterwarnings("ignore", "Pydantic serializer warnings", UserWarning)
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


def _completion(bodies: Sequence[bytes]) -> dict[str, Any]:
    """Read the body of a response, if it is a chat completion."""
    with suppress(ValueError, RecursionError):
        body = json.loads(bodies[-1]) if bodies else None
        if isinstance(body, dict) and {"message", "text"} & _first(body).keys():
            # Some give the text alone, or no message where nothing was said.
            if not isinstance(message := _first(body).get("message"), dict):
                _first(body)["message"] = {"content": message or _first(body).get("text")}
            return body
    return {}


def _first(body: Mapping[str, Any]) -> dict[str, Any]:
    """Return the first choice of a chat completion; empty if there is none."""
    choices = body.get("choices")
    return choices[0] if isinstance(choices, list) and choices and isinstance(choices[0], dict) else {}


def _number(usage: object, name: str) -> int:
    """Read a count of tokens; 0 where there is none."""
    with suppress(TypeError, ValueError, OverflowError):
        return max(0, int(usage.get(name) or 0)) if isinstance(usage, Mapping) else 0
    return 0


def _details(usage: object) -> dict[str, Any]:
    """Read of a usage which tokens of the prompt were cached and which of the answer are thoughts; 0 where not said."""
    told = usage if isinstance(usage, Mapping) else {}
    cached = _number(told.get("prompt_tokens_details"), "cached_tokens")
    cached = cached or _number(told, "cache_read_input_tokens") or _number(told, "prompt_cache_hit_tokens")
    thought = _number(told.get("completion_tokens_details"), "reasoning_tokens")
    return {"cached_tokens": cached, "reasoning_tokens": thought}


def reply_of(
    response: Mapping[str, Any], body: Mapping[str, Any] | None = None, form: str = "", key: str | None = None
) -> Reply:
    """Normalise a response: all that was said, and why it ends.

    Args:
        response: The response as LiteLLM understands it.
        body: The response as the server sent it, if that is known: LiteLLM merges some places of an answer.
    """
    names = ("prompt_tokens", "completion_tokens")
    tokens: dict[str, Any] = {name: _number(response.get("usage"), name) for name in names}
    tokens |= _details(response.get("usage"))
    served = (body or {}).get("model") or response.get("model") or ""
    tokens["model"] = one_line(without_key(str(served), key), 200)
    if not _first(response):
        return Reply("", "", form=form, **tokens)
    said = {name: clean(without_key(text, key)) for name, text in places_of(_first(body or response)["message"])}
    return Reply(
        text=said.pop("content", ""),
        finish_reason=str(_first(response).get("finish_reason") or ""),
        refusal=said.pop("refusal", ""),
        form=form,
        beside=tuple(said.values()),
        **tokens,
    )
