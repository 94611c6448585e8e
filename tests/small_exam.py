"""A small exam of situations that were really driven to, judged by hand."""

from functools import cache

from codriving.config.compose import compose
from codriving.datatypes.world import Action
from codriving.environment.environment import Environment
from codriving.exam.observed import Examined, notebook_of
from codriving.exam.stored import Consequence, ExamNegotiation, ExamSituation, Origin, PairInQuestion, StoredExam
from codriving.experiment.objects import make_objects
from codriving.judgement.contests import contests

SEED, STEPS = 20_000, 12

BEST, WORSE, BAD = Consequence(10, 0, 0, 0.0), Consequence(10, 0, 0, 0.9), Consequence(10, 2, 3, 0.1)


@cache
def small_exam() -> StoredExam:
    """Four CAVs and rough drivers before an intersection: every situation and negotiation of some steps.

    Of the actions the first that is allowed is best, the second one loses 0.9 s, and any other ends badly; of a pair
    the one that is named first had better go first. Every driver is taken to let the CAV pass.
    """
    config = compose(["suite=standoff", "method=codriving"])
    config["method"]["_target_"] = "codriving.exam.observed.Examined"
    objects = make_objects(config)
    environment, method = objects.environment, objects.method
    assert isinstance(environment, Environment)
    assert isinstance(method, Examined)
    world, notebook = environment.reset(SEED), notebook_of(method)
    method.reset(environment.road_map, environment.driving_model, SEED)
    situations, negotiations = [], []
    for _ in range(STEPS):
        notebook.empty()
        actions = method.act(world).actions
        for situation, moment in notebook.situations:
            ego = situation.scene.ego.id
            if len(situation.allowed) > 2 and moment is not None:
                origin = Origin("standoff", ("suite=standoff",), SEED, world.step, ego)
                judged = dict(zip(situation.allowed, [BEST, WORSE, *[BAD] * 6], strict=False))
                mine = tuple(c for c in contests(moment) if c.cav == ego)
                named = f"{world.step}-{ego}"
                situations.append(ExamSituation(named, origin, situation, judged, mine, (True,) * len(mine)))
        for posed in notebook.posed[:1]:
            c = posed.conflicts[0]
            pairs = (PairInQuestion(c.ego, c.other, posed.order.first_of(c.ego, c.other) or "", BEST, WORSE),)
            given = posed.scenes, posed.problem, posed.conflicts, posed.previous
            origin = Origin("standoff", ("suite=standoff",), SEED, world.step, "")
            negotiations.append(ExamNegotiation(f"{world.step}-order", origin, *given, pairs))
        world = environment.step(actions)
    about = {"version": "0", "behaviour": "5", "seeds": "20000", "judged": "hand"}
    return StoredExam(tuple(situations), tuple(negotiations[:3]), about)


def actions_of(exam: StoredExam) -> list[tuple[Action, ...]]:
    """The actions that are allowed in each situation."""
    return [one.situation.allowed for one in exam.situations]
