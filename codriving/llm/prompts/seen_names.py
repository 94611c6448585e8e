"""What vehicles are called that somebody on its own sees: V1 is the nearest, whoever it is."""

from math import hypot

from codriving.datatypes.scene_description import SceneDescription
from codriving.llm.prompts.free_text import Names


def seen_names(scene: SceneDescription) -> Names:
    """Return what everybody is called, by distance; ids would tell who is a CAV."""
    ego = scene.ego
    near = sorted(scene.neighbours, key=lambda n: (hypot(n.x - ego.x, n.y - ego.y), n.id))
    return Names([ego.id], [n.id for n in near])
