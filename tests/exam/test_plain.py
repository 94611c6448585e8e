"""What is stored is what was there, but for digits too small to matter."""

from math import inf

import pytest
from small_exam import small_exam

from codriving.datatypes.order import ApproachingVehicle, Instance
from codriving.datatypes.world import Told
from codriving.exam.plain import plain, restored
from codriving.exam.stored import ExamNegotiation, ExamSituation


def test_questions_come_back_as_they_were() -> None:
    exam = small_exam()
    for kind, questions in ((ExamSituation, exam.situations), (ExamNegotiation, exam.negotiations)):
        for one in questions:
            written = plain(one)
            again = restored(kind, written)
            assert plain(again) == written
            assert again.name == one.name
    first = exam.situations[0]
    again = restored(ExamSituation, plain(first))
    assert again.situation.allowed == first.situation.allowed
    assert again.situation.scene.ego.x == pytest.approx(first.situation.scene.ego.x, abs=6e-5)
    assert again.situation.outlook is not None
    assert again.actions == first.actions


def test_numbers_without_an_end_and_keys_of_two_words() -> None:
    problem = Instance(0.5, {}, {("a", "b"): inf}, frozenset({("b", "c"), ("a", "c")}))
    written = plain(problem)
    assert written["separation"] == [[["a", "b"], "inf"]]
    assert written["before"] == [["a", "c"], ["b", "c"]]
    assert restored(Instance, written) == problem
    told = Told(0.12345678, None)
    assert plain(told)["age"] == 0.1235
    assert restored(Told, plain(told)) == Told(0.1235, None)
    assert str(plain(-0.00001)) == "0.0"


def test_windows_without_an_end_are_numbers_again() -> None:
    vehicle = ApproachingVehicle("a", 1.0, 2.0, windows=[(0.0, 1.5), (inf, inf)])
    assert restored(ApproachingVehicle, plain(vehicle)) == vehicle


def test_what_is_of_another_type_is_refused() -> None:
    with pytest.raises(ValueError, match="no Told"):
        restored(Told, {"age": 0.0, "intent_age": None, "strange": 1})
