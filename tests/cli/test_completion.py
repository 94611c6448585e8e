"""What the shell offers after TAB."""

import pytest

from codriving.cli.completion import complete_group, complete_override


def offered(incomplete: str) -> list[str]:
    return [word for word, _ in complete_override(incomplete)]


@pytest.fixture(autouse=True)
def no_bash(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("COMP_WORDS", raising=False)
    monkeypatch.delenv("COMP_CWORD", raising=False)


def bash(monkeypatch: pytest.MonkeyPatch, *words: str) -> list[str]:
    """Offer as in bash, which has split the words at ``=`` and puts the cursor into the last one."""
    monkeypatch.setenv("COMP_WORDS", "\n".join(["codriving", "run", *words]))
    monkeypatch.setenv("COMP_CWORD", str(len(words) + 1))
    return offered("" if words[-1] == "=" else words[-1])


def test_groups_come_with_their_choices() -> None:
    assert offered("scen") == ["scenario=intersection"]
    assert set(offered("cda=")) >= {"cda=full", "cda=prescriptive", "cda=status_sharing"}
    assert offered("llm=o") == ["llm=offline"]


def test_keys_come_with_their_values() -> None:
    assert offered("epi") == ["episodes=20"]
    assert offered("cda.nego") == ["cda.negotiation=true", "cda.negotiation=false"]
    assert offered("scenario.cav") == ["scenario.cavs=4", "scenario.cav_speed=[5.0,9.0]"]


def test_choices_are_described() -> None:
    assert dict(complete_override("cda=pres"))["cda=prescriptive"].startswith("SAE J3216 class D")


def test_nothing_fits() -> None:
    assert offered("zzz") == []
    assert offered("cda=zzz") == []
    assert offered("nonsense.key") == []


def test_bash_gets_only_what_follows_the_equals_sign(monkeypatch: pytest.MonkeyPatch) -> None:
    assert bash(monkeypatch, "scenario", "=") == ["intersection"]
    assert bash(monkeypatch, "scenario", "=", "int") == ["intersection"]
    assert bash(monkeypatch, "episodes", "=", "3", "cda", "=", "agr") == ["agreement_seeking"]
    assert bash(monkeypatch, "scen") == ["scenario=intersection"]
    assert bash(monkeypatch, "scenario", "=", "intersection", "llm") == ["llm=offline"]


def test_groups_of_list() -> None:
    assert complete_group("sce") == ["scenarios"]
    assert "experiments" in complete_group("")
