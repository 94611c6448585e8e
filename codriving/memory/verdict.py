"""From the numbers of an effect to a verdict and the comment that is remembered (paper Section III-D.1)."""

from collections.abc import Mapping

from codriving.datatypes.action import Action
from codriving.datatypes.experience import Effect, Verdict

CLEARLY = 0.3
"""A narrower change of the difference of the times to the conflict point is none [s]."""

BANDS = (2.0, 5.0, 8.0)
"""Upper limits of the paper's bands: serious, general and slight danger [s]."""

HARD = 4.0
"""From this mean deceleration on braking is hard [m/s2]."""

LESSONS: Mapping[Verdict, str] = {
    Verdict.INTENSIFIED: "Your action has intensified the conflict; similar actions should be avoided.",
    Verdict.EASED: "Your action has eased the conflict; similar actions are advisable.",
    Verdict.TOO_CAUTIOUS: "Your action was too cautious, nobody used the way; similar waiting should be cut short.",
}
"""The paper's comment, and its two counterparts; what is neutral is not kept."""


def verdict_of(effect: Effect, action: Action) -> Verdict:
    """Judge an action by what came of it.

    It has *intensified* the conflict if it led to a collision soon after, and did not itself clearly move the CAV away
    from it; if it has narrowed the difference of the times to the conflict point and the danger is in a worse band; or
    if somebody then had to brake hard for it. It has *eased* it if it has widened that difference in serious or general
    danger. It was *too cautious* if the CAV waited and nobody used the way.
    """
    if effect.to_blame and effect.own_change <= CLEARLY:
        return Verdict.INTENSIFIED
    if _intensified(effect, action):
        return Verdict.INTENSIFIED
    if effect.needless:
        return Verdict.TOO_CAUTIOUS
    dangerous = effect.dttcp_before is not None and band(effect.dttcp_before) <= 1
    if dangerous and effect.collision is None and effect.own_change > CLEARLY and effect.own_braking < HARD:
        return Verdict.EASED
    return Verdict.NEUTRAL


def band(dttcp: float) -> int:
    """Return the paper's band: 0 serious, 1 general, 2 slight, 3 no danger.

    Args:
        dttcp: Difference of the times to the conflict point [s].
    """
    return sum(dttcp > limit for limit in BANDS)


def _intensified(effect: Effect, action: Action) -> bool:
    before, after = effect.dttcp_before, effect.dttcp_after
    narrowed = effect.own_change < -CLEARLY
    if narrowed and before is not None and after is not None and band(after) < min(band(before), 2):
        return True
    harsh = max(effect.forced_braking, effect.own_braking if action is not Action.SLOWER else 0.0) >= HARD
    if narrowed and after is not None and band(after) <= 1 and harsh:
        return True
    changes = action in (Action.LANE_LEFT, Action.LANE_RIGHT)
    return changes and effect.forced_braking >= HARD
