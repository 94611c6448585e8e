"""What a picture says of who proposed and who accepted."""

from typing import Any

from codriving.animation.talk import Talk


def message(kind: str, sender: str, to: list[str], number: int = 1, round_: int = 1, why: str = "") -> dict[str, Any]:
    """A line of ``said``."""
    pairs = [["CAV2", "CAV1", why]] if why else []
    about = {"kind": kind, "sender": sender, "number": number, "round": round_, "pairs": pairs}
    return {**about, "arrives": dict.fromkeys(to, 1.0)}


def line(*said: dict[str, Any], held: tuple[str, ...] = (), authority: str = "") -> dict[str, Any]:
    """A decision of three CAVs, some of which hold an agreement of the road side unit."""
    agreement = {"sender": "RSU", **({"authority": authority} if authority else {})}
    cavs = [{"id": f"CAV{k}", "agreements": [agreement] if f"CAV{k}" in held else []} for k in (1, 2, 3)]
    return {"cavs": cavs, "said": list(said)}


def test_who_accepts_who_rejects_and_who_is_silent() -> None:
    talk = Talk()
    assert talk.after(line(message("proposal", "RSU", ["CAV1", "CAV2", "CAV3"]))) == (
        "RSU proposes (1, round 1): no answer of CAV1, CAV2, CAV3",
    )
    assert talk.after(
        line(message("acceptance", "CAV1", ["RSU"]), message("rejection", "CAV2", ["RSU"], why="it is behind"))
    ) == ("RSU proposes (1, round 1): CAV1 accepts; CAV2 rejects: it is behind; no answer of CAV3",)
    # What was said stays until there is another round.
    assert talk.after(line(held=("CAV1",)))[0].startswith("RSU proposes (1, round 1): CAV1 accepts")
    asked = message("proposal", "RSU", ["CAV1", "CAV2"], round_=2)
    late, now = message("acceptance", "CAV3", ["RSU"]), message("acceptance", "CAV2", ["RSU"], round_=2)
    assert talk.after(line(asked, late, now, held=("CAV1", "CAV3"))) == (
        "RSU proposes (1, round 2): CAV2 accepts; no answer of CAV1",
        "agreement of RSU, held by CAV1, CAV3",
    )


def test_who_has_left_proposes_no_more() -> None:
    talk = Talk()
    asked = message("proposal", "CAV3", ["CAV1", "CAV2"])
    assert talk.after(line(asked)) == ("CAV3 proposes (1, round 1): no answer of CAV1, CAV2",)
    left = line()
    assert talk.after({**left, "cavs": left["cavs"][:2]}) == ()


def test_an_instruction_names_its_authority() -> None:
    said = message("instruction", "RSU", ["CAV1"])
    assert Talk().after(line(said, held=("CAV1", "CAV2"), authority="a road side unit")) == (
        "RSU, a road side unit, directs CAV1, CAV2",
    )


def test_nothing_is_shown_of_what_is_no_message() -> None:
    for broken in ({"cavs": []}, {"said": "x"}, {"said": [1, {}], "cavs": [1, {"agreements": [2]}]}):
        assert Talk().after(broken) == ()
