"""What is said of a decision, from entries of ``decisions.jsonl`` written by hand."""

from typing import Any

from codriving.pages.sections import Section, sections

SCENE = {
    "ego": {"id": "CAV1", "x": 0.0, "y": 0.0, "speed": 7.25},
    "intent": {"route": "east-south", "target_speed": 6.0},
    "neighbours": [
        {
            "id": "CAV2",
            "kind": "CAV",
            "x": 30.0,
            "y": 40.0,
            "speed": 9.0,
            "role": "conflict",
            "gap": None,
            "intent": {"route": "north-south", "target_speed": 9.0},
            "told": {"age": 0.1, "intent_age": 0.4, "seen": False},
        },
        {
            "id": "HDV1",
            "kind": "HDV",
            "x": 0.0,
            "y": 12.0,
            "speed": None,
            "role": "ahead",
            "gap": 7.0,
            "intent": None,
            "routes": [["north-east", 59.0], ["north-south", 59.0]],
            "told": None,
        },
    ],
}

ENTRY: dict[str, Any] = {
    "id": "CAV1",
    "action": "HOLD",
    "reason": "HOLD still lets CAV2 pass first",
    "scene": SCENE,
    "conflicts": [
        {
            "ego": "CAV1",
            "other": "HDV1",
            "relation": "crossing",
            "routes": ["east-south", "north-east"],
            "ttcp": [5.38, 5.88],
            "dttcp": 0.503,
            "severity": "serious danger",
            "certain": False,
            "clear_time": None,
        }
    ],
    "order": {
        "sequence": ["CAV2", "CAV1", "HDV1"],
        "binding": False,
        "precedences": [
            {"first": "CAV2", "second": "CAV3", "reason": "nearer"},
            {"first": "CAV2", "second": "CAV1", "reason": "earlier"},
            {"first": "CAV1", "second": "HDV1", "reason": "it stands"},
        ],
    },
    "allowed": ["SLOWER", "HOLD"],
    "removed": {"FASTER": ["too near to HDV1", "too fast"]},
    "assessments": [
        {"action": "SLOWER", "arrivals": [4.7, 6.0], "progress": 45.2, "target": 3.0},
        {"action": "HOLD", "arrivals": [4.4], "progress": 44.9, "target": 7.2},
        {"action": "FASTER", "arrivals": [], "progress": None, "target": None},
    ],
    "memories": ["At 8.4 m/s: IDLE."],
    "similarities": [0.943],
    "recalled": [17],
    "agreements": [{"sender": "RSU", "until": 7.0, "pairs": [["CAV2", "CAV1", "earlier"]]}],
    "filter": {"wanted": "FASTER", "taken": "HOLD", "removed": {"FASTER": ["too near"]}},
    "judgements": {"HDV1": {"yields": 0.815, "answer": "yields", "reason": "it brakes"}},
    "bids": {"CAV1": 3},
}

SAID = [
    {"kind": "proposal", "sender": "RSU", "arrives": {"CAV1": 4.6}, "pairs": [["CAV2", "CAV1", "earlier"]]},
    {"kind": "acceptance", "sender": "CAV1", "arrives": {}, "pairs": []},
    {"kind": "acceptance", "sender": "CAV3", "arrives": {"RSU": 4.7}, "pairs": []},
]

ASKED = [
    {
        "purpose": "decide",
        "subject": "CAV1",
        "value": None,
        "problem": "no JSON",
        "mended": False,
        "calls": [
            {
                "messages": [{"role": "system", "content": "You decide."}, {"role": "user", "content": "1. State"}],
                "text": "I hold",
                "prompt_tokens": 1550,
                "completion_tokens": 18,
                "seconds": 0.092,
                "problem": "",
            }
        ],
    },
]


def found() -> dict[str, Section]:
    return {section["h"]: section for section in sections(ENTRY, SAID, ASKED)}


def test_actions_with_what_was_removed_and_why() -> None:
    table = found()["Actions"]
    assert table["c"] == ["action", "verdict", "target", "gets", "earliest at zones [s]"]
    assert table["r"] == [
        ["SLOWER", "allowed", "3.0 m/s", "45 m", "4.7, 6.0"],
        ["HOLD", "taken", "7.2 m/s", "45 m", "4.4"],
        ["FASTER", "removed", "", "", ""],
    ]
    assert found()["Removed actions"]["r"] == [["FASTER", "too near to HDV1; too fast"]]


def test_an_action_that_was_taken_though_removed_is_called_so() -> None:
    entry = {"id": "CAV1", "action": "SLOWER", "allowed": [], "removed": {"SLOWER": ["no way out"]}}
    assert [part["r"] for part in sections(entry, (), ())] == [
        [["SLOWER", "taken though removed"]],
        [["SLOWER", "no way out"]],
    ]


def test_the_order_with_own_pairs_first_and_people_apart() -> None:
    order = found()["Passing order"]
    assert order["p"] == ["CAV2, then CAV1, then HDV1.", "The order is advice."]
    assert order["r"] == [["CAV2", "CAV1", "earlier"], ["CAV2", "CAV3", "nearer"]]
    assert found()["Judgement of human drivers"]["r"] == [
        ["HDV1", "yields, lets it pass with 82 %", "it brakes"],
        ["HDV1", "gives way", "it stands"],
    ]


def test_what_it_knew_and_from_where() -> None:
    knew = found()["What it knew"]
    assert knew["p"] == ["Itself at 7.2 m/s, east-south, target 6.0 m/s."]
    assert knew["c"] == ["vehicle", "where", "away", "gap", "speed", "intent, or possible routes", "known by"]
    assert knew["r"] == [
        [
            "CAV2",
            "conflict",
            "50 m",
            "",
            "9.0 m/s",
            "north-south, target 9.0 m/s",
            "a message 0.1 s old, its intent 0.4 s old",
        ],
        ["HDV1", "ahead", "12 m", "7 m", "", "not known; north-east or north-south", "its own sensors"],
    ]


def test_conflicts_in_words() -> None:
    assert found()["Conflicts"]["r"] == [
        ["HDV1", "crossing", "serious danger", "0.5 s", "5.4 and 5.9 s", "north-east (a guess)", "not within 10 s"]
    ]


def test_memories_messages_and_filter() -> None:
    memories = found()["Recalled memories"]
    assert memories["p"] == ["The decision was changed by memory 17."]
    assert memories["r"] == [["0.94", "At 8.4 m/s: IDLE."]]
    messages = found()["Messages about orders"]
    assert messages["r"] == [
        ["RSU", "proposal", "CAV1 at 4.6 s", "CAV2 before CAV1 (earlier)"],
        ["CAV1", "acceptance", "nowhere: lost", ""],
    ]
    assert messages["p"] == ["It holds the agreement of RSU until 7.0 s: CAV2 before CAV1 (earlier)."]
    check = found()["Safety check behind the method"]
    assert check["p"] == ["The method wanted FASTER; HOLD was driven."]
    assert check["r"] == [["FASTER", "too near"]]


def test_prompt_and_answer() -> None:
    asked = [section for section in sections(ENTRY, SAID, ASKED) if section["h"].startswith("The model was asked")]
    assert len(asked) == 1
    assert asked[0]["t"] == [["system", "You decide."], ["user", "1. State"], ["answer", "I hold"]]
    assert asked[0]["p"] == [
        "0.09 s, 1,550 prompt + 18 completion tokens.",
        "Nothing could be read in the answer: a fallback was used.",
        "Problem: no JSON.",
    ]


def test_what_only_this_method_writes_is_there_too() -> None:
    assert found()["Further notes of the method"]["t"] == [["bids", '{\n "CAV1": 3\n}']]


def test_strange_entries_are_no_trouble() -> None:
    entry = {"id": "CAV1", "scene": {"neighbours": [1, {}]}, "order": [], "removed": None, "similarities": "x"}
    assert [section["h"] for section in sections(entry, (), ({"calls": 3},))] == ["What it knew"]
