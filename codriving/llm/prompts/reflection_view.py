"""The variables of the reflection prompt: one experience, without a name in it."""

from typing import Any

from codriving.datatypes.experience import Experience


def reflection_view(experience: Experience) -> dict[str, Any]:
    """Return the variables of the reflection prompt."""
    effect = experience.effect
    return {
        "scene": experience.description.scene,
        "conflict": experience.description.conflict,
        "order": experience.description.order,
        "action": str(experience.action),
        "verdict": str(experience.verdict),
        "comment": experience.lesson,
        "dttcp_before": effect.dttcp_before,
        "dttcp_after": effect.dttcp_after,
        "own_change": effect.own_change,
        "own_braking": effect.own_braking,
        "forced_braking": effect.forced_braking,
        "collision": effect.collision,
        "needless": effect.needless,
    }
